"""How well a manoeuvre keeps the constraints: at samples, where they are asked for, and between.

The programs know the linear prediction and the samples only. Here the motion is followed in short
pieces, in the linear model or in the full one, with impulses or with burns.
"""

from typing import Protocol

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.optimal_control.riccati_interior_point import workspace
from smallsat.studies.rendezvous.guidance.law import PHASES, Law, settings
from smallsat.studies.rendezvous.guidance.phase_programs import BOUNDS, PLANES, program_room
from smallsat.studies.rendezvous.model.environment import environment, target_state
from smallsat.studies.rendezvous.model.geometry import cone_faces, rotated
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import (
    Environment,
    advance,
    pair_from_relative,
    relative_state,
)
from smallsat.studies.rendezvous.simulation.closed_loop import next_control, phase_ended

PIECE_S = 1.0


class Motion(Protocol):
    """What the guidance moves; states are relative ones, m and m/s."""

    def state(self) -> np.ndarray:
        """Relative state, (6,)."""

    def control(self, velocity_change: np.ndarray) -> None:
        """Begin a step with a velocity change, (3,), m/s."""

    def move(self, time: float, duration: float) -> None:
        """Go on for a while."""


class LinearMotion:
    """Clohessy and Wiltshire's equations, impulses."""

    def __init__(self, mean_motion: float, start: np.ndarray):
        self._matrix = rate_matrix(mean_motion)
        self._state = np.array(start, dtype=float)

    def state(self) -> np.ndarray:
        """Relative state."""
        return self._state.copy()

    def control(self, velocity_change: np.ndarray) -> None:
        """Change the velocity."""
        self._state[3:] += velocity_change

    def move(self, time: float, duration: float) -> None:
        """Multiply by the transition."""
        self._state = transition(self._matrix, duration) @ self._state


class FieldMotion:
    """Two bodies in the Earth's field with drag; impulses, or burns of a thruster, kg and N."""

    def __init__(
        self,
        around: Environment,
        target: np.ndarray,
        start: np.ndarray,
        thruster: tuple[float, float] | None = None,
    ):
        self._around, self._thruster = around, thruster
        self._pair = pair_from_relative(target, np.array(start, dtype=float))
        self._left, self._acceleration = np.zeros(3), np.zeros(3)

    def state(self) -> np.ndarray:
        """Relative state."""
        return relative_state(self._pair)

    def control(self, velocity_change: np.ndarray) -> None:
        """Change the velocity, or open the thrusters for the time that this takes."""
        if self._thruster is None:
            state = relative_state(self._pair)
            state[3:] += velocity_change
            self._pair = pair_from_relative(self._pair[0], state)
            return
        mass, force = self._thruster
        pulse_on_times(velocity_change, mass, force, 0.0, self._left)
        thrust_acceleration(velocity_change, mass, force, self._acceleration)

    def move(self, time: float, duration: float) -> None:
        """Integrate; thrusters burn along the axes at the start of the piece."""
        burning = np.minimum(self._left, duration)
        advance(self._pair, time, duration, self._acceleration, burning, self._around)
        self._left -= burning


def violations(law: Law, phase: int, state: np.ndarray, time: float) -> dict[str, float]:
    """By how much each constraint of a phase is violated; negative: kept with so much room.

    ``keep out``, ``overshoot``, ``cone`` in metres, ``speed`` in m/s. The cone of the mid range is
    a penalty, not a constraint.
    """
    axis, faces = np.empty(3), np.empty((4, 3))
    rotated(np.array(law.axis), law.rotation_rate * time, axis)
    cone_faces(axis, np.tan(law.cone_angles[phase]), faces)
    position, velocity = state[:3], state[3:]
    if phase == 0:
        return {"keep out": law.keep_out - float(np.linalg.norm(position))}
    if phase == 1:
        return {
            "overshoot": law.overshoot - float(axis @ position),
            "cone penalty": float((faces @ position).max()),
        }
    return {
        "cone": float((faces @ (position - law.port * axis)).max()),
        "speed": float(np.abs(velocity).max()) - law.speed_bound,
    }


def follow(law: Law, motion: Motion) -> pd.DataFrame:
    """Fly one manoeuvre and look at the constraints every `PIECE_S`.

    Returns
    -------
    pandas.DataFrame
        ``phase``, ``constraint``, ``place``, ``violation``: place is ``start`` for the first
        sample of a phase, over which its programs have no power, ``sample`` or ``between``.
    """
    record = settings([law])[0]
    room = program_room(max(law.horizons))
    work = workspace(max(law.horizons), PLANES, BOUNDS)
    plan, place = np.empty((max(law.horizons), 3)), np.zeros(2, np.int64)
    command, axis, faces = np.zeros(3), np.empty(3), np.empty((4, 3))
    time, rows = 0.0, []

    def note(phase: int, where: str) -> None:
        for name, value in violations(law, phase, motion.state(), time).items():
            rows.append((PHASES[phase], name, where, value))

    for phase in range(3):
        place[:] = 0
        note(phase, "start")
        while time + law.sample_times[phase] <= law.time_limit:
            state = motion.state()
            next_control(record, phase, state, time, room, work, plan, place, command)
            motion.control(command)
            pieces = max(1, round(law.sample_times[phase] / PIECE_S))
            for piece in range(pieces):
                motion.move(time, law.sample_times[phase] / pieces)
                time += law.sample_times[phase] / pieces
                note(phase, "between" if piece < pieces - 1 else "sample")
            if phase_ended(record, phase, motion.state(), time, axis, faces):
                break
        else:
            break
    return pd.DataFrame(rows, columns=["phase", "constraint", "place", "violation"])


def table(section: Config, laws: dict[str, Law], start: np.ndarray) -> pd.DataFrame:
    """Largest violation of each constraint by flight, motion and place.

    Parameters
    ----------
    section
        The configuration's ``rendezvous`` section, for truth and spacecraft.
    laws
        By name.
    start
        Relative state, (6,), m and m/s.
    """
    craft = section["spacecraft"]
    parts = []
    for name, law in laws.items():
        around = environment(section["truth"], law.mean_motion, craft["mass_kg"])
        target = target_state(section["truth"], law.mean_motion)
        thruster = (craft["mass_kg"], craft["thruster_N"])
        motions: dict[str, Motion] = {
            "linear": LinearMotion(law.mean_motion, start),
            "field, impulses": FieldMotion(around, target, start),
            "field, burns": FieldMotion(around, target, start, thruster),
        }
        for motion, moved in motions.items():
            found = follow(law, moved)
            largest = found.groupby(["phase", "constraint", "place"], sort=False)["violation"].max()
            part = largest.unstack().reindex(columns=["start", "sample", "between"]).reset_index()
            part.insert(0, "flight", name)
            part.insert(1, "motion", motion)
            parts.append(part)
    return pd.concat(parts, ignore_index=True)
