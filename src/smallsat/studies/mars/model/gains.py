"""Gains of the PD law u = -K sigma_B/R - P omega_B/R from the requirements (mars, Section X.B)."""

from typing import NamedTuple

import numpy as np


class Gains(NamedTuple):
    """Attitude gain ``k``, N m, and rate gain ``p``, N m s."""

    k: float
    p: float


def gains(inertia: np.ndarray, largest_decay_time: float, largest_damping_ratio: float) -> Gains:
    """Gains that meet both requirements with equality on the axis that decides each.

    The decay time 2 I / P is largest for the largest moment of inertia, the damping ratio
    P / sqrt(K I) for the smallest (mars, Eqs. 35 and 36).

    Parameters
    ----------
    inertia
        Principal moments, shape (3,), kg m^2.
    largest_decay_time
        Seconds.
    largest_damping_ratio
        1 is critical damping.
    """
    p = 2.0 * np.max(inertia) / largest_decay_time
    return Gains(k=p**2 / (largest_damping_ratio**2 * np.min(inertia)), p=p)


def decay_times(inertia: np.ndarray, chosen: Gains) -> np.ndarray:
    """Decay time of the linearised closed loop about each axis, s, shape (3,) (mars, Eq. 35)."""
    return 2.0 * inertia / chosen.p


def damping_ratios(inertia: np.ndarray, chosen: Gains) -> np.ndarray:
    """Damping ratio of the linearised closed loop about each axis, shape (3,) (mars, Eq. 36)."""
    return chosen.p / np.sqrt(chosen.k * inertia)
