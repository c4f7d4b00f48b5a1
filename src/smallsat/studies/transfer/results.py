"""Reading the study's own results, and finding the case that a printed value speaks of."""

import re
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from smallsat.results import read_table

CASE_TABLES = (
    "indirect",
    "as-published",
    "converged",
    "unbounded",
    "continuous",
    "multistart",
    "tighter_bounds",
)


@dataclass(frozen=True)
class PrintedCase:
    """A case as the ledger names it: ``Direct Multiple Shooting N=2 K=4``.

    ``degree`` is 0 for the indirect methods and ``intervals`` is 1 for single shooting.
    """

    method: str
    degree: int
    intervals: int


def parse_case(name: str) -> PrintedCase | None:
    """Read a case of the ledger; None where it names no single case."""
    match = re.fullmatch(
        r"(Indirect|Direct)( Multiple)? Shooting(?: N=(\d+))?(?: K=(\d+))?", name.strip()
    )
    if not match:
        return None
    kind, multiple, degree, intervals = match.groups()
    if bool(multiple) != bool(intervals) or (kind == "Direct") != bool(degree):
        return None
    return PrintedCase(kind.lower(), int(degree or 0), int(intervals or 1))


def read_cases(results: Path) -> pd.DataFrame:
    """All solved cases: one row for each method, run, degree and number of intervals."""
    tables = [read_table(results / f"{name}.csv") for name in CASE_TABLES]
    return pd.concat(tables, ignore_index=True)


def indirect_times(cases: pd.DataFrame) -> pd.Series:
    """Final time of the indirect cases, by number of intervals.

    Raises
    ------
    LookupError
        If one of them did not converge.
    """
    rows = cases[cases["method"] == "indirect"].set_index("intervals")
    if not rows["converged"].all():
        raise LookupError("an indirect case that did not converge")
    return rows["final_time"]


def select(cases: pd.DataFrame, case: PrintedCase, run: str) -> pd.DataFrame:
    """Rows of one case in one run."""
    return cases[
        (cases["method"] == case.method)
        & (cases["run"] == run)
        & (cases["degree"] == case.degree)
        & (cases["intervals"] == case.intervals)
    ]


def final_times(cases: pd.DataFrame, run: str) -> pd.Series:
    """Final time of the direct multiple shooting cases of a run, by (degree, intervals).

    Without the cases that did not converge.
    """
    rows = cases[(cases["method"] == "direct") & (cases["run"] == run) & (cases["intervals"] > 1)]
    rows = rows[rows["final_time"].notna()]
    return rows.set_index(["degree", "intervals"])["final_time"].sort_index()
