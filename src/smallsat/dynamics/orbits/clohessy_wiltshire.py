"""Relative motion near a circular orbit (Clohessy-Wiltshire), in closed form.

The state is position and velocity in the Hill frame: x radial, y along the track, z across it. Any
consistent units; ``n`` is the mean motion. ``functions`` is the module whose sine and cosine are
used: NumPy for numbers, CasADi for symbols.
"""

from typing import Any

import numpy as np


def rate_matrix(n: float) -> np.ndarray:
    """``dx/dt = A x``: the matrix A, shape (6, 6)."""
    a = np.zeros((6, 6))
    a[:3, 3:] = np.eye(3)
    a[3, 0], a[5, 2] = 3.0 * n**2, -(n**2)
    a[3, 4], a[4, 3] = 2.0 * n, -2.0 * n
    return a


def transition_rows(n: Any, t: Any, functions: Any = np) -> list[list[Any]]:
    """``exp(A t)`` as rows of entries, 6 by 6."""
    s, c = functions.sin(n * t), functions.cos(n * t)
    # 1 - cos without cancellation: steps are short against the orbit.
    d = 2.0 * functions.sin(0.5 * n * t) ** 2
    return [
        [1.0 + 3.0 * d, 0.0, 0.0, s / n, 2.0 * d / n, 0.0],
        [6.0 * (s - n * t), 1.0, 0.0, -2.0 * d / n, 4.0 * s / n - 3.0 * t, 0.0],
        [0.0, 0.0, c, 0.0, 0.0, s / n],
        [3.0 * n * s, 0.0, 0.0, c, 2.0 * s, 0.0],
        [-6.0 * n * d, 0.0, 0.0, -2.0 * s, 1.0 - 4.0 * d, 0.0],
        [0.0, 0.0, -n * s, 0.0, 0.0, c],
    ]


def held_input_rows(n: Any, t: Any, functions: Any = np) -> list[list[Any]]:
    """What a unit acceleration held for ``t`` does to the state: rows of entries, 6 by 3."""
    s = functions.sin(n * t)
    d = 2.0 * functions.sin(0.5 * n * t) ** 2
    lag = t - s / n
    return [
        [d / n**2, 2.0 * lag / n, 0.0],
        [-2.0 * lag / n, 4.0 * d / n**2 - 1.5 * t**2, 0.0],
        [0.0, 0.0, d / n**2],
        [s / n, 2.0 * d / n, 0.0],
        [-2.0 * d / n, 4.0 * s / n - 3.0 * t, 0.0],
        [0.0, 0.0, s / n],
    ]


def transition(n: float, t: float) -> np.ndarray:
    """``exp(A t)``, shape (6, 6)."""
    return np.array(transition_rows(n, t))


def costate_transition(n: float, t: float) -> np.ndarray:
    """Costates at ``t`` from those at 0, shape (6, 6): ``exp(-A^T t)``, without running costs."""
    return np.array(transition_rows(n, -t)).T
