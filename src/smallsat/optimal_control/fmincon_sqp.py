"""Sequential quadratic programming as MATLAB documents it for ``fmincon`` with ``sqp``.

MathWorks, "Constrained Nonlinear Optimization Algorithms" and the options of ``fmincon``: BFGS of
the Lagrangian from the identity; a step is a quadratic program within the bounds; where its
linearised constraints contradict one another, a step subject to relaxed constraints; where a step
makes the violation grow, a second-order correction; a merit function whose penalty follows Nocedal
and Wright, "Numerical Optimization", ch. 18; forward differences; default tolerances and limits.
Numbers that are documented nowhere, such as the weight of a relaxation and the factor of the
backtracking, are constants here. The quadratic programs are solved by an interior-point method;
MATLAB's is an active-set one, with the same minimiser.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import clarabel
import numpy as np
from scipy.linalg import qr
from scipy.sparse import csc_matrix

# The defaults of step, optimality and constraint tolerance are one number, and the iterations.
TOLERANCE, ITERATIONS = 1e-6, 400
EPSILON = float(np.finfo(float).eps)
DIFFERENCE = float(np.sqrt(EPSILON))
# Sufficient decrease of the merit, and what a refused step is shortened by.
ARMIJO, SHORTER = 1e-4, 0.7
# The penalty is so many times what the model needs (Nocedal and Wright, eq. 18.36); it is lowered
# only where the merit has fallen by this since the start, more after each time.
ABOVE, LEAST_PENALTY, FALLEN = 1.5, 1e-10, 1e-4
# Weight of a slack in the first step, against the largest slope of the objective.
RELAXATION = 100.0
# Share of the curvature along a step below which the update is damped (Powell).
DAMPING = 0.2
# Rows of the equalities count as dependent, and as contradicting one another, to these.
DEPENDENT, CONTRADICTING = 100.0, 1e-9
PRECISION = 1e-10
SOLVED = (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved)


@dataclass(frozen=True)
class SqpSolution:
    """Where the iteration ended.

    Attributes
    ----------
    variables
        Last point (n,).
    objective
        There.
    violation
        Largest violation of a constraint there.
    exit_flag
        As ``fmincon`` has it: 1 first-order optimal, 2 step too small at a feasible point, 0 limits
        of iterations or evaluations, -2 no feasible point found.
    iterations, evaluations
        Steps taken; evaluations of the functions, differences included.
    """

    variables: np.ndarray
    objective: float
    violation: float
    exit_flag: int
    iterations: int
    evaluations: int


@dataclass(frozen=True)
class Problem:
    """Minimise an objective under equalities, inequalities ``<= 0`` and bounds.

    Attributes
    ----------
    functions
        Maps points (m, n) to the objective, the equalities and the inequalities of each, in this
        order.
    lower, upper
        Bounds (n,).
    equalities
        How many of the values after the objective are equalities; the rest are inequalities.
    ahead
        How many steps of a line search are evaluated together, for functions to which several
        points are no more work than one. It changes neither the steps nor their count.
    """

    functions: Callable[[np.ndarray], np.ndarray]
    lower: np.ndarray
    upper: np.ndarray
    equalities: int
    ahead: int = 1

    def violations(self, values: np.ndarray) -> np.ndarray:
        """By how much each constraint is violated, (..., c), for values (..., 1 + c)."""
        violations = np.abs(values[..., 1:])
        violations[..., self.equalities :] = np.maximum(values[..., 1 + self.equalities :], 0.0)
        return violations

    def jacobian(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Forward differences, backward where a bound is in the way."""
        steps = np.copysign(DIFFERENCE * np.maximum(np.abs(x), 1.0), x)
        steps[(x + steps < self.lower) | (x + steps > self.upper)] *= -1.0
        moved = np.tile(x, (len(x), 1))
        moved[np.diag_indices(len(x))] += steps
        # Products of rows that lie apart may round otherwise.
        return np.ascontiguousarray(((self.functions(moved) - values) / steps[:, None]).T)


@dataclass(frozen=True)
class _Point:
    x: np.ndarray
    values: np.ndarray
    jacobian: np.ndarray

    def slope(self, multipliers: np.ndarray) -> np.ndarray:
        """Slope of the Lagrangian."""
        return self.jacobian[0] + multipliers @ self.jacobian[1:]


@dataclass(frozen=True)
class _Step:
    """Direction, multipliers, change of the model, violation that the linear constraints keep."""

    direction: np.ndarray
    multipliers: np.ndarray
    change: float
    violation: float


class _Merit:
    """The objective and a penalty on the summed violation."""

    def __init__(self, problem: Problem, values: np.ndarray):
        self._violations = problem.violations
        self.penalty, self._decreases, self._threshold = 1.0, 0, FALLEN
        self._first, self._kept = values, 0.0
        self.slope = 0.0

    def of(self, values: np.ndarray, penalty: float | None = None) -> Any:
        """Of values (..., 1 + c); infinite where they are no numbers."""
        weight = self.penalty if penalty is None else penalty
        merit = values[..., 0] + weight * self._violations(values).sum(axis=-1)
        return np.where(np.isfinite(merit), merit, np.inf)

    def prepare(self, values: np.ndarray, step: _Step, iteration: int) -> None:
        """Give the penalty that makes the step one of descent, and the merit's slope along it."""
        violation = float(self._violations(values).sum())
        gain, self._kept = violation + self._kept - step.violation, step.violation
        needed = self.penalty
        if gain > EPSILON and step.change > 0.0:
            needed = (ABOVE if values[0] else 1.0) * step.change / gain
        if needed < self.penalty:
            fallen = self.of(self._first, needed) - self.of(values, needed)
            if fallen > self._decreases * self._threshold:
                self._decreases += 1
                if 2 * self._decreases > iteration + 1:
                    self._threshold *= 10.0
                self.penalty = max(needed, LEAST_PENALTY)
        else:
            self.penalty = max(needed, LEAST_PENALTY)
        self.slope = min(step.change - self.penalty * violation, 0.0)


def minimise(problem: Problem, guess: np.ndarray, evaluations: int) -> SqpSolution:
    """Minimise from a guess (n,), moved into the bounds, with at most so many evaluations."""
    x = np.clip(guess, problem.lower, problem.upper)
    values = problem.functions(x[None])[0]
    count = 1 + len(x)
    point = _Point(x, values, problem.jacobian(x, values))
    merit = _Merit(problem, values)
    feasible_to = TOLERANCE * max(1.0, _worst(problem, point))
    curvature, multipliers = np.eye(len(x)), np.zeros(len(values) - 1)
    flag, iterations, relaxed = None, 0, False
    while flag is None and iterations < ITERATIONS and count < evaluations:
        step = None if relaxed else _normal_step(problem, point, point.values, curvature)
        relaxed = step is None
        if step is None:
            largest = float(np.abs(multipliers if iterations else point.jacobian[0]).max())
            weight = largest if iterations else RELAXATION * max(1.0, largest)
            step = _relaxed_step(problem, point, curvature, weight)
        merit.prepare(point.values, step, iterations)
        taken, looked_at = _line_search(
            problem, merit, point, step, None if relaxed else curvature, evaluations - count
        )
        count += looked_at
        if taken is None:
            feasible = _worst(problem, point) <= feasible_to
            if count < evaluations and (feasible or relaxed):
                flag = 2 if feasible else -2
            # Else a relaxed step is tried, or the evaluations are used up.
            relaxed = True
            continue
        iterations += 1
        length, x, values = taken
        multipliers = multipliers + length * (step.multipliers - multipliers)
        before, point = point, _Point(x, values, problem.jacobian(x, values))
        count += len(x)
        flag, again = _exit_flag(problem, before, point, multipliers, feasible_to, relaxed)
        relaxed = again
        change = point.slope(multipliers) - before.slope(multipliers)
        curvature = _damped_update(curvature, x - before.x, change)
    return SqpSolution(
        variables=point.x,
        objective=float(point.values[0]),
        violation=_worst(problem, point),
        exit_flag=0 if flag is None else flag,
        iterations=iterations,
        evaluations=count,
    )


def _worst(problem: Problem, point: _Point) -> float:
    return float(problem.violations(point.values).max(initial=0.0))


def _small(step: np.ndarray, x: np.ndarray) -> Any:
    """Whether a step (..., n) from a point (n,) is too small to matter."""
    return (np.abs(step) < TOLERANCE * np.maximum(1.0, np.abs(x))).all(axis=-1)


def _line_search(
    problem: Problem,
    merit: _Merit,
    point: _Point,
    step: _Step,
    curvature: np.ndarray | None,
    most: int,
) -> tuple[tuple[float, np.ndarray, np.ndarray] | None, int]:
    """Length, point and values of the first step that lowers the merit enough, None without one.

    Where a full step lowers the objective and raises the merit, it is corrected to second order,
    unless it is a relaxed one, which has no ``curvature``. Also how many evaluations it took, of
    which only those of full steps may exceed ``most``.
    """

    def reached(moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points = np.clip(point.x + moves, problem.lower, problem.upper)
        return points, problem.functions(points)

    here, bend = merit.of(point.values), np.zeros_like(point.x)
    (x,), (values,) = reached(step.direction[None])
    there, count = merit.of(values), 1
    if curvature is not None and here < there < np.inf and values[0] < point.values[0]:
        corrected = values - point.jacobian @ step.direction
        second = _normal_step(problem, point, corrected, curvature)
        if second is not None:
            bend = second.direction - step.direction
            (x,), (values,) = reached(second.direction[None])
            there, count = merit.of(values), 2
    if not there > here + ARMIJO * merit.slope:
        return (1.0, x, values), count
    lengths = np.ones(problem.ahead)
    while True:
        lengths = np.multiply.accumulate([lengths[-1] * SHORTER, *[SHORTER] * (problem.ahead - 1)])
        # Of Python's own powers: NumPy's differ by a bit at times, and where an iteration ends that
        # does not converge hangs on bits.
        squares = [one**2 for one in lengths.tolist()]
        moves = np.outer(lengths, step.direction) + np.outer(squares, bend)
        points, found = reached(moves)
        too_small = _small(moves, point.x)
        lower = ~(merit.of(found) > here + lengths * ARMIJO * merit.slope)
        for k in range(problem.ahead):
            if count >= most or too_small[k]:
                return None, count
            count += 1
            if lower[k]:
                return (float(lengths[k]), points[k], found[k]), count


def _exit_flag(
    problem: Problem,
    before: _Point,
    point: _Point,
    multipliers: np.ndarray,
    feasible_to: float,
    relaxed: bool,
) -> tuple[int | None, bool]:
    """The exit flag, None to go on; and whether a relaxed step is to be tried next."""
    slope = point.slope(multipliers)
    # At a bound the slope may point outwards.
    slope = np.where(point.x <= problem.lower, np.minimum(slope, 0.0), slope)
    slope = np.where(point.x >= problem.upper, np.maximum(slope, 0.0), slope)
    idle = np.abs(point.values[1 + problem.equalities :])
    unused = np.minimum(idle, idle * np.abs(multipliers[problem.equalities :])).max(initial=0.0)
    feasible = _worst(problem, point) <= feasible_to
    scale = max(1.0, float(np.abs(point.jacobian[0]).max()))
    if feasible and max(np.abs(slope).max(), unused) <= TOLERANCE * scale:
        return 1, False
    if not _small(point.x - before.x, point.x):
        return None, False
    if feasible:
        return 2, False
    return (-2, False) if relaxed else (None, True)


def _damped_update(b: np.ndarray, s: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Powell's damped update; the identity again where rounding leaves nothing convex."""
    bs = b @ s
    sbs, sy = float(s @ bs), float(s @ y)
    if sy < DAMPING * sbs:
        theta = (1.0 - DAMPING) * sbs / (sbs - sy)
        y = theta * y + (1.0 - theta) * bs
        sy = float(s @ y)
    if not (sbs > EPSILON and sy > EPSILON and np.isfinite(y).all()):
        return b
    updated = b - np.outer(bs, bs) / sbs + np.outer(y, y) / sy
    return updated if np.linalg.eigvalsh(updated)[0] > 0.0 else np.eye(len(b))


def _normal_step(
    problem: Problem, point: _Point, values: np.ndarray, curvature: np.ndarray
) -> _Step | None:
    """The step within the linearised constraints; None where they contradict one another."""
    count, rows = problem.equalities, len(values) - 1
    kept = _independent(point.jacobian[1 : 1 + count], -values[1 : 1 + count])
    if kept is None:
        return None
    used = np.concatenate([kept, np.arange(count, rows)])
    answer = _solve(
        curvature, point.jacobian[0], point.jacobian[1:][used], -values[1:][used], len(kept),
        problem.lower - point.x, problem.upper - point.x,
    )  # fmt: skip
    if answer is None:
        return None
    direction, found = answer
    multipliers = np.zeros(rows)
    multipliers[used] = found
    change = float(point.jacobian[0] @ direction + 0.5 * direction @ curvature @ direction)
    return _Step(direction, multipliers, change, 0.0)


def _independent(a: np.ndarray, b: np.ndarray) -> np.ndarray | None:
    """Rows of ``a x = b`` that imply the others; None if they contradict one another."""
    if not a.any():
        return np.arange(0) if not b.any() else None
    _, r, order = qr(a.T, mode="economic", pivoting=True)
    least = DEPENDENT * a.shape[1] * EPSILON * max(1.0, abs(r[0, 0]))
    kept = np.sort(order[: int((np.abs(np.diag(r)) > least).sum())])
    x = np.linalg.lstsq(a[kept], b[kept], rcond=None)[0]
    return kept if np.abs(a @ x - b).max() <= CONTRADICTING * max(1.0, np.abs(b).max()) else None


def _relaxed_step(problem: Problem, point: _Point, curvature: np.ndarray, weight: float) -> _Step:
    """The step that pays for what the linear constraints are missed by, linearly and squared."""
    n, rows, count = len(point.x), len(point.values) - 1, problem.equalities
    # A slack above each constraint, and one below each equality.
    slacks = np.hstack([-np.eye(rows), np.eye(rows)[:, :count]])
    extra = rows + count
    h = np.diag(np.full(n + extra, float(np.trace(curvature)) / n))
    h[:n, :n] = curvature
    answer = _solve(
        h,
        np.r_[point.jacobian[0], np.full(extra, weight)],
        np.hstack([point.jacobian[1:], slacks]),
        -point.values[1:],
        count,
        np.r_[problem.lower - point.x, np.zeros(extra)],
        np.r_[problem.upper - point.x, np.full(extra, np.inf)],
    )
    if answer is None:
        found, multipliers = np.zeros(n + extra), np.zeros(rows)
    else:
        found, multipliers = answer
    direction = found[:n]
    change = float(point.jacobian[0] @ direction + 0.5 * direction @ curvature @ direction)
    return _Step(direction, multipliers, change, float(found[n:].sum()))


def _solve(
    h: np.ndarray,
    g: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    equalities: int,
    low: np.ndarray,
    high: np.ndarray,
) -> tuple[np.ndarray, np.ndarray] | None:
    """Minimiser of a convex quadratic program and the multipliers of its rows; None without one.

    The first rows are ``a x = b``, the rest ``a x <= b``.
    """
    # Moderate numbers, whatever the weight of a slack.
    weight = 1.0 / max(1.0, float(np.abs(g).max()))
    above, below, unit = np.isfinite(high), np.isfinite(low), np.eye(len(g))
    rows = np.vstack([a, unit[above], -unit[below]])
    sides = np.concatenate([b, high[above], -low[below]])
    cones = [
        clarabel.ZeroConeT(equalities),
        clarabel.NonnegativeConeT(len(rows) - equalities),
    ]
    answer = clarabel.DefaultSolver(
        _sparse(np.triu(weight * h)), weight * g, _sparse(rows), sides, cones, _settings()
    ).solve()
    if answer.status not in SOLVED:
        return None
    return np.clip(answer.x, low, high), np.array(answer.z)[: len(a)] / weight


def _sparse(matrix: np.ndarray) -> csc_matrix:
    """The same as SciPy makes of an array, by a shorter way than over its coordinates."""
    columns, rows = np.nonzero(matrix.T)
    ends = np.zeros(matrix.shape[1] + 1, int)
    np.cumsum(np.count_nonzero(matrix, axis=0), out=ends[1:])
    return csc_matrix((matrix[rows, columns], rows, ends), shape=matrix.shape)


@cache
def _settings() -> Any:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = PRECISION
    return settings
