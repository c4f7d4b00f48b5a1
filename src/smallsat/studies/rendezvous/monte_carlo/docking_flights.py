"""The docking phase of disturbed manoeuvres by samples: constraints kept, and ways to the port.

Only the true states are looked at, the law's estimates are not.
"""

import numpy as np
import pandas as pd

from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.guidance.law import DOCKING, Law
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.model.geometry import cone_faces
from smallsat.studies.rendezvous.monte_carlo.cases import (
    AS_DOCUMENTED,
    PATH,
    TUBE,
    Case,
    cases,
    near_errors_case,
    near_errors_tube_case,
)
from smallsat.studies.rendezvous.monte_carlo.runs import CHUNK, generators
from smallsat.studies.rendezvous.simulation.closed_loop import Manoeuvres, simulate

# Of the manoeuvres, by their worst sample.
HIGH = 0.95


def docking_flights(section: MonteCarlo, states: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Fly the laws with and without a tube from the disturbed states.

    Parameters
    ----------
    section
        What manoeuvres depend on.
    states
        ``sample`` and the relative state in the Hill frame, m and m/s.

    Returns
    -------
    dict
        ``constraints``, a row a case: share of the samples after the docking phase's first that
        violate the cone or the speed, per cent, and the worst violation of a manoeuvre, m and m/s,
        its median and 95 % quantile; zero where none is violated. ``ways``: distance from the
        port, m, over the time since docking began, s, of the runs from the first state.
    """
    studies = section.studies.robustness
    best = min(studies.near_error_shares)
    names = (AS_DOCUMENTED, PATH, TUBE, near_errors_case(best), near_errors_tube_case(best))
    flown = {case.name: case for case in cases(section, "robustness")}
    runs = range(studies.variant_runs)
    starts = pd.concat([states.assign(run=np.int32(run)) for run in runs], ignore_index=True)
    starts = starts.sort_values(["sample", "run"], ignore_index=True)
    kept, ways = [], []
    for name in names:
        rows = []
        for first in range(0, len(starts), CHUNK):
            chunk = starts.iloc[first : first + CHUNK]
            found = _fly(section, flown[name], chunk)
            for m, (sample, run) in enumerate(zip(chunk["sample"], chunk["run"], strict=True)):
                time, state = _docking(found, m)
                rows.append(_violations(flown[name].law, state[1:]))
                if sample == starts["sample"].iloc[0]:
                    port = flown[name].law.port * np.array(flown[name].law.axis)
                    away = np.linalg.norm(state[:, :3] - port, axis=1)
                    way = pd.DataFrame({"time_s": time, "distance_m": away})
                    ways.append(way.assign(case=name, run=run))
        kept.append({"case": name} | _summary(pd.DataFrame(rows)))
    columns = ["case", "run", "time_s", "distance_m"]
    return {"constraints": pd.DataFrame(kept), "ways": pd.concat(ways, ignore_index=True)[columns]}


def _fly(section: MonteCarlo, case: Case, starts: pd.DataFrame) -> Manoeuvres:
    return simulate(
        [case.law],
        starts[STATE].to_numpy(),
        motion=case.motion,
        generators=generators(section, starts),
        with_steps=True,
    )


def _docking(found: Manoeuvres, m: int) -> tuple[np.ndarray, np.ndarray]:
    """Times since the docking phase began, s, and true states (K, 6) of one manoeuvre in it."""
    steps = found.record(m)
    inside = steps.phase == DOCKING
    time, state = steps.time[inside], steps.state[inside]
    return time - time[:1], state


def _violations(law: Law, states: np.ndarray) -> dict[str, float]:
    """Counts and worst violations of the law's untightened cone and speed over states (K, 6)."""
    faces, axis = np.empty((4, 3)), np.array(law.axis)
    cone_faces(axis, np.tan(law.cone_angles[DOCKING]), faces)
    cone = ((states[:, :3] - law.port * axis) @ faces.T).max(axis=1, initial=-np.inf)
    speed = np.abs(states[:, 3:]).max(axis=1, initial=-np.inf) - law.speed_bound
    return {
        "samples": len(states),
        "cone_samples": int((cone > 0.0).sum()),
        "speed_samples": int((speed > 0.0).sum()),
        "cone_m": float(cone.max(initial=0.0)),
        "speed_m_s": float(speed.max(initial=0.0)),
    }


def _summary(rows: pd.DataFrame) -> dict[str, float]:
    samples = max(int(rows["samples"].sum()), 1)
    return {
        "manoeuvres": len(rows),
        "cone_samples_pct": 100.0 * float(rows["cone_samples"].sum()) / samples,
        "cone_median_m": float(rows["cone_m"].median()),
        "cone_high_m": float(rows["cone_m"].quantile(HIGH)),
        "speed_samples_pct": 100.0 * float(rows["speed_samples"].sum()) / samples,
        "speed_median_m_s": float(rows["speed_m_s"].median()),
        "speed_high_m_s": float(rows["speed_m_s"].quantile(HIGH)),
    }
