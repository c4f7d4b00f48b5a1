"""Simulating the cases of a study from many initial states, into the rows of `tables`."""

import sys
import time
from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import PHASES, Case
from smallsat.studies.rendezvous.monte_carlo.tables import (
    COUNTS,
    PASSAGES,
    SCHEMA,
    column,
    empty_rows,
    end_columns,
)
from smallsat.studies.rendezvous.simulation.closed_loop import (
    SUMS,
    Manoeuvres,
    simulate,
)

# Manoeuvres that are simulated at once, between two lines of progress: so many that the last ones,
# which leave lanes of the solver empty, are few.
CHUNK = 250
# More runs than any state has, so that each run has a stream of its own, whatever their number.
RUNS = 1_000_000


def simulate_cases(
    section: MonteCarlo, cases: Sequence[Case], starts: Sequence[pd.DataFrame]
) -> pd.DataFrame:
    """Simulate every case from its starts; progress goes to the standard error stream.

    Parameters
    ----------
    section
        What manoeuvres depend on.
    cases
        The cases of a group.
    starts
        One table a case: ``sample``, ``run``, and the relative state in the Hill frame, m and m/s.

    Returns
    -------
    pandas.DataFrame
        One row a manoeuvre, with the columns of `tables.SCHEMA`.
    """
    parts = [pd.DataFrame(empty_rows(0))[SCHEMA.names]]
    for number, (case, table) in enumerate(zip(cases, starts, strict=True), start=1):
        for chunk in _chunks(table, f"case {number} of {len(cases)}, {case.name}"):
            found = simulate(
                [case.law],
                chunk[STATE].to_numpy(),
                case.phases,
                case.motion,
                None if case.motion is None else generators(section, chunk),
            )
            rows = empty_rows(len(chunk))
            rows["case"][:] = case.name
            rows["sample"][:] = chunk["sample"]
            rows["run"][:] = chunk["run"]
            fill(rows, found, SUMS[section.inferred.readings.delta_v][1])
            parts.append(pd.DataFrame(rows)[SCHEMA.names])
    return pd.concat(parts, ignore_index=True).astype(parts[0].dtypes)


def simulate_passages(section: MonteCarlo, case: Case, starts: pd.DataFrame) -> pd.DataFrame:
    """Simulate one case and read off what it is with each docking distance and time limit."""
    settings = section.studies.passages
    distances, limits = settings.distances_m, settings.limits_min
    parts = [_outcomes(np.empty((0, 8)))]
    for chunk in _chunks(starts, case.name):
        passed = simulate(
            [case.law],
            chunk[STATE].to_numpy(),
            case.phases,
            case.motion,
            generators(section, chunk),
            distances=distances,
            limits=[MINUTE * limit for limit in limits],
            reading=SUMS[section.inferred.readings.delta_v][0],
        ).passages
        rows = []
        for m in range(len(chunk)):
            ids = chunk["sample"].iloc[m], chunk["run"].iloc[m]
            for i, distance in enumerate(distances):
                for j, limit in enumerate(limits):
                    docked = passed.times[m, i] <= MINUTE * limit
                    rows.append(
                        (*ids, distance, limit, docked)
                        + (
                            (passed.times[m, i], passed.delta_v[m, i])
                            if docked
                            else (MINUTE * limit, passed.delta_v_at_limits[m, j])
                        )
                    )
        parts.append(_outcomes(np.array(rows)))
    return pd.concat(parts, ignore_index=True).astype(parts[0].dtypes)


def generators(section: MonteCarlo, starts: pd.DataFrame) -> list[np.random.Generator]:
    """Random stream of each manoeuvre, by its state and run alone."""
    seed = section.studies.robustness.seed
    # The initial states themselves are drawn with the seed as it is.
    return [
        stream(seed, (sample + 1) * RUNS + run)
        for sample, run in zip(starts["sample"], starts["run"], strict=True)
    ]


def fill(rows: dict[str, np.ndarray], found: Manoeuvres, reading: str) -> None:
    """Write manoeuvres into columns of `tables.empty_rows`, in place.

    ``reading`` is the field of `Manoeuvres` that the configuration calls delta-v.
    """
    rows["completed"][:] = found.docked
    rows["end_phase"][:] = 1 + np.argmax(found.end_times, axis=1)
    rows["closest_m"][:] = found.closest
    for k, phase in enumerate(PHASES):
        for name in COUNTS:
            rows[column(phase, name)][:] = getattr(found, name)[:, k]
        before = found.end_times[:, :k].max(axis=1, initial=0.0)
        there = found.steps[:, k] > 0
        rows[column(phase, "time_s")][there] = (found.end_times[:, k] - before)[there]
        rows[column(phase, "delta_v_m_s")][:] = getattr(found, reading)[:, k]
        rows[column(phase, "norm_delta_v_m_s")][:] = found.delta_v[:, k]
        rows[column(phase, "axes_delta_v_m_s")][:] = found.delta_v_axes[:, k]
        for j, name in enumerate(end_columns(phase)):
            rows[name][:] = found.ends[:, k, j]


def _outcomes(rows: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame(
        {
            entry.name: rows[:, k].astype(entry.type.to_pandas_dtype())
            for k, entry in enumerate(PASSAGES)
        }
    )


def _chunks(table: pd.DataFrame, name: str) -> Iterator[pd.DataFrame]:
    """Parts of a table; what is done so far is said after each."""
    began = time.perf_counter()
    for first in range(0, len(table), CHUNK):
        yield table.iloc[first : first + CHUNK]
        print(
            f"{name}: {min(first + CHUNK, len(table))} of {len(table)} manoeuvres,"
            f" {time.perf_counter() - began:.1f} s",
            file=sys.stderr,
            flush=True,
        )
