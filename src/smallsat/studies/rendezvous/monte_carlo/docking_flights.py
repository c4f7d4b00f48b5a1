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
        ``constraints``, a row a case: of the samples of docking from the first that keeps a
        constraint, cone or speed, the share that violates it again, per cent, and the worst
        violation of a manoeuvre, m and m/s, its median and 95 % quantile; zero where there is
        none. ``ways``: distance from the port, m, over the time since docking began, s, of the
        runs from the first state.
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
                rows.append(_violations(flown[name].law, state))
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
    """Samples, and violations of the law's untightened cone and speed, over states (K, 6)."""
    faces, axis = np.empty((4, 3)), np.array(law.axis)
    cone_faces(axis, np.tan(law.cone_angles[DOCKING]), faces)
    excess = {
        "cone": ((states[:, :3] - law.port * axis) @ faces.T).max(axis=1),
        "speed": np.abs(states[:, 3:]).max(axis=1) - law.speed_bound,
    }
    found: dict[str, float] = {}
    for name, values in excess.items():
        later = values[np.logical_or.accumulate(values <= 0.0)]
        found |= {
            f"{name}_samples": len(later),
            f"{name}_violated": int((later > 0.0).sum()),
            f"{name}_worst": float(later.max(initial=0.0)),
        }
    return found


def _summary(rows: pd.DataFrame) -> dict[str, float]:
    found: dict[str, float] = {"manoeuvres": len(rows)}
    for name, unit in (("cone", "m"), ("speed", "m_s")):
        violated, samples = rows[f"{name}_violated"].sum(), rows[f"{name}_samples"].sum()
        worst = rows[f"{name}_worst"]
        found |= {
            f"{name}_samples_pct": 100.0 * float(violated) / max(int(samples), 1),
            f"{name}_median_{unit}": float(worst.median()),
            f"{name}_high_{unit}": float(worst.quantile(HIGH)),
        }
    return found
