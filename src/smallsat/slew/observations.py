"""What this study computes for every published result, in the printed units."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.dynamics.kepler_orbits import period
from smallsat.evidence.observation import Observation
from smallsat.results import read_table
from smallsat.slew.environment_study import crossover_km
from smallsat.slew.parameters import KM, Parameters
from smallsat.slew.simulation import angles_deg, usage_pct

AXES = "xyz"
MINUTE = 60.0
# The printed yaw error that "comparable" is measured by, deg (Section VI.B).
COMPARABLE_DEG = 0.9
RATES = ["omega_x", "omega_y", "omega_z"]
TURNS = {"quarter": "90-deg", "half": "180-deg"}
ANGLES = {"quarter": 90.0, "half": 180.0}
# The document's mesh is one segment; ours are several.
PLANS = {
    "90-deg": ("90 deg, one segment", "90 deg, segments"),
    "180-deg": (
        "180 deg, least infeasible, one segment",
        "180 deg, least infeasible, segments",
    ),
}


def observations(section: Config, given: Parameters, results: Path) -> list[Observation]:
    """All observations, from the study's result tables."""
    return [
        *_orbit(given, results),
        *_durations(given, results),
        *_eigenaxis(given, results),
        *_torque_optimal(given, results),
        *_crossover(section, results),
    ]


def _orbit(given: Parameters, results: Path) -> Iterator[Observation]:
    a, e = given.orbit.semi_major_axis, given.orbit.eccentricity
    radius = given.gravity.radius
    where = "slew/section-v-f/orbit"
    yield Observation(f"{where}-perigee-altitude", (a * (1.0 - e) - radius) / KM)
    yield Observation(f"{where}-apogee-altitude", (a * (1.0 + e) - radius) / KM)
    yield Observation(f"{where}-period", period(a, given.gravity.mu) / MINUTE)
    table = read_table(results / "orbit.csv")
    rows = table[(table["gravity"] == "J2") & (table["integrator"] == "order 8")]
    # The last one is what follows from the elements; the printed start is a rounded one.
    for start in ("the printed initial state", "the orbital elements"):
        row = rows[rows["start"] == start].iloc[0]
        for axis in AXES:
            run = f"from {start}, with J2"
            yield Observation(f"slew/table-2/r-f/{axis}", row[f"{axis}_km"], run)
            yield Observation(f"slew/table-2/v-f/{axis}", row[f"v{axis}_km_s"], run)


def scaled_durations(given: Parameters, results: Path) -> pd.DataFrame:
    """Eq. 30 for the smallest and largest moment of inertia: one row a line of Table 3."""
    times = read_table(results / "minimum-times.csv").set_index("case")["duration_s"]
    scales = np.sqrt(np.diag(given.inertia)[[0, 2]] / given.torque)
    rows = []
    for case, angle in (("90-deg", np.pi / 2.0), ("180-deg", np.pi)):
        # Full torque forth and back about one axis.
        rows.append((f"{case}-eigenaxis", 2.0 * np.sqrt(angle)))
        name = f"benchmark, {case.replace('-', ' ')}"
        rows.append((f"{case}-time-optimal", float(times[name])))
    return pd.DataFrame(
        [
            {"case": case, "t_hat": t, "t_min": t * scales[0], "t_max": t * scales[1]}
            for case, t in rows
        ]
    )


def _durations(given: Parameters, results: Path) -> Iterator[Observation]:
    for row in scaled_durations(given, results).to_dict("records"):
        yield Observation(f"slew/table-3/t-min/{row['case']}", row["t_min"])
        yield Observation(f"slew/table-3/t-max/{row['case']}", row["t_max"])


def _eigenaxis(given: Parameters, results: Path) -> Iterator[Observation]:
    flights = read_table(results / "flights.parquet")
    for case, turn in TURNS.items():
        flown = flights[flights["flight"] == f"eigenaxis {case}"]
        roll, pitch, yaw = angles_deg(flown.tail(1))[0]
        _, momentum = usage_pct(flown, given)
        where, name = "slew/section-vi-a", f"{turn}-eigenaxis"
        yield Observation(f"{where}/final-yaw-angle/{name}", yaw)
        yield Observation(f"{where}/yaw-undershoot/{name}", ANGLES[case] - yaw)
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
            comparable_time(settled, ANGLES[case]),
        )


def comparable_time(flown: pd.DataFrame, angle: float) -> float:
    """Time, s, from which the yaw stays within the printed error of the 180 deg run."""
    error = np.abs(angle - np.abs(angles_deg(flown)[:, 2]))
    late = np.flatnonzero(error > COMPARABLE_DEG)
    return float(flown["time_s"].to_numpy()[late[-1] + 1])


def _torque_optimal(given: Parameters, results: Path) -> Iterator[Observation]:
    replays = read_table(results / "replays.parquet")
    where = "slew/section-vi-b"
    for turn, plans in PLANS.items():
        name = f"{turn}-torque-optimal"
        # The document's mesh last: it is the one shown.
        for plan in reversed(plans):
            flown = replays[replays["flight"] == plan]
            roll, pitch, yaw = angles_deg(flown.tail(1))[0]
            _, momentum = usage_pct(flown, given)
            yield Observation(f"{where}/final-yaw-angle/{name}", yaw, plan)
            yield Observation(f"{where}/final-roll-angle/{name}", roll, plan)
            yield Observation(f"{where}/final-pitch-angle/{name}", pitch, plan)
            if turn == "180-deg":
                yield Observation(f"{where}/yaw-pointing-error/{name}", 180.0 - abs(yaw), plan)
            rates = np.abs(np.degrees(flown[RATES].to_numpy()[-1]))
            for i, axis in enumerate(AXES):
                peak = float(np.abs(momentum[:, i]).max())
                final = float(abs(momentum[-1, i]))
                yield Observation(f"{where}/final-angular-rate/{name}/{axis}", rates[i], plan)
                yield Observation(
                    f"{where}/maximum-angular-momentum-usage/{name}/{axis}", peak, plan
                )
                yield Observation(
                    f"{where}/final-angular-momentum-usage/{name}/{axis}", final, plan
                )


def _crossover(section: Config, results: Path) -> Iterator[Observation]:
    table = read_table(results / "environment.csv")
    offset = max(section["environment"]["offsets_mm"])
    yield Observation(
        "slew/section-v-c/altitude-above-which-gravity-gradient-dominates/environment-torque-study",
        crossover_km(table, offset),
        run=f"centre of pressure {offset:g} mm off the centre, assumed",
    )


def timings(results: Path) -> pd.DataFrame:
    """Our seconds for the printed ones: columns id and seconds."""
    seconds = read_table(results / "plan-seconds.csv").set_index("plan")["seconds"]
    propagator = float(seconds["on-board propagator"])
    rows = []
    for turn, (plan, _) in PLANS.items():
        for processor in ("i7-2700k", "core2duo-t7700"):
            for quantity, value in (
                ("propagator", propagator),
                ("guidance", float(seconds[plan])),
                ("total", propagator + float(seconds[plan])),
            ):
                rows.append(
                    {
                        "id": f"slew/table-4/{quantity}-run-time/{turn}-{processor}",
                        "seconds": value,
                    }
                )
    return pd.DataFrame(rows)
