"""The extremal of each number of intervals: from the document's guess, else by continuation."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.transfer.configuration import Guess
from smallsat.studies.transfer.methods.continuation import (
    ContinuationError,
    MinimumTime,
    minimum_time,
    turned_angle,
)
from smallsat.studies.transfer.methods.indirect import (
    ConvergenceError,
    Extremal,
    adapted_steps,
    condition_error,
    equal_steps,
    propagate_extremal,
    published_start,
    solve_extremal,
)
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import Units

PUBLISHED_GUESS = "the document's guess"
CONTINUATION = "continuation from the document's solution"
# The configuration's steps are for flights in which the faster orbit turns up to this angle (rad);
# longer ones get as many a radian.
STEPPED_ANGLE = 3.5
# Relative difference of final times above which two extremals are two.
SAME_TIME = 1e-6


# Error of the end conditions, flown anew, above which a solution is taken up with adapted steps.
FINE = 1e-9
REFINEMENTS = 4


@dataclass(frozen=True)
class Found:
    """An extremal, and the start from which it was found."""

    extremal: Extremal
    start: str


def enough_steps(steps: int, problem: TransferProblem, final_time: float) -> int:
    """Integration steps of a flight, from those that the configuration gives a short one.

    Parameters
    ----------
    steps
        Steps over the flight that the configuration asks for.
    problem, final_time
        The flight, in canonical units.
    """
    return int(np.ceil(steps * max(1.0, turned_angle(problem, final_time) / STEPPED_ANGLE)))


def find_extremals(
    problem: TransferProblem,
    units: Units,
    intervals: Iterable[int],
    guess: Guess,
    steps: int,
) -> dict[int, Found | NotConverged]:
    """Extremals of a problem by (multiple) shooting, one a number of intervals.

    The document's guess is tried first. Where shooting from it does not converge, or ends at a
    slower extremal than the continuation, the continuation's is the start.

    Parameters
    ----------
    problem, units
        The transfer in canonical units, and these.
    intervals
        Numbers of intervals; 1 for single shooting.
    guess
        Of the configuration.
    steps
        Steps over the flight that the configuration asks for.
    """
    try:
        reference: MinimumTime | None = minimum_time(problem)
        ended = ""
    except ContinuationError as error:
        reference, ended = None, str(error)
    return {
        count: _find(problem, units, count, guess, steps, reference, ended) for count in intervals
    }


def _find(
    problem: TransferProblem,
    units: Units,
    intervals: int,
    guess: Guess,
    steps: int,
    reference: MinimumTime | None,
    ended: str,
) -> Found | NotConverged:
    slowest = reference.final_time * (1 + SAME_TIME) if reference else problem.longest_time
    if reference:
        steps = enough_steps(steps, problem, reference.final_time)
    tried, residual = [], np.nan
    try:
        start = published_start(intervals, guess, units)
        extremal = _refined(problem, intervals, start, steps)
        if extremal.final_time <= slowest:
            return Found(extremal, PUBLISHED_GUESS)
        tried.append(f"{PUBLISHED_GUESS}: a slower extremal, t_f = {extremal.final_time:.6g}")
    except ConvergenceError as error:
        tried.append(f"{PUBLISHED_GUESS}: {error}")
        residual = error.residual
    if reference is None:
        tried.append(ended)
    else:
        try:
            start = continued_start(problem, reference, intervals)
            return Found(_refined(problem, intervals, start, steps), CONTINUATION)
        except ConvergenceError as error:
            tried.append(f"{CONTINUATION}: {error}")
            residual = error.residual
    name = "indirect shooting" if intervals == 1 else f"indirect shooting, K = {intervals}"
    return NotConverged(name, tried[-1], residual, "; ".join(tried))


def _refined(problem: TransferProblem, intervals: int, start: np.ndarray, steps: int) -> Extremal:
    """Shooting with equal steps, and with adapted ones if another integrator misses the end."""
    extremal = solve_extremal(problem, intervals, start, equal_steps(intervals, steps))
    for _ in range(REFINEMENTS):
        if condition_error(problem, propagate_extremal(problem, extremal, 2)[0]) < FINE:
            break
        start = np.append(extremal.nodes.ravel()[5:], extremal.final_time)
        adapted = adapted_steps(problem, extremal)
        extremal = solve_extremal(problem, intervals, start, adapted)
    return extremal


def continued_start(problem: TransferProblem, reference: MinimumTime, intervals: int) -> np.ndarray:
    """The shooting's unknowns (10 K - 4,) from a continued extremal.

    Angle, mass and their costates, which the continuation leaves out, are integrated beside the
    others, from node to node so that no error grows.
    """
    ends = np.linspace(0.0, reference.final_time, len(reference.nodes) + 1)
    wanted = np.linspace(0.0, reference.final_time, intervals, endpoint=False)
    _, k, *_ = reference.numbers
    angle, mass_costate, rows = 0.0, 0.0, []
    for node, begin, end in zip(reference.nodes, ends[:-1], ends[1:], strict=True):
        r, v_r, v_theta, *costate = node
        l_r, l_vr, l_vtheta = k * np.array(costate)
        mass = problem.final_mass(begin)
        y = [r, angle, v_r, v_theta, mass, l_r, 0.0, l_vr, l_vtheta, mass_costate]
        flight = solve_ivp(
            lambda _, y: problem.extremal_rate(y[:5], y[5:]),
            (begin, end),
            y,
            method="LSODA",
            dense_output=True,
            rtol=1e-12,
            atol=1e-13,
        )
        rows += [flight.sol(t) for t in wanted[(wanted >= begin) & (wanted < end)]]
        angle, mass_costate = flight.y[1, -1], flight.y[9, -1]
    nodes = np.array(rows)
    # Only the derivative of the mass costate is fixed by the path; at the end it is 1.
    nodes[:, 9] += 1.0 - mass_costate
    return np.append(nodes.ravel()[5:], reference.final_time)
