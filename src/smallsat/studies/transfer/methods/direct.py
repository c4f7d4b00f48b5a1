"""Direct shooting: polynomial control in one or K intervals, as a nonlinear program."""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Literal

import casadi as ca
import numpy as np
import pandas as pd
from numpy.polynomial import Polynomial
from scipy.optimize import lsq_linear

from smallsat.optimal_control.nonlinear_program import NonlinearProgram, Numbers
from smallsat.optimal_control.runge_kutta import integrate, step_function
from smallsat.optimal_control.shooting import (
    Interval,
    ShootingArc,
    end_conditions,
    shooting_numbers,
)
from smallsat.studies.transfer.configuration import Guess
from smallsat.studies.transfer.model.problem import STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import ControlHistory

# The document's time variable tau over the whole flight (section 3).
TAU_SPAN = (-1.0, 1.0)

Basis = Literal["global", "local"]


@dataclass(frozen=True)
class Case:
    """One direct case: polynomial degree N of the control and number of intervals K.

    ``basis`` says in which variable the polynomials are written: ``global`` is the document's
    tau in [-1, 1] over the whole flight (Listings 8 and 11), ``local`` runs from -1 to 1 on each
    interval. They span the same controls; only the local one is well conditioned for many
    intervals.
    """

    degree: int
    intervals: int
    basis: Basis

    @property
    def size(self) -> int:
        """Number of unknowns: interior states, coefficients, final time."""
        return 5 * (self.intervals - 1) + (self.degree + 1) * self.intervals + 1

    @property
    def scale(self) -> float:
        """Share of t_f in the rate of the polynomials' variable: all of it, or an interval's."""
        return 1.0 if self.basis == "global" else 1.0 / self.intervals

    def split(self, z: Any) -> tuple[Any, Any, Any]:
        """Interior states (5 (K-1),), coefficients ((N+1) K,), highest power first, and t_f."""
        interior = 5 * (self.intervals - 1)
        return z[:interior], z[interior:-1], z[-1]


def shooting_program(
    problem: TransferProblem,
    case: Case,
    steps: int,
    *,
    coefficient_bounds: tuple[float, float] = (-np.inf, np.inf),
    state_bounds: tuple[float, float] = (-np.inf, np.inf),
    time_bounds: tuple[float, float] = (0.0, np.inf),
    continuous: bool = False,
) -> NonlinearProgram:
    """The nonlinear program of (multiple) direct shooting (sections 3.3, 3.4).

    Parameters
    ----------
    problem, case
        What is solved.
    steps
        Integration steps over the whole flight.
    coefficient_bounds, state_bounds, time_bounds
        Bounds on coefficients, interior states and final time.
    continuous
        Also make the control continuous at the interval ends (the document's future work).
    """
    count, degree = case.intervals, case.degree
    z = ca.MX.sym("z", case.size)
    interior, coefficients, final_time = case.split(z)
    nodes = ca.reshape(ca.vertcat(ca.DM(problem.initial_state), interior), 5, count)
    coefficients = ca.reshape(coefficients, degree + 1, count)
    step, share = _step(problem, degree), max(1, steps // count)
    constraints: list[Any] = []
    for k in range(count):
        start, end = interval_ends(case, k)
        p = ca.vertcat(coefficients[:, k], case.scale * final_time)
        state = integrate(step, nodes[:, k], p, start, end, share)
        if k < count - 1:
            constraints.append(state - nodes[:, k + 1])
            if continuous:
                left = polynomial(coefficients[:, k], end)
                right = polynomial(coefficients[:, k + 1], interval_ends(case, k + 1)[0])
                constraints.append(left - right)
        else:
            constraints += problem.terminal_error(state)
    sizes = (5 * (count - 1), (degree + 1) * count, 1)
    bounds = (state_bounds, coefficient_bounds, time_bounds)
    lower = np.concatenate([np.full(n, b[0]) for n, b in zip(sizes, bounds, strict=True)])
    upper = np.concatenate([np.full(n, b[1]) for n, b in zip(sizes, bounds, strict=True)])
    return NonlinearProgram(z, final_time, ca.vertcat(*constraints), lower, upper)


def _step(problem: TransferProblem, degree: int) -> ca.Function:
    """One step of a flight; the parameters are the control's coefficients and `Case.scale` t_f."""

    # dx/ds on an interval: the global tau has rate t_f / 2, the local one t_f / (2 K).
    def rate(s: Any, x: Any, p: Any) -> list[Any]:
        beta = polynomial(p[:-1], s)
        return [p[-1] / 2 * value for value in problem.state_rate(x, ca.sin(beta), ca.cos(beta))]

    return step_function(rate, 5, degree + 2)


@lru_cache(maxsize=8)
def _arc(problem: TransferProblem, degree: int) -> ShootingArc:
    return ShootingArc(_step(problem, degree))


@lru_cache(maxsize=8)
def _end(problem: TransferProblem) -> ca.Function:
    return end_conditions(5, problem.terminal_error)


def program_numbers(problem: TransferProblem, case: Case, steps: int) -> Numbers:
    """The constraints of `shooting_program`, without continuity, to the bit, and their Jacobian."""
    count, width = case.intervals, case.degree + 1
    share, first = max(1, steps // count), 5 * (count - 1)
    everything = np.eye(5 + case.size)
    everything[-1] *= case.scale
    pieces = []
    for k in range(count):
        # Node, coefficients and final time, by what is known at the start and the unknowns.
        coefficients = range(5 + first + width * k, 5 + first + width * (k + 1))
        taken = everything[[*range(5 * k, 5 * k + 5), *coefficients, -1]]
        start, end = interval_ends(case, k)
        h = (end - start) / share
        pieces.append(
            Interval(
                matrix=taken[:, 5:],
                offset=taken[:, :5] @ problem.initial_state,
                starts=start + np.arange(share) * h,
                lengths=np.full(share, h),
            )
        )
    return shooting_numbers(_arc(problem, case.degree), pieces, _end(problem))


def polynomial(coefficients: Any, s: Any) -> Any:
    """Value at ``s`` of the polynomial with these coefficients, highest power first."""
    value: Any = 0.0
    for i in range(coefficients.shape[0]):
        value = value * s + coefficients[i]
    return value


def interval_ends(case: Case, k: int) -> tuple[float, float]:
    """Ends of interval ``k`` in the variable of the case's basis."""
    start, end = TAU_SPAN
    if case.basis == "local":
        return start, end
    width = (end - start) / case.intervals
    return start + k * width, start + (k + 1) * width


def published_guess(case: Case, guess: Guess) -> np.ndarray:
    """The document's guess (size,): flat, and a long flight (Listings 6, 10)."""
    return np.concatenate(
        [
            np.full(5 * (case.intervals - 1), guess.interior_state),
            np.full((case.degree + 1) * case.intervals, guess.coefficient),
            [guess.direct_final_time],
        ]
    )


def control_history(case: Case, z: np.ndarray) -> ControlHistory:
    """Control and times of a solution (size,)."""
    _, coefficients, final_time = case.split(z)
    rows = np.reshape(coefficients, (case.intervals, case.degree + 1))
    times = np.linspace(0.0, final_time, case.intervals + 1)
    controls = []
    for k, row in enumerate(rows):
        start, end = interval_ends(case, k)

        def control(t, row=row, k=k, start=start, end=end):
            s = start + (end - start) * (t - times[k]) / (times[k + 1] - times[k])
            return np.polyval(row, s)

        controls.append(control)
    return ControlHistory(times, controls)


def largest_coefficient(case: Case, z: np.ndarray) -> float:
    """Largest coefficient of a solution (size,) in the document's basis, whatever the case's."""
    _, coefficients, _ = case.split(z)
    published = replace(case, basis="global")
    largest = 0.0
    for k, row in enumerate(np.reshape(coefficients, (case.intervals, case.degree + 1))):
        (a, b), (start, end) = interval_ends(case, k), interval_ends(published, k)
        slope = (b - a) / (end - start)
        local = Polynomial([a - slope * start, slope])
        largest = max(largest, float(np.max(np.abs(Polynomial(row[::-1])(local).coef))))
    return largest


def fitted_guess(
    case: Case, extremal: pd.DataFrame, coefficients: tuple[float, float] = (-np.inf, np.inf)
) -> np.ndarray:
    """Guess (size,) from an extremal: its control fitted by polynomials, its states at the nodes.

    Parameters
    ----------
    case
        The case to guess for.
    extremal
        Table of `smallsat.studies.transfer.methods.indirect.propagate_extremal`.
    coefficients
        Bounds of the polynomials' coefficients, within which the fit is the best one.
    """
    t = extremal["t"].to_numpy()
    ends = np.linspace(t[0], t[-1], case.intervals + 1)
    angle = np.unwrap(extremal["beta"])
    rows = []
    for k in range(case.intervals):
        start, end = interval_ends(case, k)
        powers = np.vander(np.linspace(start, end, 40), case.degree + 1)
        times = np.linspace(ends[k], ends[k + 1], len(powers))
        rows.append(lsq_linear(powers, np.interp(times, t, angle), coefficients).x)
    nodes = [[np.interp(end, t, extremal[name]) for name in STATES] for end in ends[1:-1]]
    return np.concatenate([np.ravel(nodes), np.ravel(rows), [t[-1]]])
