"""Collect everything that the report says from the results of a run."""

import argparse
import hashlib
import json
import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import pandas as pd

from smallsat.catalogue import read_catalogue
from smallsat.config import Values, departures
from smallsat.errors import InputError
from smallsat.evidence.ledger import read_artefacts
from smallsat.evidence.not_converged import read_not_converged
from smallsat.evidence.summary import KIND_TITLES, failures, value_kinds, verdict_counts
from smallsat.evidence.verdicts import PENDING
from smallsat.report.inputs import input_groups
from smallsat.report.number import significant_text
from smallsat.report.values import (
    Content,
    of_table,
    read_findings,
    records,
    value_table,
    value_texts,
)
from smallsat.results import read_table, write_json
from smallsat.strict_yaml import read_yaml

# Digits of numbers in tables that go beyond a document.
EXTRAS_DIGITS = 7


def collect(
    project: Path,
    run: Path,
    config: Values,
    default: Values,
    left_out: Collection[str] = (),
    studies: Collection[str] = (),
) -> Content:
    """The content of the report of one run.

    Parameters
    ----------
    project
        Folder of the project, with ``data/published`` and ``report``.
    run
        Folder of the run, with ``data/results``.
    config
        The configuration of the run.
    default
        The documents' own values.
    left_out
        Targets of artefacts whose cases a what-if run leaves out.
    studies
        The studies that the report is about, from their own verdicts; none for the whole report.
    """
    published, results = project / "data/published", run / "data/results"
    kinds = value_kinds(published)
    paths = [results / study / "verdicts.csv" for study in studies] or [results / "verdicts.csv"]
    verdicts = pd.concat([read_findings(path) for path in paths], ignore_index=True)
    verdicts["kind"] = verdicts["id"].map(kinds)
    verdicts["seconds"] = verdicts["id"].map(_seconds(results))
    counts = verdict_counts(verdicts, kinds)
    unsolved = read_not_converged(results)
    documents = []
    for study in read_catalogue(published):
        name = study.name
        if studies and name not in studies:
            continue
        own = verdicts[verdicts["document"] == name]
        artefacts = read_artefacts(published / name / "artefacts.csv")
        shown = [row for row in artefacts if row["target"] not in left_out]
        document = {
            "key": name,
            **{
                key: value
                for key in ("title", "author", "year", "subject")
                if (value := getattr(study, key))
            },
            "counts": _counts(counts.loc[[name]].droplevel(0)),
            "artefacts": {
                kind: sum(row["kind"] == kind for row in artefacts)
                for kind in ("table", "figure", "animation")
            },
        }
        document |= _study(own, shown, results / name, published / name)
        document["not_converged"] = [
            {**row, "residual": _cell(row["residual"])}
            for row in records(unsolved[unsolved["study"] == name])
        ]
        for part, folder in (("chapter", "chapters"), ("summary", "summaries")):
            path = f"report/{folder}/{name}.typ"
            document[part] = f"/{path}" if (project / path).exists() else None
        documents.append(document)
    return {
        "run": _run(project, run, config, default),
        "verdicts": list(counts.columns),
        "kinds": list(KIND_TITLES.items()),
        "documents": documents,
        "values": {str(row["id"]): value_texts(row) for row in records(verdicts)},
        "config": config,
    }


def _study(
    verdicts: pd.DataFrame, artefacts: list[dict[str, str]], results: Path, published: Path
) -> Content:
    document, run = published.name, results.parents[2]
    own = [row for row in artefacts if row["target"]]
    tables = [row for row in own if row["kind"] == "table"]
    in_table = pd.Series(False, index=verdicts.index)
    table_contents = []
    for row in tables:
        cells = of_table(verdicts, row["id"])
        in_table[cells.index] = True
        table_contents.append({**row, **value_table(cells)})
    waiting = verdicts["verdict"] == PENDING
    elsewhere = verdicts[~in_table & ~waiting & (verdicts["kind"] != "input")]
    errata = records(read_findings(results / "errata.csv"))
    claims = records(read_findings(results / "claims.csv"))
    unreproducible = verdicts[verdicts["verdict"] == "unreproducible"]
    return {
        "tables": table_contents,
        "figures": [
            _figure(run, row["target"].removesuffix(".svg"), row["id"], row["caption"])
            for row in own
            if row["kind"] == "figure"
        ],
        "animations": [row for row in own if row["kind"] == "animation"],
        "elsewhere": [
            {"locator": locator, **value_table(rows)}
            for locator, rows in elsewhere.groupby("locator", sort=False)
        ],
        "inputs": input_groups(verdicts[~waiting & (verdicts["kind"] == "input")]),
        "errata": errata,
        "claims": claims,
        "extras": _extras(published / "extras.yaml", run),
        "notebooks": [
            f"data/results/{document}/notebooks/{path.name}"
            for path in sorted((results / "notebooks").glob("*.ipynb"))
            # Films are made only when asked for, and the report is the same with and without.
            if not path.name.startswith("animation")
        ],
        "wrong": [
            {"id": row["id"], "reason": row["reason"], **value_texts(row)}
            for row in records(failures(verdicts))
        ],
        "pending": [
            {
                "reason": reason,
                "counts": [[kind, n] for kind in KIND_TITLES if (n := kinds.get(kind))],
            }
            for reason, rows in verdicts[waiting].groupby("reason", sort=False)
            for kinds in [rows["kind"].value_counts().to_dict()]
        ],
        "unreproducible": [
            {"reason": reason, "places": sorted(set(rows["locator"])), "values": len(rows)}
            for reason, rows in unreproducible.groupby("reason", sort=False)
        ],
    }


def _figure(run: Path, stem: str, name: str = "", caption: str = "") -> Content:
    """One figure, with the size in points at which it was drawn."""
    path = run / f"{stem}.svg"
    try:
        with path.open(encoding="utf-8") as file:
            size = re.search(r'<svg[^>]*? width="([\d.]+)pt" height="([\d.]+)pt"', file.read(2000))
    except FileNotFoundError:
        raise InputError(f"{path}: no such figure; run `snakemake {stem}.svg`") from None
    if size is None:
        raise InputError(f"{path}: damaged figure; delete it and run `snakemake` again")
    width, height = float(size[1]), float(size[2])
    return {"id": name, "caption": caption, "stem": stem, "width": width, "height": height}


def _seconds(results: Path) -> dict[str, float]:
    """Our seconds for the timings of all studies that measure them, by id."""
    tables = [read_table(path) for path in sorted(results.glob("*/timings.csv"))]
    return {str(row["id"]): row["seconds"] for table in tables for row in records(table)}


def _counts(counts: pd.DataFrame) -> list[Content]:
    return [
        {"kind": kind, "total": sum(numbers), "numbers": numbers}
        for kind in KIND_TITLES
        for numbers in counts[counts.index == kind].to_numpy().tolist()
    ]


def _extras(path: Path, run: Path) -> list[Content]:
    """Tables and figures beyond the document, as the study lists them."""
    entries = (read_yaml(path) or []) if path.exists() else []
    extras = []
    for entry in entries:
        extra = {"title": entry["title"], "text": entry.get("text", ""), "table": None}
        if entry.get("table"):
            table = read_table(run / entry["table"])
            # A wide table is shown by the columns that its study picks, under names of its own.
            if columns := entry.get("columns"):
                table = table[list(columns)].rename(columns=columns)
            extra["table"] = {
                "target": entry["table"],
                "header": [str(name) for name in table.columns],
                "rows": [[_cell(value) for value in row] for row in table.itertuples(index=False)],
            }
        extra["figures"] = [_figure(run, stem) for stem in entry.get("figures") or []]
        extras.append(extra)
    return extras


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return significant_text(value, EXTRAS_DIGITS)
    return str(value)


def _run(project: Path, run: Path, config: Values, default: Values) -> Content:
    """Which run this is: its folder, its configuration and where that departs from the default."""
    folder = run.resolve().relative_to(project.resolve()).as_posix()
    text = json.dumps({**config, "run": ""}, sort_keys=True)
    return {
        "folder": folder,
        "what_if": folder != ".",
        "digest": hashlib.sha256(text.encode()).hexdigest()[:12],
        "changes": departures(config, default),
    }


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``content``."""
    parser.add_argument("--config", required=True, type=json.loads, help="whole configuration")
    parser.add_argument("--default", required=True, type=json.loads, help="the documents' own")
    parser.add_argument("--project", required=True, type=Path, help="folder of the project")
    parser.add_argument("--run", default=Path(), type=Path, help="folder of the run")
    parser.add_argument("--left-out", default=[], type=json.loads, help="targets not made, JSON")
    parser.add_argument("--studies", nargs="*", default=[], help="only these; else all")
    parser.add_argument("--output", required=True, type=Path)


def main(arguments: argparse.Namespace) -> None:
    """Write the content as JSON."""
    collected = collect(
        arguments.project,
        arguments.run,
        arguments.config,
        arguments.default,
        arguments.left_out,
        arguments.studies,
    )
    write_json(collected, arguments.output)
