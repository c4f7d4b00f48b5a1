"""Tube-based robust MPC for the docking phase, which sections 3.7, 5.5 and 7 name and do not fly.

The rigid tube of Mayne, Seron and Rakovic (Automatica 41, 2005, 219-224) with an estimate in place
of the state. A nominal state z, which no disturbance reaches, is guided by the phase's program with
tightened constraints, and a linear feedback holds the true state x near it:

    z+ = A (z + [0; v]),   u = v + K (y - z),   y = x + measurement error.

The deviation e = x - z then obeys e+ = (A + B K) e + G d, where d has the measurement's and the
thrust's errors. While no component of d exceeds its bound, e stays in the least invariant set,
whose extent along a row h is the sum of |h (A + B K)^j G| over all steps j. Constraints on z are
tightened by the extents along their rows.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.guidance.law import DOCKING, Law, in_phase
from smallsat.studies.rendezvous.model.geometry import cone_faces
from smallsat.studies.rendezvous.model.prediction import terminal_weight, transition

# What is left of a deviation when the sum over steps ends.
FORGOTTEN = 1e-9


class Disturbances(NamedTuple):
    """What a step adds to the docking phase, along each axis: bounds, or standard deviations.

    ``position`` and ``velocity`` are of a measurement's error, m and m/s; ``thrust`` is of the
    velocity change that comes of a command, m/s.
    """

    position: float
    velocity: float
    thrust: float

    def times(self, factor: float) -> "Disturbances":
        """All of them times a factor."""
        return Disturbances(*(factor * one for one in self))


class Margins(NamedTuple):
    """By how much constraints are tightened: cone, m, speed, m/s, and control, m/s."""

    cone: float
    speed: float
    control: float

    def within(self, room: "Margins") -> "Margins":
        """Each of them, or what room there is for it."""
        return Margins(*map(min, self, room))

    def scale(self, room: "Margins") -> float:
        """How many times these margins there is room for, at one scale; infinity without any."""
        pairs = zip(self, room, strict=True)
        return min((there / one for one, there in pairs if one > 0.0), default=float("inf"))


class Deviation(NamedTuple):
    """How deviations move: (A + B K), (6, 6); G, (6, 9), scaled to the disturbances; and K, (3, 6).

    ``seen`` is what the feedback makes of a measurement's error, (3, 9).
    """

    transition: np.ndarray
    inputs: np.ndarray
    gain: np.ndarray
    seen: np.ndarray


def deviation(law: Law, disturbances: Disturbances) -> Deviation:
    """The docking phase's deviation under the feedback that its own weights are optimal for."""
    matrix = transition(rate_matrix(law.mean_motion), law.sample_times[DOCKING])
    control = matrix[:, 3:]
    cost, weight = law.state_weights[DOCKING], np.asarray(law.control_weights[DOCKING])
    riccati = terminal_weight(matrix, cost, weight)
    gain = -np.linalg.solve(
        np.diag(weight) + control.T @ riccati @ control, control.T @ riccati @ matrix
    )
    errors = np.diag([disturbances.position] * 3 + [disturbances.velocity] * 3)
    seen = np.hstack([gain @ errors, np.zeros((3, 3))])
    thrust = np.hstack([np.zeros((3, 6)), disturbances.thrust * np.eye(3)])
    return Deviation(matrix + control @ gain, control @ (seen + thrust), gain, seen)


def invariant_margins(law: Law, disturbances: Disturbances) -> Margins:
    """Margins of the least invariant set: no disturbance exceeds its bound, ever."""
    moved = deviation(law, disturbances)
    rows = _rows(law, moved.gain)
    extents, effect = np.zeros(len(rows)), moved.inputs
    first = np.abs(effect).max(axis=1)
    while (np.abs(effect).max(axis=1) > FORGOTTEN * first).any():
        extents += np.abs(rows @ effect).sum(axis=1)
        effect = moved.transition @ effect
    return _margins(extents, np.abs(moved.seen).sum(axis=1))


def stationary_margins(law: Law, disturbances: Disturbances) -> Margins:
    """Margins of one standard deviation of what disturbances settle to.

    ``disturbances`` are standard deviations, of errors that are independent from step to step. The
    thrust's is not: it lasts, and with it the deviation, up to that of the invariant set.
    """
    moved = deviation(law, disturbances)
    rows = _rows(law, moved.gain)
    covariance = solve_discrete_lyapunov(moved.transition, moved.inputs @ moved.inputs.T)
    extents = np.sqrt(np.einsum("ij,jk,ik->i", rows, covariance, rows))
    found = _margins(extents, np.zeros(3))
    control = np.hypot(extents[-3:], np.linalg.norm(moved.seen, axis=1))
    return found._replace(control=float(control.max()))


def _rows(law: Law, gain: np.ndarray) -> np.ndarray:
    """Rows of the cone (4), the speed (3) and the feedback (3), shape (10, 6)."""
    faces = np.empty((4, 3))
    cone_faces(np.array(law.axis), np.tan(law.cone_angles[DOCKING]), faces)
    return np.vstack([np.hstack([faces, np.zeros((4, 3))]), np.eye(6)[3:], gain])


def _margins(extents: np.ndarray, seen: np.ndarray) -> Margins:
    return Margins(
        float(extents[:4].max()), float(extents[4:7].max()), float((extents[7:] + seen).max())
    )


def tip_distance(law: Law, margins: Margins) -> float:
    """How far from the port the tightened cone begins, m."""
    return margins.cone / float(np.sin(law.cone_angles[DOCKING]))


def room(law: Law, share: float) -> Margins:
    """The most that constraints may be tightened by for the law to dock still.

    The cone begins at that share of the docking distance from the port, and the nominal speed and
    control are cut by that share at most.
    """
    return Margins(
        share * law.switch_distances[DOCKING] * float(np.sin(law.cone_angles[DOCKING])),
        share * law.speed_bound,
        share * law.control_bounds[DOCKING],
    )


def tube_law(law: Law, gain: np.ndarray, margins: Margins) -> Law:
    """The law with a tube around its docking phase; the control's bounds are the nominal ones."""
    bound = law.control_bounds[DOCKING] - margins.control
    return law.with_(
        feedback=gain,
        cone_margin=margins.cone,
        speed_margin=margins.speed,
        feedback_bound=margins.control,
        control_bounds=in_phase(law.control_bounds, DOCKING, bound),
    )


@compiled
def hold(law, estimate, nominal, command):
    """Add the feedback to the nominal command (3,), and move the nominal state (6,), in place.

    ``law`` is a `SETTINGS` record. The sum stays within the bounds that the thrusters have.
    """
    before = nominal.copy()
    for k in range(3):
        before[3 + k] += command[k]
    for k in range(3):
        feedback = 0.0
        for j in range(6):
            feedback += law.feedback[k, j] * (estimate[j] - nominal[j])
        bound = law.control_bounds[DOCKING] + law.feedback_bound
        command[k] = min(max(command[k] + feedback, -bound), bound)
    for j in range(6):
        total = 0.0
        for k in range(6):
            scale = law.scales[DOCKING, j] / law.scales[DOCKING, k]
            total += law.transitions[DOCKING, j, k] * scale * before[k]
        nominal[j] = total
