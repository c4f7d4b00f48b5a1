"""How well a manoeuvre keeps the constraints: at samples, where they are asked for, and between.

The programs know the linear prediction and the samples only. Here the motion is followed in short
pieces, in the linear model or in the full one, with impulses or with burns.
"""

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.guidance.controller import memory_for, next_control, phase_ended
from smallsat.studies.rendezvous.guidance.law import APPROACH, PHASES, RENDEZVOUS, Law, settings
from smallsat.studies.rendezvous.model.geometry import cone_faces
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.simulation.disturbances import nonlinear_motion
from smallsat.studies.rendezvous.simulation.motion import (
    BURNS,
    COMMANDED,
    NonlinearMotion,
    begin,
    coast,
    push,
    relative,
)

PIECE_S = 1.0


def violations(law: Law, phase: int, state: np.ndarray, time: float) -> dict[str, float]:
    """By how much each constraint of a phase is violated; negative: kept with so much room.

    ``keep out``, ``overshoot``, ``cone`` in metres, ``speed`` in m/s. The cone of the mid range is
    a penalty, not a constraint.

    Parameters
    ----------
    law, phase
        The guidance law; 0, 1 or 2.
    state, time
        Relative state (6,) in the Hill frame, m and m/s, and when, s.
    """
    axis, faces = law.axis_at(time), np.empty((4, 3))
    cone_faces(axis, np.tan(law.cone_angles[phase]), faces)
    position, velocity = state[:3], state[3:]
    if phase == RENDEZVOUS:
        return {"keep out": law.keep_out - float(np.linalg.norm(position))}
    if phase == APPROACH:
        return {
            "overshoot": law.overshoot - float(axis @ position),
            "cone penalty": float((faces @ position).max()),
        }
    return {
        "cone": float((faces @ (position - law.port * axis)).max()),
        "speed": float(np.abs(velocity).max()) - law.speed_bound,
    }


def follow(law: Law, start: np.ndarray, motion: NonlinearMotion | None = None) -> pd.DataFrame:
    """Simulate one manoeuvre and look at the constraints every `PIECE_S`.

    Thrusters that burn keep to the axes of the Hill frame, piece by piece.

    Parameters
    ----------
    law, start
        The guidance law; relative state (6,) in the Hill frame, m and m/s.
    motion
        What the law guides, with a known state; ``None``: linear.

    Returns
    -------
    pandas.DataFrame
        ``phase``, ``constraint``, ``place``, ``violation``: place is ``start`` for the first
        sample of a phase, over which its programs have no power, ``sample`` or ``between``.
    """
    record, memory = settings([law])[0], memory_for(max(law.horizons))
    pair = begin(motion, np.array(start, dtype=float))
    command, applied, burn, on_times = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    time, rows = 0.0, []

    def note(phase: int, where: str) -> None:
        for name, value in violations(law, phase, relative(motion, pair), time).items():
            rows.append((PHASES[phase], name, where, value))

    for phase, duration in enumerate(law.sample_times):
        pieces = max(1, round(duration / PIECE_S))
        piece = duration / pieces
        matrix = transition(rate_matrix(law.mean_motion), piece)
        memory.remaining[0] = 0
        note(phase, "start")
        while time + duration <= law.time_limit:
            next_control(record, phase, relative(motion, pair), time, memory, command)
            push(record, motion, pair, command, 0.0, duration, burn, on_times, applied)
            for number in range(1, pieces + 1):
                coast(motion, pair, matrix, time, piece, burn, on_times)
                on_times = np.maximum(on_times - piece, 0.0)
                time += piece
                note(phase, "between" if number < pieces else "sample")
            if phase_ended(record, phase, relative(motion, pair), time):
                break
        else:
            break
    return pd.DataFrame(rows, columns=["phase", "constraint", "place", "violation"])


def table(section: Flight, laws: dict[str, Law], start: np.ndarray) -> pd.DataFrame:
    """Largest violation of each constraint by flight, motion and place.

    Parameters
    ----------
    section
        For its truth and spacecraft.
    laws
        By name.
    start
        Relative state, (6,), m and m/s.
    """
    parts = []
    for name, law in laws.items():
        for label, motion in {
            "linear": None,
            "field, impulses": nonlinear_motion(section, law, COMMANDED),
            "field, burns": nonlinear_motion(section, law, BURNS),
        }.items():
            found = follow(law, start, motion)
            largest = found.groupby(["phase", "constraint", "place"], sort=False)["violation"].max()
            part = largest.unstack().reindex(columns=["start", "sample", "between"]).reset_index()
            part.insert(0, "flight", name)
            part.insert(1, "motion", label)
            parts.append(part)
    return pd.concat(parts, ignore_index=True)
