"""A solved transfer: its control, its path, and a check by an integrator of another kind."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp

from smallsat.studies.transfer.model.problem import STATES, TransferProblem

COLUMNS = ("segment", "tau", "t", *STATES, "beta")

# A control on one interval: thrust angle in rad at times (n,) since the start.
Control = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class ControlHistory:
    """A control in consecutive intervals, flown from the initial orbit.

    Attributes
    ----------
    times
        Interval ends (K + 1,), in canonical time, the first 0.
    controls
        One control an interval.
    """

    times: np.ndarray
    controls: Sequence[Control]

    @property
    def final_time(self) -> float:
        """Time of flight."""
        return float(self.times[-1])


def propagate(
    problem: TransferProblem, history: ControlHistory, samples: int = 0
) -> tuple[np.ndarray, pd.DataFrame]:
    """Fly a control history from the initial orbit with LSODA (variable-order Adams and BDF).

    Nothing is reset at the interval ends, so the errors of all intervals add up.

    Parameters
    ----------
    problem, history
        What is flown.
    samples
        Rows of the table in each interval; 0 for none.

    Returns
    -------
    state
        Final state (5,); not a number where the flight takes no time, uses up all mass or breaks
        down.
    table
        Columns segment, tau (-1 to 1), t, the five states, beta (rad); without rows if there is no
        flight.
    """
    no_flight = np.full(5, np.nan), pd.DataFrame(columns=COLUMNS, dtype=float)
    if not 0.0 < history.final_time < problem.longest_time:
        return no_flight
    state = problem.initial_state
    frames = []
    for segment, control in enumerate(history.controls):
        start, end = history.times[segment], history.times[segment + 1]

        def rate(t: float, x: np.ndarray, control: Control = control) -> list[float]:
            beta = control(np.asarray(t))
            return problem.state_rate(x, np.sin(beta), np.cos(beta))

        grid = np.linspace(start, end, samples) if samples else None
        solution = solve_ivp(
            rate, (start, end), state, method="LSODA", t_eval=grid, rtol=1e-12, atol=1e-13
        )
        state = solution.y[:, -1]
        if not (solution.success and np.isfinite(state).all()):
            return no_flight
        if samples and grid is not None:
            table = pd.DataFrame(solution.y.T, columns=list(STATES))
            table.insert(0, "t", grid)
            table.insert(0, "tau", 2 * grid / history.final_time - 1)
            table.insert(0, "segment", segment)
            table["beta"] = control(grid)
            frames.append(table)
    return state, pd.concat(frames, ignore_index=True) if frames else no_flight[1]


def boundary_error(problem: TransferProblem, state: np.ndarray) -> float:
    """Largest error of the conditions on r, v_r and v_theta at the end of a flight."""
    return error_magnitude(problem.terminal_error(state))


def error_magnitude(errors: Sequence[float] | np.ndarray) -> float:
    """Largest of some errors, to two digits: more would be noise of the last bits.

    Infinite where one is not a number: without a flight nothing is met.
    """
    largest = float(f"{np.max(np.abs(errors)):.1e}")
    return largest if np.isfinite(largest) else float("inf")
