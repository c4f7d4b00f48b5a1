"""The five manoeuvres of Section 3.6 by the configured law, in linear motion, as tidy tables."""

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.guidance.law import PHASES, Law
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.parameters import CASES, law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import Steps, simulate
from smallsat.studies.rendezvous.simulation.delta_v import READINGS, summed
from smallsat.studies.rendezvous.simulation.motion import add_burns

# Pieces of a step in which the path between samples is looked at.
PIECES = 10


def simulate_cases(section: Flight) -> dict[str, pd.DataFrame]:
    """Simulate the cases: the tables ``flights``, ``paths`` and ``phases`` by file name.

    ``flights.parquet`` has a row a step (state before the control, velocity change, status) and a
    last row where the manoeuvre ended, ``paths.parquet`` the motion between samples, and
    ``phases.csv`` steps, times and delta-v of each phase.
    """
    laws = {case: law(section, case) for case in CASES}
    found = simulate(
        list(laws.values()), np.tile(start_state(section), (len(laws), 1)), with_steps=True
    )
    flights, paths, phases = [], [], []
    for number, case in enumerate(laws):
        steps, end = found.record(number), found.ends[number]
        # A manoeuvre that does not dock ends in the phase that it is in.
        flights.append(_flight(case, steps, end[steps.phase[-1]], laws[case]))
        paths.append(_path(case, steps, laws[case]))
        for phase, name in enumerate(PHASES):
            changes = steps.impulse[steps.phase == phase]
            phases.append(
                {
                    "flight": case,
                    "phase": name,
                    "ended": bool(found.docked[number])
                    or len(steps.impulse[steps.phase > phase]) > 0,
                    "steps": len(changes),
                    "time_s": len(changes) * laws[case].sample_times[phase],
                    **{reading: summed(changes, reading) for reading in READINGS},
                    "softened": int(found.softened[number, phase]),
                    "outside_at_start": int(found.outside[number, phase]),
                    "failed": int(found.failed[number, phase]),
                }
            )
    return {
        "flights.parquet": pd.concat(flights, ignore_index=True),
        "paths.parquet": pd.concat(paths, ignore_index=True),
        "phases.csv": pd.DataFrame(phases),
    }


def _flight(case: str, steps: Steps, end: np.ndarray, law: Law) -> pd.DataFrame:
    table = pd.DataFrame(steps.state, columns=STATE)
    table[CHANGE] = steps.impulse
    table.insert(0, "flight", case)
    table.insert(1, "phase", [PHASES[phase] for phase in steps.phase])
    table.insert(2, "time_s", steps.time)
    table["status"] = steps.status
    table["softened"] = steps.softened
    last = {
        "flight": case,
        "phase": "end",
        "time_s": float(steps.time[-1] + law.sample_times[steps.phase[-1]]),
    }
    last |= dict(zip(STATE, end, strict=True)) | dict.fromkeys(CHANGE, 0.0)
    last |= {"status": 0, "softened": 0}
    return pd.concat([table, pd.DataFrame([last])], ignore_index=True)


def _path(case: str, steps: Steps, law: Law) -> pd.DataFrame:
    """States at `PIECES` places of each step, the first right after the control."""
    matrix = rate_matrix(law.mean_motion)
    parts = []
    for phase, name in enumerate(PHASES):
        chosen = steps.phase == phase
        if not chosen.any():
            continue
        # With burns the path is that after them; it begins where it would have come from.
        after = steps.state[chosen].copy()
        for state, change in zip(after, steps.impulse[chosen], strict=True):
            add_burns(law.burn_time, law.mean_motion, change, state)
        for piece in range(PIECES + 1):
            duration = law.sample_times[phase] * piece / PIECES
            part = pd.DataFrame(after @ transition(matrix, duration).T, columns=STATE)
            part.insert(0, "flight", case)
            part.insert(1, "phase", name)
            part.insert(2, "time_s", steps.time[chosen] + duration)
            parts.append(part)
    return pd.concat(parts).sort_values(["time_s", "phase"], kind="stable")
