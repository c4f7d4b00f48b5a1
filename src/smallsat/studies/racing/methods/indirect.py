"""A segment by Pontryagin's principle: a square system for the costates and the duration.

Seven unknowns, seven conditions. At a ring: the centre (3), the two velocity components across
the normal, the primer along the normal, which vanishes as the speed is free, and the Hamiltonian.
At the finish: position and velocity (6) and the Hamiltonian. Units are scaled as in the program.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.racing.methods.course_program import length_unit
from smallsat.studies.racing.model.shooting import DIRECTED, costate_matrix, end_of_segment

TOLERANCE = 1e-9
UNIT_LIMITS = np.ones(3)


@dataclass(frozen=True)
class Extremal:
    """A solution: initial costates (6,), duration s, end state (6,), SI; and how it was found."""

    costate: np.ndarray
    duration: float
    end: np.ndarray
    converged: bool
    error: float


@dataclass(frozen=True)
class Goal:
    """Where a segment ends: a ring with its normal, or a state to reach (``velocity`` given)."""

    position: np.ndarray
    normal: np.ndarray
    velocity: np.ndarray | None = None


def solve(
    state: np.ndarray,
    goal: Goal,
    thrust: float,
    mean_motion: float,
    costate: np.ndarray,
    duration: float,
    panels: int,
) -> Extremal:
    """Solve a segment of a CubeSat that may thrust in any direction.

    Parameters
    ----------
    state
        At the start (6,), m and m/s.
    goal
        Its end.
    thrust, mean_motion
        m/s^2, rad/s.
    costate, duration
        Guess: the rate of the least time with the state, and the duration, s.
    panels
        Panels of the quadrature.
    """
    length = length_unit(np.array([state[:3], goal.position]))
    time = float(np.sqrt(length / thrust))
    units = np.repeat([length, length / time], 3)
    n = mean_motion * time
    a, m = rate_matrix(n), costate_matrix(n)
    start, target = state / units, goal.position / length
    level = np.array([-goal.normal[1], goal.normal[0], 0.0])
    if np.linalg.norm(level) < 1e-6:
        level = np.array([1.0, 0.0, 0.0])
    across = np.array([level, np.cross(goal.normal, level)])
    across /= np.linalg.norm(across, axis=1)[:, None]

    def end(z):
        return end_of_segment(start, z[:6].copy(), z[6], a, m, DIRECTED, UNIT_LIMITS, 0.0, panels)

    def conditions(z):
        x, p = end(z)
        hamiltonian = p @ (a @ x) - np.linalg.norm(p[3:])
        if goal.velocity is None:
            rest = np.r_[across @ x[3:], p[3:] @ goal.normal]
        else:
            rest = x[3:] - goal.velocity / units[3:]
        return np.r_[x[:3] - target, rest, hamiltonian + 1.0]

    guess = np.r_[costate * units / time, duration / time]
    found = root(conditions, guess, method="hybr", options={"xtol": 1e-13})
    error = float(np.abs(found.fun).max())
    x, _ = end(found.x)
    forward = goal.velocity is not None or float(x[3:] @ goal.normal) > 0.0
    return Extremal(
        costate=found.x[:6] * time / units,
        duration=float(found.x[6] * time),
        end=x * units,
        converged=bool(error < TOLERANCE and found.x[6] > 0.0 and forward),
        error=error,
    )
