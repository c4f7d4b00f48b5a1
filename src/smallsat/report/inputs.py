"""Printed parameters of a study, grouped by what they feed."""

import re

import pandas as pd

from smallsat.report.values import Content, records

FEEDS = "feeds "
NOT_OURS = "not a parameter of ours: "


def input_groups(verdicts: pd.DataFrame) -> list[Content]:
    """One entry for each parameter of ours, then one for each reason to use none.

    Parameters
    ----------
    verdicts
        Verdicts of the inputs of one document.

    Returns
    -------
    list
        ``name`` (what the values feed, or why they feed nothing), ``ours``, ``verdict``, the
        distinct ``printed`` values, the number of ``values`` and the ``places`` they stand in.
    """
    groups: dict[tuple[bool, str, str], list[dict[str, str]]] = {}
    for row in records(verdicts):
        reason, verdict = str(row["reason"]), str(row["verdict"])
        ours = reason.startswith(FEEDS)
        name = reason.removeprefix(FEEDS).removeprefix(NOT_OURS)
        groups.setdefault((not ours, name, verdict), []).append(row)
    return [
        {
            "name": name,
            "ours": not others,
            "verdict": verdict,
            "printed": _distinct(rows, "printed"),
            "values": len(rows),
            "places": _places(_distinct(rows, "locator")),
        }
        for (others, name, verdict), rows in sorted(groups.items(), key=lambda item: item[0])
    ]


def _distinct(rows: list[dict[str, str]], key: str) -> list[str]:
    return list(dict.fromkeys(str(row[key]) for row in rows))


def _places(locators: list[str]) -> list[str]:
    """Locators of one sort together: Listing 1 (main), Listing 4 becomes Listings 1, 4."""
    sorts: dict[str, list[str]] = {}
    for locator in locators:
        sort, _, place = re.sub(r" \(.*\)$", "", locator).partition(" ")
        if place not in sorts.setdefault(sort, []):
            sorts[sort].append(place)
    return [
        f"{sort}{'s' if len(places) > 1 else ''} {', '.join(places)}".strip()
        for sort, places in sorts.items()
    ]
