"""What the last release found, in ``data/accepted``, and what has moved since.

Of every study the folder keeps the outcome of each claim and proof, and the verdict and computed
value of each printed one; ``releases.csv`` says when they were taken and why.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.results import read_table

RELEASES = "releases.csv"
# Of each sort of finding: its table, the column with its name, that with its outcome.
SORTS = {
    "value": ("verdicts.csv", "id", "verdict"),
    "claim": ("claims.csv", "id", "outcome"),
    "erratum": ("errata.csv", "key", "holds"),
}
# After the name of an outcome: of the tests' run, in which the Monte Carlo parts have a share of
# their samples and some claims stay undecided.
SHARE = "_of_a_share"
# Relative; the last bits differ from one processor to another.
ROUNDING = 1e-9
# So many values that moved are shown.
SHOWN = 20


def findings(folder: Path, of: str = "") -> pd.DataFrame:
    """Outcomes of all studies in a folder, ``data/results`` of a run or ``data/accepted``.

    Parameters
    ----------
    of
        `SHARE` for the accepted outcomes of the tests' run; proofs come to the same in both.

    Returns
    -------
    DataFrame
        ``outcome``, and ``computed`` of values, by name: the id of a value, or study and key such
        as ``mars/claims/velocity``.
    """
    tables = [pd.DataFrame(columns=["name", "outcome", "computed"])]
    for sort, (file, key, outcome) in SORTS.items():
        for path in sorted(folder.glob(f"*/{file}")):
            table = read_table(path)
            prefix = "" if sort == "value" else f"{path.parent.name}/{path.stem}/"
            found = table[outcome if sort == "erratum" else outcome + of].astype(str)
            own = {"name": prefix + table[key].astype(str), "outcome": found}
            if sort == "value":
                own["computed"] = table["computed"]
            tables.append(pd.DataFrame(own))
    return pd.concat(tables).set_index("name").astype({"computed": float})


def _beside(before: pd.DataFrame, now: pd.DataFrame, column: str) -> pd.DataFrame:
    """A column of what both have, as ``before`` and ``now``, by name."""
    return pd.concat({"before": before[column], "now": now[column]}, axis=1, join="inner")


def flipped(before: pd.DataFrame, now: pd.DataFrame) -> pd.DataFrame:
    """Findings whose outcome differs, as ``before`` and ``now``, by name."""
    both = _beside(before, now, "outcome")
    return both[both["before"] != both["now"]]


def moved(before: pd.DataFrame, now: pd.DataFrame) -> pd.DataFrame:
    """Values that are not the same to the last digit, the largest change first.

    Returns
    -------
    DataFrame
        ``before``, ``now`` and ``change``, relative to the larger of both.
    """
    both = _beside(before, now, "computed")
    both = both[(both["before"] != both["now"]) & both.notna().any(axis=1)]
    size = both.abs().max(axis=1)
    change = ((both["now"] - both["before"]).abs() / size).fillna(np.inf)
    return both.assign(change=change).sort_values("change", ascending=False, kind="stable")


def movement_text(before: pd.DataFrame, now: pd.DataFrame) -> str:
    """What has moved since the accepted findings, in a few lines."""
    flips, values = flipped(before, now), moved(before, now)
    beyond = values[values["change"] > ROUNDING]
    lines = []
    if len(flips):
        lines.append(f"{len(flips)} outcomes are not the accepted ones:")
        lines += [f"  {row.Index}: {row.before}, now {row.now}" for row in flips.itertuples()]
    if len(beyond):
        lines.append(f"{len(beyond)} values moved, the largest first:")
        lines += [
            f"  {name}: {old:.9g}, now {new:.9g} ({100 * change:.2g} %)"
            for name, old, new, change in beyond.head(SHOWN).itertuples()
        ]
        if len(beyond) > SHOWN:
            lines.append(f"  and {len(beyond) - SHOWN} by less")
    if slight := len(values) - len(beyond):
        lines.append(f"{slight} values moved within rounding (relative {ROUNDING:g}).")
    for count, word in (
        (len(now.index.difference(before.index)), "new: nothing is accepted of them yet"),
        (len(before.index.difference(now.index)), "accepted and not found here"),
    ):
        if count:
            lines.append(f"{count} findings are {word}.")
    return "\n".join(lines) or "Nothing has moved."
