"""Flying the cases of a study from many initial states, into the rows of `study_tables`."""

import sys
import time
from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from smallsat.rendezvous.closed_loop import Manoeuvres, manoeuvres
from smallsat.rendezvous.study_cases import PHASES, Case
from smallsat.rendezvous.study_tables import SCHEMA, STATE, column, empty_rows, end_columns

# Manoeuvres between two lines of progress.
CHUNK = 50


def fly_cases(cases: Sequence[Case], starts: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Fly every case from its starts; progress goes to the standard error stream.

    Parameters
    ----------
    cases
        Of a group.
    starts
        One table a case: ``sample``, ``run``, and the relative state, LVLH, m and m/s.
    """
    parts = [pd.DataFrame(empty_rows(0))[SCHEMA.names]]
    for number, (case, table) in enumerate(zip(cases, starts, strict=True), start=1):
        began, done = time.perf_counter(), 0
        for chunk in _chunks(table):
            parts.append(_fly(case, chunk))
            done += len(chunk)
            print(
                f"case {number} of {len(cases)}, {case.name}: {done} of {len(table)} manoeuvres,"
                f" {time.perf_counter() - began:.1f} s",
                file=sys.stderr,
                flush=True,
            )
    return pd.concat(parts, ignore_index=True).astype(parts[0].dtypes)


def _fly(case: Case, starts: pd.DataFrame) -> pd.DataFrame:
    flown = manoeuvres([case.law], starts[list(STATE)].to_numpy(), case.phases)
    rows = empty_rows(len(starts))
    rows["case"][:] = case.name
    rows["sample"][:] = starts["sample"]
    rows["run"][:] = starts["run"]
    fill(rows, flown)
    return pd.DataFrame(rows)[SCHEMA.names]


def fill(rows: dict[str, np.ndarray], flown: Manoeuvres) -> None:
    """Write what was flown into columns of `study_tables.empty_rows`, in place."""
    rows["completed"][:] = flown.docked
    rows["end_phase"][:] = 1 + np.argmax(flown.end_times, axis=1)
    for k, phase in enumerate(PHASES):
        for name in ("steps", "softened", "outside", "failed"):
            rows[column(phase, name)][:] = getattr(flown, name)[:, k]
        before = flown.end_times[:, :k].max(axis=1, initial=0.0)
        there = flown.steps[:, k] > 0
        rows[column(phase, "time_s")][there] = (flown.end_times[:, k] - before)[there]
        rows[column(phase, "delta_v_m_s")][:] = flown.delta_v[:, k]
        rows[column(phase, "axes_delta_v_m_s")][:] = flown.delta_v_axes[:, k]
        for j, name in enumerate(end_columns(phase)):
            rows[name][:] = flown.ends[:, k, j]


def _chunks(table: pd.DataFrame) -> Iterator[pd.DataFrame]:
    for first in range(0, len(table), CHUNK):
        yield table.iloc[first : first + CHUNK]
