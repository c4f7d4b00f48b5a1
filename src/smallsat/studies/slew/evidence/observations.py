"""What this study computes for every published result, in the printed units."""

from collections.abc import Iterator
from dataclasses import replace
from math import nan
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.quaternions import roll_pitch_yaw
from smallsat.dynamics.orbits.kepler_orbits import period
from smallsat.dynamics.units import KM, MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.evidence.observation import Observation
from smallsat.results import read_table
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.environment_study import crossover_km, printed_lever_mm
from smallsat.studies.slew.methods.plan_names import (
    EULER,
    ONE_SEGMENT,
    SEGMENTS,
    SHOWN,
    WHEELS,
    plan_names,
)
from smallsat.studies.slew.model.simulation import angles_deg, usage_pct
from smallsat.studies.slew.parameters import Parameters

AXES = "xyz"
NO_LEAST_TIME = "not converged: no least time was found"
NO_PLAN = "not converged: there is no plan"
NO_LEVER = "this run leaves out the lever of Table 5"
RATES = ["omega_x", "omega_y", "omega_z"]
TURNS = {"quarter": "90-deg", "half": "180-deg"}
# What the document calls its turns where it prints their angles.
PRINTED_CASES = {"quarter": "case-1", "half": "case-2"}
# Ours, and the document's mesh last: it is the one shown.
MESHES = (SEGMENTS, ONE_SEGMENT)


def observations(
    section: Configuration, parameters: Parameters, results: Path, ledger: Ledger
) -> list[Observation]:
    """All observations, from the study's result tables."""
    return [
        *_orbit(parameters, results),
        *_durations(parameters, results),
        *_eigenaxis(parameters, results, ledger),
        *_torque_optimal(parameters, results),
        *_crossover(section, results),
    ]


def _orbit(parameters: Parameters, results: Path) -> Iterator[Observation]:
    a, e = parameters.orbit.semi_major_axis, parameters.orbit.eccentricity
    radius = parameters.gravity.radius
    where = "slew/section-v-f/orbit"
    yield Observation(f"{where}-perigee-altitude", (a * (1.0 - e) - radius) / KM)
    yield Observation(f"{where}-apogee-altitude", (a * (1.0 + e) - radius) / KM)
    yield Observation(f"{where}-period", period(a, parameters.gravity.mu) / MINUTE)
    table = read_table(results / "orbit.csv")
    rows = table[(table["gravity"] == "J2") & (table["integrator"] == "order 8")]
    # The last one is what follows from the elements; the printed start is a rounded one.
    for start in ("the printed initial state", "the orbital elements"):
        row = rows[rows["start"] == start].iloc[0]
        for axis in AXES:
            run = f"from {start}, with J2"
            yield Observation(f"slew/table-2/r-f/{axis}", row[f"{axis}_km"], run)
            yield Observation(f"slew/table-2/v-f/{axis}", row[f"v{axis}_km_s"], run)


def scaled_durations(parameters: Parameters, results: Path) -> pd.DataFrame:
    """Eq. 30 for the smallest and largest moment of inertia: one row a line of Table 3."""
    times = read_table(results / "minimum-times.csv").set_index("case")["duration_s"]
    scales = np.sqrt(np.linalg.eigvalsh(parameters.inertia)[[0, 2]] / parameters.torque)
    rows = []
    for case, turn in TURNS.items():
        # Full torque forth and back about one axis.
        angle = np.radians(parameters.angle_deg(case))
        rows.append((f"{turn}-eigenaxis", 2.0 * np.sqrt(angle)))
        rows.append((f"{turn}-time-optimal", float(times[f"benchmark, {parameters.names[case]}"])))
    return pd.DataFrame(
        [
            {"case": case, "t_hat": t, "t_min": t * scales[0], "t_max": t * scales[1]}
            for case, t in rows
        ]
    )


def _durations(parameters: Parameters, results: Path) -> Iterator[Observation]:
    for row in scaled_durations(parameters, results).to_dict("records"):
        note = NO_LEAST_TIME if np.isnan(row["t_hat"]) else ""
        yield Observation(f"slew/table-3/t-min/{row['case']}", row["t_min"], note=note)
        yield Observation(f"slew/table-3/t-max/{row['case']}", row["t_max"], note=note)


def _eigenaxis(parameters: Parameters, results: Path, ledger: Ledger) -> Iterator[Observation]:
    flights = read_table(results / "flights.parquet")
    for case, turn in TURNS.items():
        flown = flights[flights["flight"] == f"eigenaxis {case}"]
        roll, pitch, yaw = angles_deg(flown.tail(1))[0]
        _, momentum = usage_pct(flown, parameters)
        where, name = "slew/section-vi-a", f"{turn}-eigenaxis"
        yield Observation(f"{where}/final-yaw-angle/{name}", yaw)
        yield Observation(
            f"{where}/yaw-undershoot/{name}", short_of(yaw, target_yaw(parameters, case))
        )
        yield Observation(f"{where}/roll-angle/{name}", roll)
        yield Observation(f"{where}/pitch-angle/{name}", pitch)
        rate = float(np.degrees(flown["omega_z"].iloc[-1]))
        yield Observation(f"{where}/residual-omega-z/{name}/z", rate)
        peak = float(np.abs(momentum[:, 2]).max())
        yield Observation(f"{where}/maximum-angular-momentum-usage/{name}/z", peak)
        yield Observation(f"{where}/final-angular-momentum-usage/{name}/z", momentum[-1, 2])
        settled = flights[flights["flight"] == f"eigenaxis {case}, no time limit"]
        yield Observation(
            f"slew/section-vi-b/eigenaxis-time-for-comparable-yaw-and-rates/{turn}-no-time-limit",
            time := comparable_time(
                settled, target_yaw(parameters, case), *printed_end(ledger, case)
            ),
            note="not within the printed end when the flight ends" if np.isnan(time) else "",
        )


def target_yaw(parameters: Parameters, case: str) -> float:
    """Yaw of a turn's target, deg."""
    return float(np.degrees(roll_pitch_yaw(tuple(parameters.targets[case]))[2]))


def short_of(angle: float, target: float) -> float:
    """How far an angle is short of a target, deg, the shorter way around."""
    return min((target + turn - angle for turn in (0.0, -360.0, 360.0)), key=abs)


def printed_end(ledger: Ledger, case: str) -> tuple[float, float]:
    """Yaw error, deg, and rate about z, deg/s, of the document's torque-optimal run of a turn."""
    turn = f"{TURNS[case]}-torque-optimal"
    yaw = ledger.value(f"section-vi-b/final-yaw-angle/{turn}").value
    rate = ledger.value(f"section-vi-b/final-angular-rate/{turn}/z").value
    target = ledger.value(f"section-v-f/rotation-angle-about-body-z/{PRINTED_CASES[case]}").value
    return abs(short_of(yaw, target)), rate


def comparable_time(flown: pd.DataFrame, target: float, within: float, rate: float) -> float:
    """Time, s, from which yaw error, deg, and rate about z, deg/s, stay within limits.

    Not a number where they do not within the flight.
    """
    error = np.array([abs(short_of(yaw, target)) for yaw in angles_deg(flown)[:, 2]])
    late = np.flatnonzero((error > within) | (np.degrees(flown["omega_z"].abs()) > rate))
    since = late[-1] + 1 if len(late) else 0
    return float(flown["time_s"].to_numpy()[since]) if since < len(flown) else nan


def _torque_optimal(parameters: Parameters, results: Path) -> Iterator[Observation]:
    replays = read_table(results / "replays.parquet")
    for case, turn in TURNS.items():
        target = target_yaw(parameters, case)
        # The run that is shown comes last.
        runs = [(ONE_SEGMENT, EULER)] if EULER in SHOWN[case] else []
        for kind, model in runs + [(kind, WHEELS) for kind in MESHES]:
            plan, flown = chosen_plan(replays, "flight", parameters, case, kind, model)
            for observed in _flown_plan(flown, parameters, f"{turn}-torque-optimal", target):
                yield replace(observed, run=plan, note="" if len(flown) else NO_PLAN)


def _flown_plan(
    flown: pd.DataFrame, parameters: Parameters, name: str, target: float
) -> Iterator[Observation]:
    """End and peaks of a flight; not a number where there is none."""
    where = "slew/section-vi-b"
    angles, rates, momentum = np.full(3, nan), np.full(3, nan), np.full((1, 3), nan)
    if len(flown):
        angles = angles_deg(flown.tail(1))[0]
        rates = np.abs(np.degrees(flown[RATES].to_numpy()[-1]))
        _, momentum = usage_pct(flown, parameters)
    roll, pitch, yaw = angles
    yield Observation(f"{where}/final-yaw-angle/{name}", yaw)
    yield Observation(f"{where}/final-roll-angle/{name}", roll)
    yield Observation(f"{where}/final-pitch-angle/{name}", pitch)
    if name.startswith(TURNS["half"]):
        yield Observation(f"{where}/yaw-pointing-error/{name}", abs(short_of(yaw, target)))
    for i, axis in enumerate(AXES):
        peak = float(np.abs(momentum[:, i]).max())
        final = float(abs(momentum[-1, i]))
        yield Observation(f"{where}/final-angular-rate/{name}/{axis}", rates[i])
        yield Observation(f"{where}/maximum-angular-momentum-usage/{name}/{axis}", peak)
        yield Observation(f"{where}/final-angular-momentum-usage/{name}/{axis}", final)


def chosen_plan(
    table: pd.DataFrame,
    column: str,
    parameters: Parameters,
    case: str,
    kind: str,
    model: str = WHEELS,
) -> tuple[str, pd.DataFrame]:
    """The plan of a turn on a mesh that a table has: its name and rows, of least torque first."""
    for name in plan_names(parameters, case, kind, model):
        rows = table[table[column] == name]
        if len(rows):
            break
    return name, rows


def _crossover(section: Configuration, results: Path) -> Iterator[Observation]:
    table = read_table(results / "environment.csv")
    lever = printed_lever_mm(section)
    studied = np.isclose(table["offset_mm"], lever).any()
    crossing = crossover_km(table, lever) if studied else nan
    larger = "drag is the larger at every altitude of this run"
    yield Observation(
        "slew/section-v-c/altitude-above-which-gravity-gradient-dominates/environment-torque-study",
        crossing,
        run=f"centre of pressure {lever:g} mm off the centre, as in Table 5",
        note="" if not np.isnan(crossing) else larger if studied else NO_LEVER,
    )


def timings(parameters: Parameters, results: Path) -> pd.DataFrame:
    """Our seconds for the printed ones: columns id and seconds."""
    seconds = read_table(results / "plan-seconds.csv")
    propagator = float(seconds["seconds"].iloc[-1])
    rows = []
    for case, turn in TURNS.items():
        _, solved = chosen_plan(seconds, "plan", parameters, case, MESHES[-1])
        guidance = float(solved["seconds"].iloc[0])
        for processor in ("i7-2700k", "core2duo-t7700"):
            for quantity, value in (
                ("propagator", propagator),
                ("guidance", guidance),
                ("total", propagator + guidance),
            ):
                rows.append(
                    {
                        "id": f"slew/table-4/{quantity}-run-time/{turn}-{processor}",
                        "seconds": value,
                    }
                )
    return pd.DataFrame(rows)
