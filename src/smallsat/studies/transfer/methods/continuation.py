"""Extremals of any transfer, by continuation from the document's own solution.

In canonical units a transfer is three numbers: the initial acceleration ``a``, the inverse ``k`` of
the exhaust speed, and the final radius ``rho``. The minimum-time extremal is followed from the
document's numbers to any others along a straight line in ``(ln a, k, ln |ln rho|)``, in steps as
long as Newton's method on multiple shooting allows. The last of the three keeps ``rho`` on its side
of 1, where the transfer vanishes. Inwards leads another way: with ``k = 0`` the mass does not
change, the motion can be reversed in time, and an outward transfer flown backwards leads inwards.

The mass is a known function of time and the angle is free, so that shooting needs radius, velocity
and their costates alone: ``y = (r, v_r, v_theta, lambda_r, lambda_vr, lambda_vtheta)``. This
costate is the document's divided by ``k``, which does not vanish with ``k``.
"""

from dataclasses import dataclass
from functools import cache
from typing import cast

import casadi as ca
import numpy as np

from smallsat.optimal_control.runge_kutta import step_function
from smallsat.studies.transfer.model.problem import TransferProblem

Numbers = tuple[float, float, float, float]

# The document's own transfer, and the solution of it that we compute for its Table 1.
PUBLISHED: Numbers = (0.1405, 1.0 / 1.8658344, 1.5, 0.0)
PUBLISHED_COSTATE = (0.40202754, 0.202889853, 0.426382784)
PUBLISHED_TIME = 3.2469442080

SEGMENTS = 8
# Angle in rad that a body on the faster of the two orbits may turn in a step of order 8.
LONGEST_STEP = 0.25
TOLERANCE = 1e-11
NEWTON_ITERATIONS = 8
# Lengths of a step along the line, in the coordinates above.
FIRST_STEP, SMALLEST_STEP = 0.1, 1e-4
# Of the thrust's direction on the way, beside a primer vector whose length is 1 at the end: where a
# family of extremals has its primer vector pass through zero, the thrust turns about at once, and
# no continuation leads through. The last steps take the smoothing away. It costs thrust, so that a
# transfer which needs nearly all mass is found with less of it.
SMOOTHINGS = (0.1, 0.02, 0.0)


@dataclass(frozen=True)
class MinimumTime:
    """A minimum-time extremal in canonical units.

    Attributes
    ----------
    numbers
        ``(a, k, rho, smoothing)``.
    nodes
        ``y`` (SEGMENTS, 6) at the start of each of equal intervals.
    log_time
        Logarithm of the time of flight, which is thereby positive.
    """

    numbers: Numbers
    nodes: np.ndarray
    log_time: float

    @property
    def final_time(self) -> float:
        """Time of flight."""
        return float(np.exp(self.log_time))

    @property
    def final_mass(self) -> float:
        """Mass at the end, in initial masses."""
        return 1.0 - self.numbers[0] * self.numbers[1] * self.final_time

    @property
    def unknowns(self) -> np.ndarray:
        """Initial costate, later nodes and log_time (6 SEGMENTS - 2,)."""
        return np.append(self.nodes.ravel()[3:], self.log_time)

    def at(self, numbers: Numbers, unknowns: np.ndarray) -> "MinimumTime":
        """The same with other numbers and unknowns; the start is the initial orbit's."""
        nodes = np.concatenate([self.nodes.ravel()[:3], unknowns[:-1]])
        return MinimumTime(numbers, nodes.reshape(SEGMENTS, 6), float(unknowns[-1]))


class ContinuationError(Exception):
    """The continuation ended before its target; the message says where."""


def minimum_time(problem: TransferProblem) -> MinimumTime:
    """Minimum-time extremal of a problem in canonical units.

    Raises
    ------
    ContinuationError
        If no step leads further, or the mass would be used up.
    """
    if problem.final_radius == 1.0:
        raise ContinuationError("the final orbit is the initial one")
    for smoothing in SMOOTHINGS:
        try:
            return _minimum_time(problem, smoothing)
        except ContinuationError as error:
            ended = error
    raise ended


def turned_angle(problem: TransferProblem, final_time: float) -> float:
    """Angle (rad) that a body on the faster of the two orbits turns in a time; canonical units."""
    return _turned_angle(problem.final_radius, final_time)


def _turned_angle(rho: float, final_time: float) -> float:
    return final_time * max(1.0, rho**-1.5)


def _minimum_time(problem: TransferProblem, smoothing: float) -> MinimumTime:
    a, k, rho = problem.thrust, 1.0 / problem.exhaust_speed, problem.final_radius
    smooth = _follow(_published(), (*PUBLISHED[:3], smoothing))
    if rho < 1.0:
        smooth = _backwards(_follow(smooth, (a * rho**2, 0.0, 1.0 / rho, smoothing)))
    return _follow(_follow(smooth, (a, k, rho, smoothing)), (a, k, rho, 0.0))


def _published() -> MinimumTime:
    start = np.array([1.0, 0.0, 1.0, *PUBLISHED_COSTATE])
    start[3:] /= PUBLISHED[1]
    log_time = float(np.log(PUBLISHED_TIME))
    nodes = np.tile(start, (SEGMENTS, 1))
    for i in range(SEGMENTS - 1):
        nodes[i + 1] = _flow(MinimumTime(PUBLISHED, nodes, log_time))[0][:, i]
    return _correct(MinimumTime(PUBLISHED, nodes, log_time))[0]


def _follow(start: MinimumTime, target: Numbers) -> MinimumTime:
    """Follow an extremal along the straight line to other numbers on its side of ``rho = 1``."""
    here, there = _coordinates(start.numbers), _coordinates(target)
    length = float(np.max(np.abs(there - here)))
    if length == 0.0:
        return start
    side = np.sign(np.log(target[2]))
    current, place, step = start, 0.0, FIRST_STEP / length
    slope = np.zeros_like(start.unknowns)
    while place < 1.0:
        ahead = min(1.0, place + step)
        numbers = target if ahead == 1.0 else _numbers(here + ahead * (there - here), side)
        guess = current.at(numbers, current.unknowns + (ahead - place) * slope)
        try:
            found, iterations = _correct(guess)
        except ContinuationError:
            step = 0.4 * (ahead - place)
            if step * length < SMALLEST_STEP:
                raise ContinuationError(_where(current)) from None
            continue
        slope = (found.unknowns - current.unknowns) / (ahead - place)
        step = (ahead - place) * (2.0 if iterations <= 4 else 1.2)
        current, place = found, ahead
    return current


def _where(extremal: MinimumTime) -> str:
    thrust, k, radius, _ = extremal.numbers
    return (
        f"continuation ends at thrust {thrust:.4g}, 1 / exhaust speed {k:.4g}, final radius "
        f"{radius:.4g} (canonical units) with t_f = {extremal.final_time:.4g}, "
        f"m_f = {extremal.final_mass:.4g}"
    )


def _coordinates(numbers: Numbers) -> np.ndarray:
    a, k, rho, smoothing = numbers
    return np.array([np.log(a), k, np.log(np.abs(np.log(rho))), smoothing])


def _numbers(coordinates: np.ndarray, side: float) -> Numbers:
    a, k, rho = np.exp(coordinates[0]), coordinates[1], np.exp(side * np.exp(coordinates[2]))
    return float(a), float(k), float(rho), float(coordinates[3])


def _correct(guess: MinimumTime) -> tuple[MinimumTime, int]:
    """Newton's method; the solution and how many steps it took."""
    current, previous = guess, np.inf
    for iteration in range(NEWTON_ITERATIONS):
        if abs(current.log_time) > 20.0 or current.final_mass <= 0.0:
            break
        errors, jacobian = _errors(current)
        error = np.max(np.abs(errors))
        if error < TOLERANCE:
            return current, iteration
        # The first step may go uphill; after it the errors of a good guess fall.
        if not np.isfinite(error) or (iteration > 1 and error > previous):
            break
        previous = error
        try:
            change = np.linalg.solve(jacobian, -errors)
        except np.linalg.LinAlgError:
            break
        current = current.at(current.numbers, current.unknowns + change)
    raise ContinuationError(_where(guess))


def _errors(extremal: MinimumTime) -> tuple[np.ndarray, np.ndarray]:
    """Errors (n,) of continuity and end conditions, and their Jacobian (n, n) by the unknowns."""
    a, k, rho, _ = extremal.numbers
    ends, by_state, by_time = _flow(extremal)
    errors = np.empty(6 * SEGMENTS - 2)
    jacobian = np.zeros((errors.size, errors.size))
    for i in range(SEGMENTS - 1):
        rows = slice(6 * i, 6 * i + 6)
        errors[rows] = ends[:, i] - extremal.nodes[i + 1]
        jacobian[rows, 6 * i + 3 : 6 * i + 9] = -np.eye(6)
        _fill(jacobian[rows], i, by_state[:, 6 * i : 6 * i + 6], by_time[:, i])
    r, v_r, v_theta, _, l_vr, l_vtheta = ends[:, -1]
    # The last condition scales the costate: the primer vector's length is the mass, as it is at the
    # end of the document's extremal, where H = 0 and lambda_m = 1.
    primer, mass = np.hypot(l_vr, l_vtheta), extremal.final_mass
    errors[-4:] = r - rho, v_r, v_theta - rho**-0.5, primer / mass - 1.0
    by_end = np.zeros((4, 6))
    by_end[0, 0] = by_end[1, 1] = by_end[2, 2] = 1.0
    by_end[3, 4:] = l_vr / primer / mass, l_vtheta / primer / mass
    last = SEGMENTS - 1
    _fill(jacobian[-4:], last, by_end @ by_state[:, 6 * last :], by_end @ by_time[:, last])
    jacobian[-1, -1] += primer / mass**2 * a * k * extremal.final_time
    return errors, jacobian


def _fill(rows: np.ndarray, segment: int, by_state: np.ndarray, by_time: np.ndarray) -> None:
    # Only the costate of the first node is unknown.
    first = max(0, 6 * segment - 3)
    width = 3 if segment == 0 else 6
    rows[:, first : first + width] = by_state[:, -width:]
    rows[:, -1] = by_time


def _flow(extremal: MinimumTime) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``y`` (6, SEGMENTS) at the intervals' ends, and its derivatives by the nodes and log_time."""
    a, k, rho, smoothing = extremal.numbers
    turn = _turned_angle(rho, extremal.final_time) / SEGMENTS
    # Powers of two, so that few functions are built.
    steps = 2 ** int(np.ceil(np.log2(max(4.0, turn / LONGEST_STEP))))
    parameters = np.tile([[a], [k], [smoothing], [extremal.log_time]], SEGMENTS)
    starts = np.arange(SEGMENTS)[None, :] / SEGMENTS
    ends, by_state, by_time = _segment(steps)(extremal.nodes.T, parameters, starts)
    return ends.full(), by_state.full(), by_time.full()


@cache
def _segment(steps: int) -> ca.Function:
    def rate(s: ca.SX, y: ca.SX, p: ca.SX) -> list[ca.SX]:
        a, k, smoothing, final_time = p[0], p[1], p[2], ca.exp(p[3])
        problem = TransferProblem(1.0, cast(float, a), 1.0, 1.0, 1.0, 1.0)
        state = [y[0], 0.0, y[1], y[2], 1.0 - a * k * s * final_time]
        rates = problem.extremal_rate(state, [y[3], 0.0, y[4], y[5], 0.0], smoothing)
        return [final_time * rates[i] for i in (0, 2, 3, 5, 7, 8)]

    step = step_function(rate, 6, 4)
    y, p, s = ca.MX.sym("y", 6), ca.MX.sym("p", 4), ca.MX.sym("s")
    end, h = y, 1.0 / SEGMENTS / steps
    for i in range(steps):
        end = step(end, p, s + i * h, h)
    derivatives = [ca.jacobian(end, y), ca.jacobian(end, p)[:, 3]]
    return ca.Function("segment", [y, p, s], [end, *derivatives]).map(SEGMENTS)


def _backwards(outward: MinimumTime) -> MinimumTime:
    """An outward extremal of constant mass as the inward one that flies it backwards, in its units.

    Radial velocity and the tangential part of the thrust change sign. Lengths are in the outward
    transfer's final radius, velocities in the circular speed there.
    """
    a, _, rho, smoothing = outward.numbers
    last = _flow(outward)[0][:, -1]
    y = np.vstack([outward.nodes[1:], last])[::-1]
    time = rho**1.5
    factors = np.array([1.0 / rho, -(rho**0.5), rho**0.5, -time, 1.0, -1.0])
    numbers = (a * rho**2, 0.0, 1.0 / rho, smoothing)
    log_time = outward.log_time - float(np.log(time))
    return _correct(MinimumTime(numbers, y * factors, log_time))[0]
