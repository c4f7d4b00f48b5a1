"""The Gauss pseudospectral method (slew, Eqs. 5 to 17), for any problem, in one or many segments.

The state of a segment is a polynomial through its start and its Legendre-Gauss points; the dynamics
hold at those points alone, and the end follows by Gauss quadrature. Costates come from the
multipliers of the same constraints.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from smallsat.optimal_control.nonlinear_program import NonlinearProgram


def legendre_gauss(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Legendre-Gauss points (nodes,) in (-1, 1) and their weights (Eq. 13)."""
    points, weights = np.polynomial.legendre.leggauss(nodes)
    return points, weights


def lagrange_derivatives(support: np.ndarray) -> np.ndarray:
    """Derivatives at points (n,) of the Lagrange polynomials through them, shape (n, n)."""
    gaps = support[:, None] - support
    np.fill_diagonal(gaps, 1.0)
    barycentric = 1.0 / np.prod(gaps, axis=1)
    matrix = barycentric[None, :] / barycentric[:, None] / gaps
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return matrix


def differentiation_matrix(points: np.ndarray) -> np.ndarray:
    """Derivatives at the points of the Lagrange polynomials through -1 and the points.

    Returns
    -------
    array, shape (N, N + 1)
        Eq. 15: the first column belongs to the start of the interval.
    """
    return lagrange_derivatives(np.r_[-1.0, points])[1:]


@dataclass(frozen=True)
class OptimalControlProblem:
    """Minimise an end cost and an integral, from a given state to an end that obeys conditions.

    Attributes
    ----------
    initial
        State (n,) at time 0.
    controls
        Number m of controls.
    rate
        Maps state (n,), control (m,), time and parameters (p,) to the state's rate: symbolic.
    running_cost
        Maps the same to the integrand.
    terminal
        Maps the last state and the final time to expressions that vanish.
    end_cost
        Maps the last state, the final time and the parameters to the end cost.
    state_bounds, control_bounds
        Lower and upper bounds, (2, n) and (2, m).
    final_time
        Lower and upper bound of the final time; equal where it is fixed.
    parameters
        Number p of values that are given at each solve, such as a smoothing.
    """

    initial: np.ndarray
    controls: int
    rate: Callable[[Any, Any, Any, Any], Any]
    running_cost: Callable[[Any, Any, Any, Any], Any]
    terminal: Callable[[Any, Any], Any]
    end_cost: Callable[[Any, Any, Any], Any]
    state_bounds: np.ndarray
    control_bounds: np.ndarray
    final_time: tuple[float, float]
    parameters: int = 0


@dataclass(frozen=True)
class Mesh:
    """Equal segments with the same number of Legendre-Gauss points in each."""

    segments: int
    nodes: int

    @property
    def fractions(self) -> np.ndarray:
        """Places of all points (segments * nodes,) as fractions of the final time."""
        points, _ = legendre_gauss(self.nodes)
        within = (points + 1.0) / 2.0
        return np.ravel((np.arange(self.segments)[:, None] + within) / self.segments)


@dataclass(frozen=True)
class Plan:
    """A solution at its points.

    Attributes
    ----------
    times
        Times of the points, (N,).
    states, controls, costates
        At the points: (N, n), (N, m), (N, n). A costate is the cost's derivative by the state.
    ends
        States at the ends of the segments, the start included: (segments + 1, n).
    final_time
        Time at which the plan ends.
    """

    times: np.ndarray
    states: np.ndarray
    controls: np.ndarray
    costates: np.ndarray
    ends: np.ndarray
    final_time: float


class GaussPseudospectral:
    """Transcription of a problem on a mesh."""

    def __init__(self, problem: OptimalControlProblem, mesh: Mesh):
        self.problem, self.mesh = problem, mesh
        n, m, k = len(problem.initial), problem.controls, mesh.nodes
        points, self._weights = legendre_gauss(k)
        matrix = ca.DM(differentiation_matrix(points).T)
        weights = ca.DM(self._weights)
        x, u, t = ca.SX.sym("x", n), ca.SX.sym("u", m), ca.SX.sym("t")
        p = ca.SX.sym("p", problem.parameters)
        self._rate = ca.Function("rate", [x, u, t, p], [problem.rate(x, u, t, p)])
        self._cost = ca.Function("cost", [x, u, t, p], [problem.running_cost(x, u, t, p)])

        final = ca.SX.sym("t_f")
        parameters = ca.SX.sym("p", problem.parameters)
        # One that is given is a number to all that depends on it: nothing is differentiated by it.
        earliest, latest = problem.final_time
        ending: Any = ca.SX(earliest) if earliest == latest else final
        h = ending / mesh.segments
        start: Any = ca.DM(problem.initial)
        # The constraints are the difference of what is linear in the states, which couples all
        # points of a segment, and of the dynamics, of which each belongs to one point.
        variables, coupled, pointwise = [], [], []
        objective: Any = 0.0
        for s in range(mesh.segments):
            states, controls = ca.SX.sym("X", n, k), ca.SX.sym("U", m, k)
            end = ca.SX.sym("E", n)
            variables += [ca.vec(states), ca.vec(controls), end]
            rates, costs = [], []
            for i in range(k):
                time = (s + (points[i] + 1.0) / 2.0) * h
                arguments = (states[:, i], controls[:, i], time, parameters)
                rates.append(self._rate(*arguments))
                costs.append(self._cost(*arguments))
            f = ca.horzcat(*rates)
            coupled += [ca.vec(ca.mtimes(ca.horzcat(start, states), matrix)), end - start]
            pointwise += [ca.vec(h / 2.0 * f), h / 2.0 * ca.mtimes(f, weights)]
            objective += h / 2.0 * ca.dot(weights, ca.vertcat(*costs))
            start = end
        coupled.append(ca.vertcat(problem.terminal(start, ending)))
        pointwise.append(ca.SX.zeros(coupled[-1].shape[0]))
        objective += problem.end_cost(start, ending, parameters)
        lower, upper = (
            np.r_[
                np.tile(
                    np.r_[
                        np.tile(problem.state_bounds[i], k),
                        np.tile(problem.control_bounds[i], k),
                        problem.state_bounds[i],
                    ],
                    mesh.segments,
                ),
                problem.final_time[i],
            ]
            for i in (0, 1)
        )
        z = ca.vertcat(*variables, final)
        linear, dynamics = ca.vertcat(*coupled), ca.vertcat(*pointwise)
        self.program = NonlinearProgram(
            z,
            objective,
            linear - dynamics,
            lower,
            upper,
            parameters,
            ca.jacobian(linear, z) - ca.jacobian(dynamics, z),
        )

    def guess(
        self,
        final_time: float,
        state_at: Callable[[float], np.ndarray],
        control_at: Callable[[float], np.ndarray],
    ) -> np.ndarray:
        """Start of a solve from a state and a control as functions of time."""
        mesh, parts = self.mesh, []
        times = np.reshape(self.mesh.fractions, (mesh.segments, mesh.nodes)) * final_time
        for s in range(mesh.segments):
            parts += [state_at(t) for t in times[s]]
            parts += [control_at(t) for t in times[s]]
            parts.append(state_at((s + 1) / mesh.segments * final_time))
        return np.concatenate([*parts, [final_time]])

    def plan(self, variables: np.ndarray, multipliers: np.ndarray | None = None) -> Plan:
        """Read a solution; its costates where the multipliers are given, else not a number."""
        n, m = len(self.problem.initial), self.problem.controls
        mesh, k = self.mesh, self.mesh.nodes
        rows = np.reshape(variables[:-1], (mesh.segments, k * (n + m) + n))
        states = np.reshape(rows[:, : k * n], (-1, n))
        controls = np.reshape(rows[:, k * n : k * (n + m)], (-1, m))
        ends = np.vstack([self.problem.initial, rows[:, k * (n + m) :]])
        costates = np.full_like(states, np.nan)
        if multipliers is not None:
            given = np.reshape(multipliers[: mesh.segments * (k + 1) * n], (mesh.segments, -1))
            collocation = np.reshape(given[:, : k * n], (mesh.segments, k, n))
            quadrature = given[:, None, k * n :]
            scaled = collocation / self._weights[None, :, None] + quadrature
            costates = -np.reshape(scaled, (-1, n))
        final_time = float(variables[-1])
        return Plan(mesh.fractions * final_time, states, controls, costates, ends, final_time)

    def hamiltonian(self, plan: Plan, parameters: np.ndarray) -> np.ndarray:
        """Running cost plus costate times rate, at the points (N,)."""
        count = len(plan.times)
        given = np.tile(parameters[:, None], count)
        arguments = (plan.states.T, plan.controls.T, plan.times[None, :], given)
        f, g = (function.map(count)(*arguments).full() for function in (self._rate, self._cost))
        return g.ravel() + np.sum(plan.costates * f.T, axis=1)
