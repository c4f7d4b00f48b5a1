"""What two builds have in common, byte by byte, kind by kind; and which digits moved."""

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from smallsat.results import read_table

KINDS: Mapping[str, tuple[str, ...]] = {
    "data": (".csv", ".parquet", ".json", ".accepted"),
    "figure": (".svg", ".png", ".pdf"),
    "notebook": (".ipynb",),
    "page": (".html", ".css", ".js", ".xml", ".bib"),
    "PDF": (".pdf",),
}
FOLDERS = ("data/results", "figures", "report/build")
# Keys of an executed notebook that tell the time; the cell of parameters that papermill adds has an
# invented name beside.
TIMES = ("start_time", "end_time", "duration", "execution")
# Files whose words can be read; a PDF is compressed.
TEXTS = (".csv", ".json", ".html", ".svg", ".css", ".js", ".xml", ".bib", ".accepted")
# Pages set an exponent as a power of ten.
NUMBER = re.compile(r"[-+−]?\d+(?:[.,]\d+)*(?:e[-+]?\d+|×10<sup>[-+−]?\d+</sup>)?")


@dataclass(frozen=True)
class Compared:
    """A file of both builds, or of one of them; ``words``: at most numbers differ in a text."""

    name: str
    kind: str
    same: bool
    words: bool


def files(build: Path) -> set[str]:
    """Files of a build, relative to its folder."""
    return {
        path.relative_to(build).as_posix()
        for folder in FOLDERS
        for path in (build / folder).rglob("*")
        if path.is_file() and path.name not in ("README.md", ".snakemake_timestamp")
    }


def compared(one: Path, other: Path) -> Iterator[Compared]:
    """Every file of either build."""
    ours, theirs = files(one), files(other)
    for name in sorted(ours | theirs):
        both = name in ours & theirs
        same = both and _content(one / name) == _content(other / name)
        words = same or (both and _words(one / name) == _words(other / name))
        yield Compared(name, kind(name), same, words)


def kind(name: str) -> str:
    """What a file is."""
    place, suffix = name.partition("/")[0], Path(name).suffix
    if suffix == ".pdf":
        return "PDF" if place == "report" else "figure"
    if suffix == ".csv" and place == "figures":
        return "data"
    return next((word for word, ends in KINDS.items() if suffix in ends), suffix)


@dataclass(frozen=True)
class Moved:
    """Cells of a table that differ between two builds: how many, and by how much at most."""

    table: str
    column: str
    cells: int
    of: int
    relative: float


def moved_digits(one: Path, other: Path, name: str) -> Iterator[Moved]:
    """Columns of a table in which builds differ; a text that differs counts as a whole."""
    if not ((one / name).exists() and (other / name).exists()):
        yield Moved(name, "(the table is missing)", 1, 1, float("inf"))
        return
    first, second = read_table(one / name), read_table(other / name)
    if list(first) != list(second) or len(first) != len(second):
        yield Moved(name, "(rows or columns)", 1, 1, float("inf"))
        return
    for column in first:
        before, after = first[column], second[column]
        if pd.api.types.is_float_dtype(before) and pd.api.types.is_float_dtype(after):
            a, b = before.to_numpy(float), after.to_numpy(float)
            differs = ~((a == b) | (np.isnan(a) & np.isnan(b)))
            # Against the largest entry of the column, so that a zero has a measure.
            scale = np.max(np.abs(a), where=~np.isnan(a), initial=0.0)
            worst = np.max(np.abs(a[differs] - b[differs]), initial=0.0) / (scale or 1.0)
        else:
            # In words, since an empty entry is not equal to itself.
            pairs = zip(before, after, strict=True)
            differs = np.array([str(a) != str(b) for a, b in pairs], bool)
            worst = float("nan")
        if differs.any():
            yield Moved(name, str(column), int(differs.sum()), len(differs), float(worst))


def outcomes(build: Path, study: str) -> dict[str, str]:
    """Verdict of every printed value, outcome of every proof and claim."""
    found = {}
    for table, key, column in (
        ("verdicts", "id", "verdict"),
        ("errata", "key", "holds"),
        ("claims", "id", "outcome"),
    ):
        rows = read_table(build / f"data/results/{study}/{table}.csv", (key,))
        found |= {
            f"{table}/{name}": str(outcome)
            for name, outcome in zip(rows[key], rows[column], strict=True)
        }
    return found


def _content(path: Path) -> Any:
    if path.suffix != ".ipynb":
        return path.read_bytes()
    return json.dumps(_timeless(json.loads(path.read_bytes())), sort_keys=True)


def _words(path: Path) -> str:
    return NUMBER.sub("#", path.read_text()) if path.suffix in TEXTS else ""


def _timeless(node: Any) -> Any:
    if isinstance(node, dict):
        added = "injected-parameters" in node.get("metadata", {}).get("tags", [])
        passed_over = (*TIMES, "id") if added else TIMES
        return {key: _timeless(value) for key, value in node.items() if key not in passed_over}
    return [_timeless(value) for value in node] if isinstance(node, list) else node
