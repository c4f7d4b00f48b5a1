"""The guidance law's prediction model, discretised for impulses, and its terminal weight.

States are relative position, m, and velocity, m/s, in the target's Hill frame, which rotates.
"""

import numpy as np
import scipy.linalg


def transition(matrix: np.ndarray, duration: float) -> np.ndarray:
    """State transition (6, 6) over a duration, s (3.1); impulses change the velocity before it."""
    return scipy.linalg.expm(matrix * duration)


def terminal_weight(
    transition: np.ndarray, state_weight: np.ndarray, control_weight: np.ndarray
) -> np.ndarray:
    """Solution of the discrete algebraic Riccati equation, (6, 6), for x'Qx + u'Ru.

    The control acts as an impulse before the transition: B = A [0; I].
    """
    return scipy.linalg.solve_discrete_are(
        transition, transition[:, 3:], np.diag(state_weight), np.diag(control_weight)
    )
