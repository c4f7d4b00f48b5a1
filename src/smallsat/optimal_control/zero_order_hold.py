"""Plans whose control is held over equal pieces: what they do between points is what was optimised.

A solution of a collocation method says nothing exact of the time between its points. This
transcription does: the control is a step function within its bounds, the state is integrated
through each piece by a fixed number of Runge-Kutta steps, and the result can be flown anew by any
integrator.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from smallsat.optimal_control.gauss_pseudospectral import OptimalControlProblem
from smallsat.optimal_control.machine_code import Everywhere
from smallsat.optimal_control.nonlinear_program import NonlinearProgram

# Common expressions are evaluated once.
CSE = {"cse": True}
# Values, their rows and their columns.
Part = tuple[Any, np.ndarray, np.ndarray]
# Row or column of what is no unknown.
KNOWN = -1


class HeldControl:
    """Direct multiple shooting of a problem of fixed duration, its control held over equal pieces.

    Unknowns are the states after each piece, then the controls. A piece knows nothing of the
    others, so that derivatives are those of one piece, at many places.

    Raises
    ------
    ValueError
        Where the final time is free.
    """

    def __init__(self, problem: OptimalControlProblem, pieces: int, steps: int = 2):
        final, latest = problem.final_time
        if final != latest:
            raise ValueError(f"a held control needs one final time, not {final} to {latest}")
        self.problem, self.pieces = problem, pieces
        n, m, h = len(problem.initial), problem.controls, final / pieces
        x, u, t = ca.SX.sym("x", n), ca.SX.sym("u", m), ca.SX.sym("t")
        p = ca.SX.sym("p", problem.parameters)
        piece = _Stage(
            ca.vertcat(x, u),
            (x, u, t, p),
            _integrated(problem, x, u, t, p, h, steps),
            # A cost of the control alone, held, is exact; of a state it is a rectangle rule.
            h * problem.running_cost(x, u, t, p),
        )
        end = _Stage(
            x, (x, p), ca.vertcat(problem.terminal(x, final)), problem.end_cost(x, final, p)
        )

        states, controls = ca.MX.sym("X", n, pieces), ca.MX.sym("U", m, pieces)
        parameters = ca.MX.sym("p", problem.parameters)
        starts = ca.horzcat(ca.DM(problem.initial), states[:, :-1])
        times = h * ca.DM(np.arange(pieces)).T
        everywhere = (starts, controls, times, ca.repmat(parameters, 1, pieces))
        last = (states[:, -1], parameters)

        values = Everywhere(piece.values(), pieces)
        after, conditions = values(*everywhere), end.values()(*last)
        cost = ca.sum2(piece.costs().map(pieces)(*everywhere)) + end.costs()(*last)
        variables = ca.vertcat(ca.vec(states), ca.vec(controls))
        constraints = ca.vertcat(ca.vec(after - states), conditions)
        factors = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", constraints.numel())
        by_piece = ca.reshape(factors[1][: n * pieces], n, pieces)

        # Where a piece's start and control stand; the start of the first one is known.
        gaps = np.arange(n * pieces).reshape(pieces, n)
        conditions_at, at_end = np.arange(n * pieces, constraints.numel()), gaps[-1]
        given = n * pieces + np.arange(m * pieces).reshape(pieces, m)
        own = np.hstack([np.vstack([np.full(n, KNOWN), gaps[:-1]]), given])
        slopes = Everywhere(piece.slopes(), pieces)
        jacobian = _placed(
            (constraints.numel(), variables.numel()),
            [
                (slopes(*everywhere), gaps[:, None, :], own[:, :, None]),
                (-ca.MX.ones(n * pieces), gaps, gaps),
                (end.slopes()(*last), conditions_at[None, :], at_end[:, None]),
            ],
        )
        bends = Everywhere(piece.bends(), pieces)
        bent = bends(*everywhere, ca.repmat(factors[0], 1, pieces), by_piece)
        hessian = _placed(
            (variables.numel(), variables.numel()),
            [
                (bent, own[:, None, :], own[:, :, None]),
                (
                    end.bends()(*last, factors[0], factors[1][n * pieces :]),
                    at_end[None, :],
                    at_end[:, None],
                ),
            ],
            upper=True,
        )
        lower, upper = (
            np.r_[
                np.tile(problem.state_bounds[i], pieces),
                np.tile(problem.control_bounds[i], pieces),
            ]
            for i in (0, 1)
        )
        self.program = NonlinearProgram(
            variables,
            cost,
            constraints,
            lower,
            upper,
            parameters,
            jacobian,
            ca.Function("hessian", [variables, parameters, *factors], [hessian]),
            (values, slopes, bends),
        )

    def guess(self, times, states, controls) -> np.ndarray:
        """Start of a solve by linear interpolation of states (N, n) and controls (N, m)."""
        final_time = self.problem.final_time[0]
        ends = final_time * np.arange(1, self.pieces + 1) / self.pieces
        middles = ends - 0.5 * final_time / self.pieces
        x = [np.interp(ends, times, column) for column in np.transpose(states)]
        u = [np.interp(middles, times, column) for column in np.transpose(controls)]
        return np.concatenate([np.transpose(x).ravel(), np.transpose(u).ravel()])

    def controls(self, variables: np.ndarray) -> np.ndarray:
        """Held controls (pieces, m) of a solution."""
        n, m = len(self.problem.initial), self.problem.controls
        return np.reshape(variables[n * self.pieces :], (self.pieces, m))


def _integrated(
    problem: OptimalControlProblem, x: Any, u: Any, t: Any, p: Any, h: float, steps: int
) -> Any:
    """State after a piece of length h, by so many Runge-Kutta steps of order four."""
    dt = h / steps
    for i in range(steps):
        s = t + i * dt
        k1 = problem.rate(x, u, s, p)
        k2 = problem.rate(x + dt / 2 * k1, u, s + dt / 2, p)
        k3 = problem.rate(x + dt / 2 * k2, u, s + dt / 2, p)
        k4 = problem.rate(x + dt * k3, u, s + dt, p)
        x = x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return x


@dataclass(frozen=True)
class _Stage:
    """Values and a cost of a piece, or of the end, and their derivatives by what is unknown."""

    unknown: Any
    symbols: tuple[Any, ...]
    result: Any
    cost: Any

    def values(self) -> ca.Function:
        """The values."""
        return ca.Function("values", list(self.symbols), [self.result])

    def costs(self) -> ca.Function:
        """The cost, apart from the values, which are not computed for it."""
        return ca.Function("costs", list(self.symbols), [self.cost])

    def slopes(self) -> ca.Function:
        """Derivatives of the values, dense."""
        slopes = ca.densify(ca.jacobian(self.result, self.unknown))
        return ca.Function("slopes", list(self.symbols), [slopes], CSE)

    def bends(self) -> ca.Function:
        """Second derivatives, dense, of cost and values by their factors."""
        cost, values = ca.SX.sym("lam_f"), ca.SX.sym("lam_g", self.result.numel())
        sum_of_all = cost * self.cost + ca.dot(values, self.result)
        bends = ca.densify(ca.hessian(sum_of_all, self.unknown)[0])
        return ca.Function("bends", [*self.symbols, cost, values], [bends], CSE)


def _placed(shape: tuple[int, int], parts: Sequence[Part], *, upper: bool = False) -> Any:
    """A sparse matrix of values at rows and columns, of its upper triangle alone if so wanted.

    Rows and columns are as CasADi has the values, column by column, and are broadcast. What is
    `KNOWN` has no place.
    """
    values, rows, columns = [], [], []
    for value, row, column in parts:
        i, j = (np.ravel(places) for places in np.broadcast_arrays(row, column))
        kept = (i != KNOWN) & (j != KNOWN)
        if upper:
            kept &= i <= j
        column_by_column: Any = ca.vec(value)
        values.append(column_by_column[np.flatnonzero(kept).tolist()])
        rows.append(i[kept])
        columns.append(j[kept])
    i, j = np.concatenate(rows), np.concatenate(columns)
    order = np.lexsort((i, j))
    places = ca.Sparsity.triplet(*shape, i[order].tolist(), j[order].tolist())
    return ca.MX(places, ca.vertcat(*values)[order.tolist()])
