"""Gauss, Radau and Lobatto collocation of one problem whose solution is known.

The problem is that of Garg et al., "An Overview of Three Pseudospectral Methods for the Numerical
Solution of Optimal Control Problems": maximise y(2) subject to y' = 5/2 (-y + y u - u^2) and
y(0) = 1. With a(t) = 1 + 3 exp(5 t / 2) its state is 4 / a, its control half of that, and its
costate -(a(t) / a(2))^2 exp(-5/2 (t - 2)).
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.polynomial import legendre

from smallsat.optimal_control.gauss_pseudospectral import lagrange_derivatives, legendre_gauss
from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram

FINAL_TIME = 2.0
INITIAL = 1.0
SCHEMES = ("Gauss", "Radau", "Lobatto")
TOLERANCE = 1e-13
# The second: rounding leaves no further step.
AT_THE_END = ("Solve_Succeeded", "Search_Direction_Becomes_Too_Small")


@dataclass(frozen=True)
class Errors:
    """Largest errors at the points of collocation.

    Attributes
    ----------
    state, control, costate
        Of the state and the control at all points, and of the costate inside the interval.
    converged
        Whether the solver went to the end, and all constraints are met to `TOLERANCE`.
    """

    state: float
    control: float
    costate: float
    converged: bool


def collocation_points(scheme: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (count,) in [-1, 1] and quadrature weights: both ends, the first or neither is one."""
    last = np.append(np.zeros(count - 1), 1.0)
    if scheme == "Gauss":
        return legendre_gauss(count)
    if scheme == "Radau":
        points = np.sort(legendre.legroots(np.append(last, 1.0)).real)
        points[0] = -1.0
        weights = (1.0 - points) / (count * legendre.legval(points, last)) ** 2
        return points, weights
    inner = legendre.legroots(legendre.legder(last)).real
    points = np.concatenate([[-1.0], np.sort(inner), [1.0]])
    return points, 2.0 / (count * (count - 1) * legendre.legval(points, last) ** 2)


def solution(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """State, control and costate of the problem at times (n,)."""
    a, end = (1.0 + 3.0 * np.exp(2.5 * t) for t in (time, FINAL_TIME))
    return 4.0 / a, 2.0 / a, -((a / end) ** 2) * np.exp(-2.5 * (time - FINAL_TIME))


def errors(scheme: str, count: int) -> Errors:
    """Solve the problem with so many points of collocation, and compare with its solution."""
    points, weights = collocation_points(scheme, count)
    # The state is a polynomial through the points, and the ends that are none of them.
    inner = bool(points[0] > -1.0)
    support = np.r_[[-1.0] * inner, points, [1.0] * (scheme == "Radau")]
    matrix = lagrange_derivatives(support)[np.isin(support, points)]
    states, controls = ca.SX.sym("y", len(support)), ca.SX.sym("u", count)
    at_points = states[int(inner) : int(inner) + count]
    rate = 2.5 * (-at_points + at_points * controls - controls**2)
    half = FINAL_TIME / 2.0
    end = states[-1]
    if scheme == "Gauss":
        end = states[0] + half * ca.dot(ca.DM(weights), rate)
    constraints = ca.vertcat(ca.mtimes(ca.DM(matrix), states) - half * rate, states[0] - INITIAL)
    state, control, costate = solution(half * (points + 1.0))
    # The program has other stationary points far off; the one near the solution is asked for.
    guess = np.r_[solution(half * (support + 1.0))[0], control]
    free = np.full(len(guess), np.inf)
    program = NonlinearProgram(ca.vertcat(states, controls), -end, constraints, -free, free)
    # Lobatto's constraints nearly depend on one another. A point at which they are off by that
    # little would be acceptable to the solver; it is no solution, and as good as on other points.
    solved = IpoptSolver(program, tol=TOLERANCE, acceptable_iter=0).solve(guess)
    found = solved.variables
    assert solved.multipliers is not None
    multipliers = solved.multipliers[:count]
    # By quadrature the end of the Gauss scheme adds the last costate, which is -1, to each.
    costates = -multipliers / weights - (1.0 if scheme == "Gauss" else 0.0)
    within = (points > -1.0) & (points < 1.0)
    return Errors(
        state=float(np.abs(found[int(inner) : int(inner) + count] - state).max()),
        control=float(np.abs(found[len(support) :] - control).max()),
        costate=float(np.abs(costates - costate)[within].max()),
        converged=solved.status in AT_THE_END and solved.violation <= TOLERANCE,
    )
