"""Cases without a solution: a row each, so that one of them never stops a study."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from math import nan
from pathlib import Path

import pandas as pd

from smallsat.results import read_table

NOT_CONVERGED_COLUMNS = ("case", "status", "residual", "tried")


@dataclass(frozen=True)
class NotConverged:
    """A case that the study rests on, and that no solver of ours solved.

    What the document's own method leaves unsolved is a result and stands in the study's tables;
    it is not listed here.

    Attributes
    ----------
    case
        What was to be solved, in words that tell it from the study's other cases.
    status
        How the last attempt ended, in the solver's words.
    residual
        Largest error of the conditions where it ended, in their units; not a number if there was
        no flight.
    tried
        Every attempt, in order.
    """

    case: str
    status: str
    residual: float = nan
    tried: str = ""


def not_converged_table(cases: Iterable[NotConverged]) -> pd.DataFrame:
    """Tidy table of the cases without a solution, one a row; of no rows where all converged."""
    return pd.DataFrame([asdict(case) for case in cases], columns=list(NOT_CONVERGED_COLUMNS))


def joined(results: Path, steps: Iterable[str]) -> pd.DataFrame:
    """The cases without a solution of several steps of a study, from ``STEP-not-converged.csv``."""
    tables = [_read(results / f"{step}-not-converged.csv") for step in steps]
    found = [table for table in tables if len(table)]
    return pd.concat(found, ignore_index=True) if found else not_converged_table([])


def read_not_converged(results: Path) -> pd.DataFrame:
    """Cases without a solution of all studies of a run: study, and the table's own columns.

    Parameters
    ----------
    results
        Folder ``data/results`` of the run.
    """
    tables = [
        _read(path).assign(study=path.parent.name)
        for path in sorted(results.glob("*/not-converged.csv"))
    ]
    columns = ["study", *NOT_CONVERGED_COLUMNS]
    found = [table for table in tables if len(table)]
    return pd.concat(found, ignore_index=True)[columns] if found else pd.DataFrame(columns=columns)


def _read(path: Path) -> pd.DataFrame:
    # What was not tried is an empty text, and no missing number.
    return read_table(path, ("case", "status", "tried")).fillna({"tried": ""})
