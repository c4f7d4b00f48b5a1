"""Bounds of the runs near the extremal, which follow from it and are wide of every solution.

They keep IPOPT's first steps from controls so wild that fixed steps cannot follow them, and none of
them is active at the end but those of coefficients that are asked for. Everything is in canonical
units.
"""

import numpy as np
import pandas as pd

from smallsat.studies.transfer.methods.direct import Case
from smallsat.studies.transfer.model.problem import STATES, TransferProblem

Bounds = tuple[np.ndarray, np.ndarray]
Interval = tuple[float, float]

# Final time of the document's transfer (Table 1), and bounds of a flight as long.
PUBLISHED_TIME = 3.24694
TIME_BOUNDS = (3.0, 4.0)
# Bounds of states and coefficients, where the extremal keeps this far inside.
STATE_BOUNDS = {
    "r": (0.0, 4.0),
    "theta": (0.0, 4.0),
    "v_r": (-1.0, 4.0),
    "v_theta": (0.0, 4.0),
    "m": (0.0, 4.0),
}
STATE_ROOM = 0.5
COEFFICIENT_BOUND = 12.0
COEFFICIENT_ROOM = 1.5
# Share of the time in which all mass is spent, and bound of coefficients, in wide bounds.
LONGEST_SHARE = 0.98
WIDE_COEFFICIENT = 50.0


def relative_length(final_time: float) -> float:
    """Length of a flight beside the document's, to three digits, so that its own is 1."""
    return float(f"{final_time / PUBLISHED_TIME:.3g}")


def time_bounds(final_time: float) -> tuple[float, float]:
    """Bounds of the final time near a known one."""
    scale = relative_length(final_time)
    return scale * TIME_BOUNDS[0], scale * TIME_BOUNDS[1]


def near_bounds(
    case: Case, guess: np.ndarray, extremal: pd.DataFrame, coefficients: Interval | None = None
) -> Bounds:
    """Bounds (size,) of a case near an extremal.

    Parameters
    ----------
    case, guess
        The case, and its guess from the extremal.
    extremal
        Table of `smallsat.studies.transfer.methods.indirect.propagate_extremal`.
    coefficients
        Bounds of the coefficients that the case has; None for bounds that stay inactive.
    """
    lower, upper = zip(*(_state_bounds(extremal[name], name) for name in STATES), strict=True)
    _, guessed, final_time = case.split(guess)
    largest = max(COEFFICIENT_BOUND, COEFFICIENT_ROOM * float(np.max(np.abs(guessed))))
    least, most = coefficients or (-largest, largest)
    earliest, latest = time_bounds(float(final_time))
    return _vector(case, lower, least, earliest), _vector(case, upper, most, latest)


def wide_bounds(
    case: Case, problem: TransferProblem, coefficients: Interval | None = None
) -> Bounds:
    """Bounds (size,) of a case that leave room for any flight that has mass left.

    ``coefficients`` are as in `near_bounds`.
    """
    far = [4.0 * max(1.0, problem.final_radius), np.inf, 4.0, 4.0, 1.0]
    longest = LONGEST_SHARE * problem.longest_time
    least, most = coefficients or (-WIDE_COEFFICIENT, WIDE_COEFFICIENT)
    return (
        _vector(case, [0.0, -np.inf, -4.0, 0.0, 0.0], least, 0.0),
        _vector(case, far, most, longest),
    )


def _state_bounds(path: pd.Series, name: str) -> tuple[float, float]:
    low, high = STATE_BOUNDS[name]
    # Nothing but the radial velocity may be negative.
    below = min(low, path.min() - STATE_ROOM) if low < 0.0 else low
    return float(below), float(max(high, path.max() + STATE_ROOM))


def _vector(case: Case, states, coefficient: float, final_time: float) -> np.ndarray:
    interior = np.tile(np.asarray(states, dtype=float), case.intervals - 1)
    coefficients = np.full((case.degree + 1) * case.intervals, coefficient)
    return np.concatenate([interior, coefficients, [final_time]])
