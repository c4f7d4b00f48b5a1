"""Flying the cases of a study from many initial states, into the rows of `study_tables`."""

import sys
import time
from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.monte_carlo.cases import MINUTE, PHASES, Case
from smallsat.studies.rendezvous.monte_carlo.tables import (
    PASSAGES,
    SCHEMA,
    STATE,
    column,
    empty_rows,
    end_columns,
)
from smallsat.studies.rendezvous.simulation.closed_loop import Manoeuvres, manoeuvres
from smallsat.studies.rendezvous.simulation.disturbed_loop import disturbed_manoeuvres

# Manoeuvres between two lines of progress.
CHUNK = 50
# More runs than any state has, so that each run has a stream of its own, whatever their number.
RUNS = 1_000_000
# Sums of the loops, in their order, by the names that the configuration has for them.
READINGS = {"2-norm": "delta_v", "1-norm": "delta_v_axes", "plane and normal": "delta_v_planes"}


def fly_cases(
    section: Config, cases: Sequence[Case], starts: Sequence[pd.DataFrame]
) -> pd.DataFrame:
    """Fly every case from its starts; progress goes to the standard error stream.

    Parameters
    ----------
    section
        Of the configuration.
    cases
        Of a group.
    starts
        One table a case: ``sample``, ``run``, and the relative state, LVLH, m and m/s.
    """
    parts = [pd.DataFrame(empty_rows(0))[SCHEMA.names]]
    for number, (case, table) in enumerate(zip(cases, starts, strict=True), start=1):
        for chunk in _chunks(table, f"case {number} of {len(cases)}, {case.name}"):
            flown = _fly(section, case, chunk)
            rows = empty_rows(len(chunk))
            rows["case"][:] = case.name
            rows["sample"][:] = chunk["sample"]
            rows["run"][:] = chunk["run"]
            fill(rows, flown, READINGS[section["inferred"]["readings"]["delta_v"]])
            parts.append(pd.DataFrame(rows)[SCHEMA.names])
    return pd.concat(parts, ignore_index=True).astype(parts[0].dtypes)


def fly_passages(section: Config, case: Case, starts: pd.DataFrame) -> pd.DataFrame:
    """Fly one case and read off what it is with each docking distance and time limit."""
    settings = section["studies"]["passages"]
    distances, limits = settings["distances_m"], settings["limits_min"]
    parts = [_outcomes(np.empty((0, 8)))]
    for chunk in _chunks(starts, case.name):
        assert case.world is not None
        _, passed = disturbed_manoeuvres(
            case.law,
            chunk[list(STATE)].to_numpy(),
            case.world,
            generators(section, chunk),
            case.phases,
            distances,
            [MINUTE * limit for limit in limits],
            list(READINGS).index(section["inferred"]["readings"]["delta_v"]),
        )
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


def generators(section: Config, starts: pd.DataFrame) -> list[np.random.Generator]:
    """Random stream of each manoeuvre, by its state and run alone."""
    seed = section["studies"]["robustness"]["seed"]
    # The initial states themselves are drawn with the seed as it is.
    return [
        stream(seed, (sample + 1) * RUNS + run)
        for sample, run in zip(starts["sample"], starts["run"], strict=True)
    ]


def _fly(section: Config, case: Case, starts: pd.DataFrame) -> Manoeuvres:
    states = starts[list(STATE)].to_numpy()
    if case.world is None:
        return manoeuvres([case.law], states, case.phases)
    flown, _ = disturbed_manoeuvres(
        case.law, states, case.world, generators(section, starts), case.phases
    )
    return flown


def fill(rows: dict[str, np.ndarray], flown: Manoeuvres, reading: str) -> None:
    """Write what was flown into columns of `study_tables.empty_rows`, in place.

    ``reading`` is one of the values of `READINGS`.
    """
    rows["completed"][:] = flown.docked
    rows["end_phase"][:] = 1 + np.argmax(flown.end_times, axis=1)
    for k, phase in enumerate(PHASES):
        for name in ("steps", "softened", "outside", "failed"):
            rows[column(phase, name)][:] = getattr(flown, name)[:, k]
        before = flown.end_times[:, :k].max(axis=1, initial=0.0)
        there = flown.steps[:, k] > 0
        rows[column(phase, "time_s")][there] = (flown.end_times[:, k] - before)[there]
        rows[column(phase, "delta_v_m_s")][:] = getattr(flown, reading)[:, k]
        rows[column(phase, "norm_delta_v_m_s")][:] = flown.delta_v[:, k]
        rows[column(phase, "axes_delta_v_m_s")][:] = flown.delta_v_axes[:, k]
        for j, name in enumerate(end_columns(phase)):
            rows[name][:] = flown.ends[:, k, j]


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
