"""Relative motion near an elliptic orbit, linear and varying in time, in closed form.

Yamanaka and Ankersen's solution (J. Guidance, Control, and Dynamics 25, 2002, 60-66) of Tschauner
and Hempel's equations. With the true anomaly f in place of time, rho = 1 + e cos f, and the
position times rho, these are, in the frame of `clohessy_wiltshire`,

    x'' = 3 x / rho + 2 y',   y'' = -2 x',   z'' = -z.

The state is position and velocity in the Hill frame, x radial, y along the motion in the plane, z
across it. The frame turns with the orbit, at a rate that varies. Any consistent units.
"""

import numpy as np

from smallsat.dynamics.compiled import compiled

# Newton's steps for Kepler's equation from Danby's start: six reach rounding for e = 0.99.
KEPLER_STEPS = 10
# Places of (x, y, vx, vy) in a state.
IN_PLANE = (0, 1, 3, 4)


@compiled
def true_anomaly_after(true_anomaly: float, e: float, mean_angle: float) -> float:
    """True anomaly, rad, when the mean anomaly has grown by an angle, rad; it grows with it."""
    half = np.sqrt(1.0 - e * e)
    c, s = np.cos(true_anomaly), np.sin(true_anomaly)
    # The eccentric anomaly differs from the true one by less than half a turn.
    share = e / (1.0 + half)
    first = true_anomaly - 2.0 * np.arctan2(share * s, 1.0 + share * c)
    mean = first - e * np.sin(first) + mean_angle
    found = mean + 0.85 * e * np.sign(np.sin(mean))
    for _ in range(KEPLER_STEPS):
        found -= (found - e * np.sin(found) - mean) / (1.0 - e * np.cos(found))
    return found + 2.0 * np.arctan2(share * np.sin(found), 1.0 - share * np.cos(found))


def frame_rate(n: float, e: float, true_anomaly: float) -> float:
    """Rate at which the Hill frame turns at a true anomaly, rad; ``n`` is the mean motion."""
    return float(n * (1.0 + e * np.cos(true_anomaly)) ** 2 / (1.0 - e * e) ** 1.5)


@compiled
def transition(n: float, e: float, true_anomaly: float, t: float) -> np.ndarray:
    """State transition (6, 6) over a duration from a true anomaly, rad; for e = 0 ``exp(A t)``.

    Parameters
    ----------
    n, e
        Mean motion, and eccentricity, from 0 to below 1.
    true_anomaly, t
        Where the target is at the start, rad, and for how long.
    """
    later = true_anomaly_after(true_anomaly, e, n * t)
    rate = n / (1.0 - e * e) ** 1.5
    in_plane = _fundamental(e, later, rate * t) @ np.linalg.inv(_fundamental(e, true_anomaly, 0.0))
    c, s = np.cos(later - true_anomaly), np.sin(later - true_anomaly)
    scaled = np.zeros((6, 6))
    for j in range(4):
        for k in range(4):
            scaled[IN_PLANE[j], IN_PLANE[k]] = in_plane[j, k]
    scaled[2, 2], scaled[2, 5], scaled[5, 2], scaled[5, 5] = c, s, -s, c
    return np.linalg.inv(_scaling(rate, e, later)) @ scaled @ _scaling(rate, e, true_anomaly)


@compiled
def _scaling(rate: float, e: float, f: float) -> np.ndarray:
    """Matrix (6, 6) from a state to the position times rho and its derivative by f."""
    rho = 1.0 + e * np.cos(f)
    matrix = np.zeros((6, 6))
    for k in range(3):
        matrix[k, k], matrix[3 + k, 3 + k] = rho, 1.0 / (rate * rho)
        matrix[3 + k, k] = -e * np.sin(f)
    return matrix


@compiled
def _fundamental(e: float, f: float, integral: float) -> np.ndarray:
    """Independent solutions, a column each, of (x, y, x', y'), shape (4, 4).

    ``integral`` is that of 1 / rho^2 over f since the start: the duration times n / (1 - e^2)^1.5.
    """
    rho = 1.0 + e * np.cos(f)
    s, c = rho * np.sin(f), rho * np.cos(f)
    ds, dc = np.cos(f) + e * np.cos(2.0 * f), -np.sin(f) - e * np.sin(2.0 * f)
    return np.array(
        [
            [0.0, -s, -c, 3.0 * e * s * integral - 2.0],
            [1.0, -c * (1.0 + 1.0 / rho), s * (1.0 + 1.0 / rho), 3.0 * rho**2 * integral],
            [0.0, -ds, -dc, 3.0 * e * (ds * integral + s / rho**2)],
            [0.0, 2.0 * s, 2.0 * c - e, 3.0 - 6.0 * e * s * integral],
        ]
    )
