"""Build the studies with the newest packages, and say which numbers move: ``make drift``.

The newest versions that ``pyproject.toml`` admits go into an environment of their own, anew in each
call. With them and with those of the lock the studies are built in small sizes, by
``config/quick.yaml``, and every number of every table is held beside the other.
"""

import argparse
import csv
import datetime
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.catalogue import read_catalogue
from smallsat.evidence.accepted import findings, flipped
from smallsat.results import read_table
from smallsat.workflow.crate import code_version
from smallsat.workflow.seconds import machine

PROJECT = Path(__file__).parents[2]
ENVIRONMENT = PROJECT / ".cache/drift"
OUTPUT = PROJECT / "data/accepted/pipeline"
CONFIGURATION = "config/quick.yaml"
# Differs from build to build.
CLOCK = ("seconds", "timings")
COLUMNS = ("table", "column", "numbers", "moved", "largest_change")


def make_environment() -> Path:
    """Python with the newest versions."""
    subprocess.run([sys.executable, "-m", "venv", "--clear", ENVIRONMENT], check=True)
    python = ENVIRONMENT / "bin/python"
    pip = [python, "-m", "pip", "install", "--quiet", "--upgrade", "--upgrade-strategy=eager"]
    subprocess.run([*pip, "setuptools"], check=True)
    subprocess.run([*pip, "--no-build-isolation", "--editable", PROJECT], check=True)
    return python


def packages(python: Path) -> dict[str, str]:
    """Versions of the packages of an environment, by name."""
    call = [python, "-m", "pip", "list", "--format=json", "--disable-pip-version-check"]
    listed = json.loads(subprocess.run(call, check=True, capture_output=True, text=True).stdout)
    return {one["name"].lower().replace("_", "-"): one["version"] for one in listed}


def build(python: Path, studies: list[str], run: str) -> Path:
    """Folder of a run of the studies in small sizes, made anew; fails where the build does."""
    # Snakemake does not see that packages have changed.
    shutil.rmtree(PROJECT / "runs" / run, ignore_errors=True)
    call = [python.parent / "snakemake", *studies, "--configfile", CONFIGURATION]
    subprocess.run([*call, "--config", f"run={run}"], cwd=PROJECT, check=True)
    return PROJECT / "runs" / run


def tables(run: Path, study: str) -> set[str]:
    """Tables of a study's results and of what its figures draw, from the folder of the run."""
    found = (
        path.relative_to(run).as_posix()
        for folder in ("data/results", "figures")
        for path in (run / folder / study).rglob("*")
        if path.suffix in (".csv", ".parquet")
    )
    return {name for name in found if not any(word in name for word in CLOCK)}


def drifted(before: pd.DataFrame, now: pd.DataFrame) -> Iterator[tuple[str, int, int, float]]:
    """Of each column: numbers, how many moved, and the largest change, relative to its largest.

    A text that differs counts as moved without end, and so does every cell of a column or a table
    that is of another shape.
    """
    for column in sorted({*before.columns, *now.columns}):
        one, other = before.get(column), now.get(column)
        if one is None or other is None or len(one) != len(other):
            cells = max(len(before), len(now))
            yield column, cells, cells, np.inf
            continue
        differs = ~((one == other) | (one.isna() & other.isna()))
        numbers = all(
            pd.api.types.is_numeric_dtype(cells) and not pd.api.types.is_bool_dtype(cells)
            for cells in (one, other)
        )
        change = np.inf if differs.any() else 0.0
        if numbers and differs.any():
            largest = np.nanmax(np.abs([one.to_numpy(float), other.to_numpy(float)]))
            gaps = np.abs(other.to_numpy(float) - one.to_numpy(float))[differs.to_numpy()]
            change = np.inf if np.isnan(gaps).any() else float(gaps.max() / largest)
        yield column, len(one), int(differs.sum()), change


def comparison(locked: Path, newest: Path, study: str) -> pd.DataFrame:
    """A row for each column of each table, with the columns `COLUMNS`; a missing table moved."""
    rows: list[tuple[str, str, int, int, float]] = []
    for name in sorted(tables(locked, study) | tables(newest, study)):
        if not all((run / name).exists() for run in (locked, newest)):
            rows.append((name, "", 1, 1, np.inf))
            continue
        found = drifted(read_table(locked / name), read_table(newest / name))
        rows += [(name, *row) for row in found]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def write(path: Path, header: tuple[str, ...], rows: list[tuple[object, ...]]) -> None:
    """Write a table of the report."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        table.writerows(rows)


def main() -> None:
    """Build both, keep what moved and which versions did, and say so."""
    known = [study.name for study in read_catalogue(PROJECT / "data/published")]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("studies", nargs="*", metavar="study", help="studies to build; else all")
    given = parser.parse_args().studies
    for study in given:
        if study not in known:
            sys.exit(f"drift: {study!r} is no study; studies are {', '.join(known)}")
    studies = given or known
    os.chdir(PROJECT)
    newer = make_environment()
    own, others = packages(Path(sys.executable)), packages(newer)
    changed = sorted(name for name in own.keys() & others.keys() if own[name] != others[name])
    newest = build(newer, studies, "drift-newest")
    locked = build(Path(sys.executable), studies, "drift-locked")
    found = {study: comparison(locked, newest, study) for study in studies}
    outcomes = flipped(*(findings(run / "data/results") for run in (locked, newest)))
    about = {
        "date": datetime.date.today().isoformat(),
        "configuration": CONFIGURATION,
        "packages": len(others),
        "newer": len(changed),
        "machine": machine(),
        "code": code_version(PROJECT),
        "command": " ".join(["make drift", *(f"STUDY={study}" for study in given)]),
    }
    runs = [
        about
        | {
            "study": study,
            "tables": table["table"].nunique(),
            "cells": int(table["numbers"].sum()),
            "moved": int(table["moved"].sum()),
            "largest_change": f"{table['largest_change'].max():.3g}",
            "outcomes": sum(name.startswith(f"{study}/") for name in outcomes.index),
        }
        for study, table in found.items()
    ]
    write(OUTPUT / "drift.csv", tuple(runs[0]), [tuple(run.values()) for run in runs])
    write(
        OUTPUT / "drift-packages.csv",
        ("package", "locked", "newest"),
        [(name, own[name], others[name]) for name in changed],
    )
    table = pd.concat(found.values())
    moved = table[table["moved"] > 0].sort_values("largest_change", ascending=False)
    rows = [(*row[:4], f"{row[4]:.3g}") for row in moved.itertuples(index=False)]
    write(OUTPUT / "drift-moved.csv", COLUMNS, rows)
    for name in changed:
        print(f"{name}: {own[name]} locked, {others[name]} newest")
    for row in rows:
        print(f"moved: {row[0]}, {row[1]}: {row[3]} of {row[2]}, the largest by {row[4]}")
    for row in outcomes.itertuples():
        print(f"outcome: {row.Index}: {row.before} locked, {row.now} newest")
    for run in runs:
        print("{study}: {moved} of {cells} cells moved, {outcomes} outcomes differ".format(**run))
    print(f"{len(changed)} packages are newer")


if __name__ == "__main__":
    main()
