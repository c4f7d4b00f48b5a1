"""A segment flown from initial costates, compiled: the listing's dynamics (C.F), faithful or mended.

The costates obey a linear law of their own, the control follows from them, and the state is linear in
the control. So a segment is a sum over the Gauss points of equal panels; nothing is integrated step
by step. SI units.
"""

from math import sqrt

import numpy as np

from smallsat.dynamics.clohessy_wiltshire import rate_matrix
from smallsat.dynamics.compiled import compiled

GAUSS_POINTS = 4
NODES, WEIGHTS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
# Terms of the exponential series over a panel: a panel is short against the orbit.
TERMS = 14
# Laws of thrust: any direction at full thrust; along the primer with the norm of the active axes
# (Listings C.C and C.F); each axis by itself (the minimiser over a box).
DIRECTED, NORM_OF_AXES, AXIS_BY_AXIS = 0, 1, 2


def costate_matrix(mean_motion: float, transposed: bool = True) -> np.ndarray:
    """The matrix of ``dp/dt = M p``; untransposed in the velocity block as in Listing C.F."""
    m = -rate_matrix(mean_motion).T
    if not transposed:
        m[3:, 3:] = m[3:, 3:].T
    return m


@compiled
def exponential(a, t):
    """``exp(a t)`` of a square matrix by its series, for short t."""
    size = a.shape[0]
    total, term = np.eye(size), np.eye(size)
    for k in range(1, TERMS + 1):
        term = term @ a * (t / k)
        total += term
    return total


@compiled
def thrust_of(primer, law, limits, deadzone):
    """Acceleration (3,) that a law makes of a primer vector (3,).

    ``limits`` are the accelerations of the axes; a directed thruster has the first one in every
    direction.
    """
    u = np.zeros(3)
    if law == AXIS_BY_AXIS:
        for i in range(3):
            u[i] = -limits[i] * np.sign(primer[i])
        return u
    size = sqrt(primer[0] ** 2 + primer[1] ** 2 + primer[2] ** 2)
    if size == 0.0:
        return u
    thrust = limits[0]
    if law == NORM_OF_AXES:
        total = 0.0
        for i in range(3):
            if abs(primer[i]) > deadzone:
                total += limits[i] ** 2
        thrust = sqrt(total)
    return primer * (-thrust / size)


@compiled
def end_of_segment(state, costate, duration, a, m, law, limits, deadzone, panels):
    """State and costate (6,), (6,) at the end of a segment.

    Parameters
    ----------
    state, costate : ndarray, shape (6,)
        At the start.
    duration : float
        s.
    a, m : ndarray, shape (6, 6)
        Rate matrices of the state and of the costate.
    law, limits, deadzone
        See `thrust_of`.
    panels : int
        Equal panels of Gauss points.
    """
    h = duration / panels
    step, costep = exponential(a, h), exponential(m, h)
    reach = np.empty((GAUSS_POINTS, 6, 3))
    primers = np.empty((GAUSS_POINTS, 3, 6))
    for j in range(GAUSS_POINTS):
        s = 0.5 * h * (1.0 + NODES[j])
        reach[j] = exponential(a, h - s)[:, 3:] * (0.5 * h * WEIGHTS[j])
        primers[j] = exponential(m, s)[3:]
    x, p = state.copy(), costate.copy()
    for _ in range(panels):
        after = step @ x
        for j in range(GAUSS_POINTS):
            after += reach[j] @ thrust_of(primers[j] @ p, law, limits, deadzone)
        x = after
        p = costep @ p
    return x, p
