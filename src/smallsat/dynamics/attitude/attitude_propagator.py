"""Closed-form state transition of the quaternion, for rates at given times (slew, Eq. 18-26)."""

from math import cos, sin, sqrt

import numpy as np

from smallsat.dynamics.compiled import compiled

# Below this turn in a step the series of sin(x)/x is exact to rounding.
SMALL = 1e-6


@compiled
def transition(q, turn):
    """Quaternion after a turn (U, V, W), rad, the integral of the body rate (Eq. 21 to 26).

    No turn is no special case: sin(x)/x is continued by its series.
    """
    u, v, w = turn[0], turn[1], turn[2]
    norm = sqrt(u * u + v * v + w * w)
    c = cos(0.5 * norm)
    s = 0.5 - norm * norm / 48.0 if norm < SMALL else sin(0.5 * norm) / norm
    return (
        c * q[0] + s * (w * q[1] - v * q[2] + u * q[3]),
        c * q[1] + s * (-w * q[0] + u * q[2] + v * q[3]),
        c * q[2] + s * (v * q[0] - u * q[1] + w * q[3]),
        c * q[3] + s * (-u * q[0] - v * q[1] - w * q[2]),
    )


@compiled
def propagate(quaternion, rates, step):
    """Quaternions (n, 4) at equal times from body rates (n, 3), rad/s, and the first quaternion.

    The turn of a step is its mean rate by the trapezoidal rule (Eq. 24). The local error is of
    third order in the step, by the rule and because rates at different times do not commute; the
    error over a given time is of second order.
    """
    n = rates.shape[0]
    found = np.empty((n, 4))
    q = (quaternion[0], quaternion[1], quaternion[2], quaternion[3])
    for k in range(n):
        if k:
            half = 0.5 * step
            turn = (
                half * (rates[k - 1, 0] + rates[k, 0]),
                half * (rates[k - 1, 1] + rates[k, 1]),
                half * (rates[k - 1, 2] + rates[k, 2]),
            )
            q = transition(q, turn)
        for i in range(4):
            found[k, i] = q[i]
    return found
