"""What this study computes for the published results of chapters 2 and 3, in the printed units."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.not_converged import NotConverged
from smallsat.evidence.observation import Observation
from smallsat.results import read_table
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.case_tables import (
    CASE_TABLES,
    COMPARED,
    TOTAL,
    cell_id,
)
from smallsat.studies.rendezvous.guidance.law import PHASES

STANDARD_GRAVITY = 9.80665
# Section 2.1.2's example.
EXAMPLE_IMPULSE_S = 220.0
EXAMPLE_DELTA_V = 80.0
# The printed far range is short of whole steps by this much, s.
FIRST_SECOND = 1.0


def observations(section: Configuration, results: Path) -> list[Observation]:
    """All observations, from the study's result tables."""
    return [*_example(section), *_cases(section, results)]


def _example(section: Configuration) -> Iterator[Observation]:
    mass = section.spacecraft.mass_kg
    share = 1.0 - np.exp(-EXAMPLE_DELTA_V / (EXAMPLE_IMPULSE_S * STANDARD_GRAVITY))
    where = "rendezvous/section-2-1-2/propellant"
    yield Observation(f"{where}-mass-needed-example", mass * share)
    yield Observation(f"{where}-share-of-mass-example", 100.0 * share, "rocket equation")
    # The text divides the half kilogram that it has rounded to.
    rounded = np.round(mass * share, 1)
    yield Observation(
        f"{where}-share-of-mass-example", 100.0 * rounded / mass, "of the rounded propellant mass"
    )


def case_cells(section: Configuration, results: Path) -> pd.DataFrame:
    """Time, s, and delta-v, m/s, by case and phase, and in total; NaN where a phase did not end."""
    table = read_table(results / "phases.csv")
    reading = section.inferred.readings.delta_v
    rows = []
    for case, part in table.groupby("flight", sort=False):
        part = part.set_index("phase")
        times = part["time_s"].where(part["ended"])
        times["far"] -= FIRST_SECOND
        delta_v = part[reading].where(part["ended"])
        for phase in PHASES:
            rows.append((case, phase, times[phase], delta_v[phase]))
        rows.append((case, TOTAL, times.sum(skipna=False), delta_v.sum(skipna=False)))
    return pd.DataFrame(rows, columns=["case", "phase", "time_s", "delta_v_m_s"])


def undocked(results: Path) -> list[NotConverged]:
    """Cases of Section 3.6 that do not come to the end of a phase; of each its first such phase."""
    phases = read_table(results / "phases.csv")
    flights = read_table(results / "flights.parquet")
    found = []
    for case, part in phases[~phases["ended"]].groupby("flight", sort=False):
        row = part.iloc[0]
        end = flights[flights["flight"] == case].iloc[-1]
        distance = float(np.linalg.norm(end[["x_m", "y_m", "z_m"]].to_numpy(dtype=float)))
        found.append(
            NotConverged(
                f"{case}, {row['phase']} phase",
                f"not ended within {end['time_s'] / MINUTE:.0f} min, {distance:.1f} m from the "
                f"target",
                distance,
                f"{row['steps']} programs, {row['failed']} not solved, {row['softened']} softened",
            )
        )
    return found


def _cases(section: Configuration, results: Path) -> Iterator[Observation]:
    cells: Any = case_cells(section, results).set_index(["case", "phase"])
    note = "with the inferred parameters"
    for case in CASE_TABLES:
        for phase in (*PHASES, TOTAL):
            row = cells.loc[(case, phase)]
            said = note if row.notna().all() else "not converged: the phase does not end"
            yield Observation(
                f"rendezvous/{cell_id('total-delta-v', case, phase)}", row["delta_v_m_s"], note=said
            )
            yield Observation(
                f"rendezvous/{cell_id('time', case, phase)}", row["time_s"], note=said
            )
    where = "rendezvous/section-3-6-1"
    first = cells.loc[("v-bar", TOTAL)]
    yield Observation(f"{where}/maneuver-time/case-1-v-bar", first["time_s"] / MINUTE)
    yield Observation(f"{where}/total-delta-v/case-1-v-bar", first["delta_v_m_s"])
    for case, name in COMPARED.items():
        row = cells.loc[(case, TOTAL)]
        minutes = row["time_s"] / MINUTE
        yield Observation(f"rendezvous/table-3-6/total-delta-v/{name}", row["delta_v_m_s"])
        yield Observation(f"rendezvous/table-3-6/time/{name}", minutes)
        yield Observation(f"rendezvous/section-3-6-4/maneuver-time/{name}", minutes)
