"""Plans whose control is held over equal pieces: what they do between points is what was optimised.

A solution of a collocation method says nothing exact of the time between its points. This
transcription does: the control is a step function within its bounds, the state is integrated
through each piece by a fixed number of Runge-Kutta steps, and the result can be flown anew by any
integrator.
"""

from typing import Any

import casadi as ca
import numpy as np

from smallsat.optimal_control.gauss_pseudospectral import OptimalControlProblem
from smallsat.optimal_control.nonlinear_program import NonlinearProgram


class HeldControl:
    """Direct multiple shooting of a problem with a control held over equal pieces."""

    def __init__(self, problem: OptimalControlProblem, pieces: int, steps: int = 2):
        self.problem, self.pieces = problem, pieces
        n, m = len(problem.initial), problem.controls
        x, u, t = ca.SX.sym("x", n), ca.SX.sym("u", m), ca.SX.sym("t")
        p, h = ca.SX.sym("p", problem.parameters), ca.SX.sym("h")
        y: Any = x
        for i in range(steps):
            s = t + i * h / steps
            dt = h / steps
            k1 = problem.rate(y, u, s, p)
            k2 = problem.rate(y + dt / 2 * k1, u, s + dt / 2, p)
            k3 = problem.rate(y + dt / 2 * k2, u, s + dt / 2, p)
            k4 = problem.rate(y + dt * k3, u, s + dt, p)
            y = y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        flow = ca.Function("flow", [x, u, t, h, p], [y])
        # A cost of the control alone, held, is exact; of a state it is a rectangle rule.
        cost = ca.Function("cost", [x, u, t, h, p], [h * problem.running_cost(x, u, t, p)])

        final = ca.MX.sym("t_f")
        parameters = ca.MX.sym("p", problem.parameters)
        states, controls = ca.MX.sym("X", n, pieces), ca.MX.sym("U", m, pieces)
        starts = ca.horzcat(ca.DM(problem.initial), states[:, :-1])
        length = final / pieces
        times = length * ca.DM(np.arange(pieces)).T
        arguments = (
            starts,
            controls,
            times,
            ca.repmat(length, 1, pieces),
            ca.repmat(parameters, 1, pieces),
        )
        gaps = flow.map(pieces)(*arguments) - states
        objective = ca.sum2(cost.map(pieces)(*arguments))
        objective += problem.end_cost(states[:, -1], final, parameters)
        constraints = ca.vertcat(ca.vec(gaps), ca.vertcat(problem.terminal(states[:, -1], final)))
        lower, upper = (
            np.r_[
                np.tile(problem.state_bounds[i], pieces),
                np.tile(problem.control_bounds[i], pieces),
                problem.final_time[i],
            ]
            for i in (0, 1)
        )
        self.program = NonlinearProgram(
            ca.vertcat(ca.vec(states), ca.vec(controls), final),
            objective,
            constraints,
            lower,
            upper,
            parameters,
        )

    def guess(self, final_time: float, times, states, controls) -> np.ndarray:
        """Start of a solve by linear interpolation of states (N, n) and controls (N, m)."""
        ends = final_time * np.arange(1, self.pieces + 1) / self.pieces
        middles = ends - 0.5 * final_time / self.pieces
        x = [np.interp(ends, times, column) for column in np.transpose(states)]
        u = [np.interp(middles, times, column) for column in np.transpose(controls)]
        return np.concatenate([np.transpose(x).ravel(), np.transpose(u).ravel(), [final_time]])

    def controls(self, variables: np.ndarray) -> np.ndarray:
        """Held controls (pieces, m) of a solution."""
        n, m = len(self.problem.initial), self.problem.controls
        return np.reshape(variables[n * self.pieces : -1], (self.pieces, m))
