"""Indirect shooting: the two-point boundary value problem of the costate, single and multiple."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from smallsat.optimal_control.nonlinear_program import Numbers
from smallsat.optimal_control.runge_kutta import step_function
from smallsat.optimal_control.shooting import (
    Interval,
    ShootingArc,
    end_conditions,
    shooting_numbers,
)
from smallsat.studies.transfer.configuration import Guess
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import error_magnitude
from smallsat.studies.transfer.model.units import Units

# From the document's guess to its solution it takes 27 to 66; a start that needs many more leads
# nowhere.
MOST_EVALUATIONS = 300

# Lengths of the integration steps, as fractions of the flight, interval by interval.
StepLengths = Sequence[Sequence[float]]


@dataclass(frozen=True)
class Extremal:
    """A solution of the necessary conditions.

    Attributes
    ----------
    nodes
        State and costate (K, 10) at the start of each interval.
    final_time
        Time of flight.
    iterations
        Residual evaluations of the root finder that were accepted or rejected steps.
    error
        Largest residual: continuity, boundary and transversality conditions.
    seconds
        Wall time of the solve alone.
    """

    nodes: np.ndarray
    final_time: float
    iterations: int
    error: float
    seconds: float


class ConvergenceError(Exception):
    """Shooting that did not converge; the message says how it ended.

    Attributes
    ----------
    residual
        Largest residual at the end, to two digits; not a number where there was no flight.
    """

    def __init__(self, message: str, residual: float = np.nan):
        super().__init__(message)
        self.residual = residual


def published_start(intervals: int, guess: Guess, units: Units) -> np.ndarray:
    """The document's guess of the unknowns (10 K - 4,) in canonical units (Listings 1, 4).

    Parameters
    ----------
    intervals
        K; 1 for single shooting.
    guess
        Of the configuration.
    units
        Canonical units of the configuration's problem.
    """
    costate = np.array([guess.initial_costate[name] for name in COSTATES]) / units.costate
    interior = np.concatenate([guess.interior_state / units.state, costate])
    time_guess = guess.indirect_final_time / units.time
    return np.concatenate([costate, *[interior] * (intervals - 1), [time_guess]])


def equal_steps(intervals: int, steps: int) -> StepLengths:
    """Equal steps, as many over the whole flight."""
    share = max(1, steps // intervals)
    return [[((k + 1) / intervals - k / intervals) / share] * share for k in range(intervals)]


def adapted_steps(problem: TransferProblem, extremal: Extremal) -> StepLengths:
    """The steps that an adaptive method of the same order takes along an extremal.

    Where the primer vector passes close to zero the thrust turns fast, and equal steps would have
    to be short everywhere.
    """
    count = len(extremal.nodes)
    times = np.linspace(0.0, extremal.final_time, count + 1)
    flights = [
        solve_ivp(
            lambda _, y: problem.extremal_rate(y[:5], y[5:]),
            (times[k], times[k + 1]),
            extremal.nodes[k],
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
        )
        for k in range(count)
    ]
    return [list(np.diff(flight.t) / extremal.final_time) for flight in flights]


def solve_extremal(
    problem: TransferProblem, intervals: int, start: np.ndarray, steps: StepLengths
) -> Extremal:
    """Solve the necessary conditions by (multiple) shooting.

    Unknowns are the initial costate, state and costate at interior nodes, and the final time
    (sections 3.1, 3.2). A trust-region least-squares method with the exact Jacobian is used: for
    the document's problem it converges from the document's guess for every number of intervals.

    Parameters
    ----------
    problem
        The transfer, in canonical units.
    intervals
        K; 1 for single shooting.
    start
        Unknowns (10 K - 4,) to start from.
    steps
        Lengths of the integration steps in each interval, as fractions of the flight.

    Raises
    ------
    ConvergenceError
        If the residual does not vanish, the final time is not positive, or no mass is left then.
    """
    residual, jacobian = _shooting_functions(problem, intervals, steps)
    began = time.perf_counter()
    try:
        result = least_squares(
            residual,
            start,
            jac=jacobian,
            method="trf",
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
            max_nfev=MOST_EVALUATIONS,
        )
    except (ValueError, np.linalg.LinAlgError) as failure:
        # A start that cannot be flown has residuals that are no numbers.
        raise ConvergenceError(str(failure).strip().rstrip(".").lower()) from None
    seconds = time.perf_counter() - began
    error = float(np.max(np.abs(result.fun)))
    final_time = float(result.x[-1])
    if error > 1e-9 or not 0.0 < final_time < problem.longest_time:
        ended = f"residual {error:.1e} at t_f = {final_time:.4f}"
        raise ConvergenceError(ended, error_magnitude([error]))
    nodes = np.concatenate([problem.initial_state, result.x[:-1]]).reshape(intervals, 10)
    return Extremal(nodes, final_time, int(result.nfev), error, seconds)


def propagate_extremal(
    problem: TransferProblem, extremal: Extremal, samples: int
) -> tuple[np.ndarray, pd.DataFrame]:
    """Integrate an extremal from its initial costate with LSODA, resetting nothing at the nodes.

    Parameters
    ----------
    problem, extremal
        What is flown.
    samples
        Rows of the table in each interval.

    Returns
    -------
    final
        State and costate (10,) at the end.
    table
        Columns segment, tau, t, the five states, beta (rad, 0 to 2 pi), the five costates, and
        the Hamiltonian.
    """
    count = len(extremal.nodes)
    times = np.linspace(0.0, extremal.final_time, count + 1)
    y = extremal.nodes[0]
    frames = []
    for segment in range(count):
        grid = np.linspace(times[segment], times[segment + 1], samples)
        solution = solve_ivp(
            lambda _, y: problem.extremal_rate(y[:5], y[5:]),
            (grid[0], grid[-1]),
            y,
            method="LSODA",
            t_eval=grid,
            rtol=1e-12,
            atol=1e-13,
        )
        y = solution.y[:, -1]
        table = pd.DataFrame(solution.y.T, columns=[*STATES, *COSTATES])
        table.insert(0, "t", grid)
        table.insert(0, "tau", 2 * grid / extremal.final_time - 1)
        table.insert(0, "segment", segment)
        table.insert(8, "beta", primer_angle(solution.y[5:]))
        table["hamiltonian"] = problem.hamiltonian(solution.y[:5], solution.y[5:])
        frames.append(table)
    return y, pd.concat(frames, ignore_index=True)


def condition_error(problem: TransferProblem, final: np.ndarray) -> float:
    """Largest error of the boundary and transversality conditions (equations 35-37) at the end."""
    state, costate = final[:5], final[5:]
    errors = [
        *problem.terminal_error(state),
        costate[1],
        costate[4] - 1.0,
        problem.hamiltonian(state, costate),
    ]
    return error_magnitude(errors)


def primer_angle(costate: np.ndarray) -> np.ndarray:
    """Thrust angle (rad, 0 to 2 pi) along the primer vector (equation 34)."""
    return np.mod(np.arctan2(costate[2], costate[3]), 2 * np.pi)


def _shooting_functions(problem: TransferProblem, intervals: int, steps: StepLengths) -> Numbers:
    """Residual (10 K - 4,) of unknowns (10 K - 4,), and its Jacobian."""
    known = len(problem.initial_state)
    # Node k and the final time, by what is known at the start and the unknowns.
    everything = np.eye(10 * intervals + 1)
    pieces = []
    for k, lengths in enumerate(steps):
        taken = everything[[*range(10 * k, 10 * k + 10), -1]]
        pieces.append(
            Interval(
                matrix=taken[:, known:],
                offset=taken[:, :known] @ problem.initial_state,
                starts=np.zeros(len(lengths)),
                lengths=np.array(lengths),
            )
        )
    return shooting_numbers(_arc(problem), pieces, _end(problem))


@lru_cache(maxsize=8)
def _arc(problem: TransferProblem) -> ShootingArc:
    """Flight of an extremal (10,); the parameter is its final time, steps are fractions of it."""

    def rate(_: Any, y: Any, p: Any) -> list[Any]:
        return [p * value for value in problem.extremal_rate(y[:5], y[5:])]

    return ShootingArc(step_function(rate, 10, 1))


@lru_cache(maxsize=8)
def _end(problem: TransferProblem) -> ca.Function:
    """What has to vanish at the end (equations 35-37), of state and costate (10,)."""

    def conditions(end: Any) -> list[Any]:
        state, costate = end[:5], end[5:]
        free = [costate[1], costate[4] - 1.0, problem.hamiltonian(state, costate)]
        return [*problem.terminal_error(state), *free]

    return end_conditions(10, conditions)
