"""What-if runs beside the reproduction: settings, outcomes, values and figures that differ.

Where the reproduction is not built, its accepted results take its place, and no figures are shown.
"""

import argparse
import filecmp
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from smallsat.catalogue import Study, read_catalogue
from smallsat.errors import InputError
from smallsat.evidence.accepted import findings
from smallsat.evidence.not_converged import read_not_converged
from smallsat.report.number import NOTHING, significant_text
from smallsat.report.values import Content
from smallsat.workflow.explain import subjects

CHANGES = "changes.json"
DIGITS = 6


def compare(project: Path, runs: Mapping[str, Path], study: Study, page: Path) -> Content:
    """What differs between runs and the reproduction, of one study.

    Parameters
    ----------
    project
        Folder of the project, in which the reproduction lies, if it is built.
    runs
        Folders of what-if runs, by name.
    page
        Where the comparison goes; figures are named as seen from its folder.

    Returns
    -------
    dict
        ``settings``, ``outcomes``, ``values`` and ``figures``, each a list of rows with the text
        ``before`` and a list ``now``, one a run; ``unsolved`` cases by run; whether the
        reproduction is ``built``.
    """
    built = (project / "data/results" / study.name / "verdicts.csv").exists()
    own = findings(project / ("data/results" if built else "data/accepted"))
    found = [findings(folder / "data/results") for folder in runs.values()]
    known = {one.name: one for one in subjects(project / "data/published")}
    judged = [
        name
        for name, one in known.items()
        if one.study.name == study.name
        and (one.sort in ("claim", "erratum") or one.row.get("kind") == "result")
        and name in own.index
    ]
    return {
        "study": study.name,
        "runs": list(runs),
        "subject": study.subject,
        "built": built,
        "settings": _settings(study.name, runs),
        "outcomes": [
            {"name": name, "about": _about(known[name].row), "before": before, "now": now}
            for name, before, now in _rows("outcome", judged, own, found)
            if any(one != before for one in now)
        ],
        "values": [
            {
                "name": name,
                "about": _about(known[name].row),
                "unit": known[name].row["unit"],
                "before": significant_text(before, DIGITS),
                "now": [_changed(before, one) for one in now],
            }
            for name, before, now in _rows("computed", judged, own, found)
            if any(one != before and not (pd.isna(one) and pd.isna(before)) for one in now)
        ],
        "figures": list(_figures(project, runs, study.name, page)) if built else [],
        "unsolved": {name: _unsolved(folder, study.name) for name, folder in runs.items()},
    }


def _settings(study: str, runs: Mapping[str, Path]) -> list[Content]:
    """Keys of the study's section that any run changes."""
    changes = [
        {one["key"]: one for one in json.loads((folder / CHANGES).read_text("utf-8"))}
        for folder in runs.values()
    ]
    defaults = {key: one["default"] for own in changes for key, one in own.items()}
    return [
        {
            "key": key,
            "before": default,
            "now": [own[key]["value"] if key in own else default for own in changes],
        }
        for key, default in sorted(defaults.items())
        if key.startswith(f"{study}.")
    ]


def _rows(
    column: str, names: list[str], own: pd.DataFrame, found: list[pd.DataFrame]
) -> Iterator[tuple[str, Any, list[Any]]]:
    """A column of each finding, of the reproduction and of each run."""
    columns = [table[column].to_dict() for table in found]
    for name, before in own[column].reindex(names).items():
        yield str(name), before, [values.get(name, NOTHING) for values in columns]


def _about(row: Mapping[str, Any]) -> str:
    """What a printed value, a claim or an erratum is about."""
    words = [row.get(key) for key in ("locator", "quantity", "case", "component", "claim")]
    return ", ".join(str(word) for word in words if word)


def _changed(before: float, now: Any) -> Content:
    """A value and by how much it differs."""
    if now == NOTHING or pd.isna(now):
        return {"value": NOTHING, "change": ""}
    share = (now - before) / abs(before) if before else float("nan")
    change = f"{100 * share:+.2g} %" if now != before and share == share else ""
    return {"value": significant_text(now, DIGITS), "change": change}


def _figures(project: Path, runs: Mapping[str, Path], study: str, page: Path) -> Iterator[Content]:
    """Figures whose data are not the reproduction's in every run, and those that one has alone."""
    folders = [project, *runs.values()]
    stems = {path.stem for folder in folders for path in (folder / "figures" / study).glob("*.csv")}
    for stem in sorted(stems):
        drawn = [folder / f"figures/{study}/{stem}.csv" for folder in folders]
        own = drawn[0]
        if own.exists() and all(
            one.exists() and filecmp.cmp(own, one, shallow=False) for one in drawn[1:]
        ):
            continue
        yield {
            "name": f"{study}/{stem}",
            "drawn": [
                (
                    name,
                    os.path.relpath(one.with_suffix(".svg"), page.parent) if one.exists() else "",
                )
                for name, one in zip(("reproduction", *runs), drawn, strict=True)
            ],
        }


def _unsolved(folder: Path, study: str) -> list[Any]:
    table = read_not_converged(folder / "data/results")
    return list(table.loc[table["study"] == study, "case"])


def write_comparison(
    project: Path, runs: Mapping[str, Path], only: str, page: Path
) -> list[Content]:
    """Write the page, of one study or of all that any run has, and return what it says.

    Raises
    ------
    InputError
        If a folder is no what-if run with results.
    """
    studies = [
        study
        for study in read_catalogue(project / "data/published")
        if only in ("", study.name) and any(_has(folder, study) for folder in runs.values())
    ]
    for folder in runs.values():
        if not (folder / CHANGES).exists() or not any(_has(folder, study) for study in studies):
            raise InputError(
                f"{folder}: no what-if run with results; make one, such as "
                "`snakemake transfer --config run=heavier ...`, and name its folder"
            )
    compared = [
        compare(project, {name: one for name, one in runs.items() if _has(one, study)}, study, page)
        for study in studies
    ]
    pages = Environment(
        loader=FileSystemLoader(project / "report/site"), autoescape=True, undefined=StrictUndefined
    )
    styles = [project / "report/style.css", project / "report/site/site.css"]
    text = pages.get_template("comparison.html.j2").render(
        studies=compared, style=Markup("\n".join(path.read_text("utf-8") for path in styles))
    )
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(text, "utf-8")
    return compared


def _has(run: Path, study: Study) -> bool:
    return (run / "data/results" / study.name / "verdicts.csv").exists()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``compare``."""
    parser.add_argument("runs", nargs="+", type=Path, help="folders of what-if runs")
    parser.add_argument("--study", default="", help="only this one; else all that a run has")
    parser.add_argument("--project", default=Path(), type=Path, help="folder of the project")
    parser.add_argument("--output", default=Path("runs/comparison.html"), type=Path)


def main(arguments: argparse.Namespace) -> None:
    """Write the page and say in a line a study how much differs."""
    runs = {folder.resolve().name: folder for folder in arguments.runs}
    for one in write_comparison(arguments.project, runs, arguments.study, arguments.output):
        counts = [f"{len(one[part])} {part}" for part in ("values", "outcomes", "figures")]
        print(f"{one['study']}: {', '.join(counts)} differ: {arguments.output}")
