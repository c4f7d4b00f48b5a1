"""A segment flown from initial costates, compiled: the listing's dynamics (C.F), as is or mended.

The costates obey a linear law of their own, the control follows from them, and the state is linear
in the control. So a segment is a sum over the Gauss points of equal panels; nothing is integrated
step by step. SI units.
"""

import numpy as np

from smallsat.dynamics.compiled import compiled, compiled_arithmetic
from smallsat.dynamics.lanes import less, root, size, where
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.racing.model.cubesat import CubeSat

GAUSS_POINTS = 4
NODES, WEIGHTS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
# Terms of the exponential series over a panel: a panel is short against the orbit.
TERMS = 14
# Laws of thrust: any direction at full thrust; along the primer with the norm of the active axes
# (Listings C.C and C.F); each axis by itself (the minimiser over a box).
DIRECTED, NORM_OF_AXES, AXIS_BY_AXIS = 0, 1, 2


def law_of(cubesat: CubeSat) -> tuple[int, np.ndarray]:
    """The listing's law of thrust and its limits (3,)."""
    if cubesat.axis_thrust:
        return NORM_OF_AXES, np.array(cubesat.axis_thrust)
    return DIRECTED, np.full(3, cubesat.thrust)


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


@compiled_arithmetic
def thrust_components(primer, law, limits, deadzone):
    """Acceleration that a law makes of a primer vector (3,), as three numbers or lanes.

    ``limits`` are the accelerations of the axes; a directed thruster has the first one in every
    direction.
    """
    if law == AXIS_BY_AXIS:
        return (
            -limits[0] * _sign(primer[0]),
            -limits[1] * _sign(primer[1]),
            -limits[2] * _sign(primer[2]),
        )
    length = root(primer[0] * primer[0] + primer[1] * primer[1] + primer[2] * primer[2])
    thrust = limits[0]
    if law == NORM_OF_AXES:
        total = 0.0
        for i in range(3):
            total += where(less(deadzone, size(primer[i])), limits[i] * limits[i], 0.0)
        thrust = root(total)
    share = -thrust / length
    return (
        where(length, share * primer[0], 0.0),
        where(length, share * primer[1], 0.0),
        where(length, share * primer[2], 0.0),
    )


@compiled_arithmetic
def _sign(one):
    """Return the sign of a number or of lanes; what is zero or no number stays so."""
    return where(less(one, 0.0), -1.0, where(less(0.0, one), 1.0, one))


@compiled
def thrust_of(primer, law, limits, deadzone):
    """The same as a vector (3,)."""
    return np.array(thrust_components(primer, law, limits, deadzone))


@compiled
def thrust_along(costate, step, points, law, limits, deadzone):
    """Thrust (points, 3) of a costate (6,) and of what a matrix ``step`` (6, 6) makes of it."""
    thrust, p = np.empty((points, 3)), costate.copy()
    for k in range(points):
        thrust[k] = thrust_components(p[3:], law, limits, deadzone)
        p = step @ p
    return thrust


@compiled_arithmetic
def rate(y, n, transposed, law, limits, deadzone, out):
    """Rate (12,) of state and costate by Listing C.F, or with the costates' matrix transposed.

    Of numbers or of lanes, written to ``out``; `thrust_components` has the other arguments.
    """
    ux, uy, uz = thrust_components(y[9:], law, limits, deadzone)
    out[0], out[1], out[2] = y[3], y[4], y[5]
    out[3] = 2.0 * n * y[4] + 3.0 * n * n * y[0] + ux
    out[4] = -2.0 * n * y[3] + uy
    out[5] = -n * n * y[2] + uz
    out[6], out[7], out[8] = -3.0 * n * n * y[9], 0.0, n * n * y[11]
    turn = 2.0 * n if transposed else -2.0 * n
    out[9] = -y[6] + turn * y[10]
    out[10] = -y[7] - turn * y[9]
    out[11] = -y[8]


@compiled
def hamiltonian(y, n, law, limits, deadzone):
    """The Hamiltonian of state and costate (12,) under a law of thrust (Eq. 14, Listing C.E)."""
    moved = np.empty(12)
    rate(y, n, True, law, limits, deadzone, moved)
    return y[6:9] @ moved[:3] + y[9:] @ moved[3:6]


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
    # Plain loops: products of such small matrices cost more to call than to do.
    x, p = state.copy(), costate.copy()
    after, moved, primer = np.empty(6), np.empty(6), np.empty(3)
    for _ in range(panels):
        for i in range(6):
            after[i] = moved[i] = 0.0
            for k in range(6):
                after[i] += step[i, k] * x[k]
                moved[i] += costep[i, k] * p[k]
        for j in range(GAUSS_POINTS):
            for i in range(3):
                primer[i] = 0.0
                for k in range(6):
                    primer[i] += primers[j, i, k] * p[k]
            ux, uy, uz = thrust_components(primer, law, limits, deadzone)
            for i in range(6):
                after[i] += reach[j, i, 0] * ux + reach[j, i, 1] * uy + reach[j, i, 2] * uz
        x[:] = after
        p[:] = moved
    return x, p
