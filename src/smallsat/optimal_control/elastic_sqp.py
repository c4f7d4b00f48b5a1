"""Sequential quadratic programming that bears redundant and incompatible constraints.

The method of an exact penalty in a trust region (Fletcher's Sl1QP): each step minimises a quadratic
model of the Lagrangian plus a multiple of the violation of the linearised constraints. Dependent or
contradictory equalities, for which the steps of a plain SQP method are not defined, only cost what
they cannot meet, and the merit never rises.
"""

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np

# Agreement of model and function below which a step is refused, and above which the region grows.
REFUSED, GOOD = 1e-4, 0.75
SMALLEST_CURVATURE = 1e-8
# Largest weight of the violation against the objective.
LARGEST_PENALTY = 1e4
DAMPING = 0.2


@dataclass(frozen=True)
class ElasticSolution:
    """Where the iteration ended.

    Attributes
    ----------
    variables
        Last point (n,).
    objective
        There.
    violation
        Largest violation of a constraint there.
    converged
        Whether the violation is within the tolerance and no step promises more than it.
    status
        In words.
    iterations
        Number of quadratic programs.
    """

    variables: np.ndarray
    objective: float
    violation: float
    converged: bool
    status: str
    iterations: int


Evaluation = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class ElasticSqp:
    """Minimise f subject to ``equalities = 0``, ``inequalities <= 0`` and bounds.

    Parameters
    ----------
    variables, equalities, inequalities
        Numbers of them.
    """

    def __init__(self, variables: int, equalities: int, inequalities: int):
        self.n, self.equalities, self.inequalities = variables, equalities, inequalities
        rows = equalities + inequalities
        # Slacks: above and below an equality, above an inequality.
        self._slacks = np.hstack(
            [
                np.vstack([-np.eye(equalities), np.zeros((inequalities, equalities))]),
                np.vstack([np.eye(equalities), np.zeros((inequalities, equalities))]),
                np.vstack([np.zeros((equalities, inequalities)), -np.eye(inequalities)]),
            ]
        )
        size = variables + self._slacks.shape[1]
        self._size = size
        self._program = ca.conic(
            "qp",
            "daqp",
            {"h": ca.Sparsity.dense(size, size), "a": ca.Sparsity.dense(rows, size)},
            {"error_on_fail": False},
        )

    def solve(
        self,
        functions: Evaluation,
        guess: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        tolerance: float,
        iterations: int,
        penalty: float = 1.0,
        radius: float = 1.0,
    ) -> ElasticSolution:
        """Solve from a guess, moved into the bounds.

        Parameters
        ----------
        functions
            Maps a point (n,) to the values (1 + equalities + inequalities,), the objective first,
            and their Jacobian.
        guess, lower, upper
            (n,).
        tolerance
            How far constraints may be violated, and the promised decrease that ends the search.
        iterations
            Largest number of quadratic programs.
        penalty
            First weight of the summed violation against the objective; ten times more wherever the
            iteration ends infeasible.
        radius
            First radius of the trust region, relative to ``max(1, |x|)`` by variable.
        """
        x = np.clip(guess, lower, upper)
        values, jacobian = functions(x)
        curvature = np.eye(self.n)
        multipliers = np.zeros(len(values) - 1)
        status = "iterations used up"
        count, first = 0, radius
        while count < iterations:
            count += 1
            scale = np.maximum(np.abs(x), 1.0)
            low = np.maximum(lower - x, -radius * scale)
            high = np.minimum(upper - x, radius * scale)
            step, promised, found = self._step(
                curvature, values, jacobian, low, high, scale, penalty
            )
            if not np.isfinite(step).all():
                status = "no step"
                break
            if promised <= tolerance * max(1.0, abs(self._merit(values, penalty))) * 1e-2:
                status = "no step promises more"
                if (
                    self._violation(values).max(initial=0.0) <= tolerance
                    or penalty >= LARGEST_PENALTY
                ):
                    break
                penalty *= 10.0
                radius = max(radius, first)
                continue
            candidate = np.clip(x + step, lower, upper)
            new_values, new_jacobian = functions(candidate)
            gained = self._merit(values, penalty) - self._merit(new_values, penalty)
            agreement = gained / promised if np.isfinite(gained) else -1.0
            reach = float(np.max(np.abs(step) / scale))
            if agreement < 0.25:
                radius = 0.25 * reach
            elif agreement > GOOD and reach > 0.9 * radius:
                radius *= 2.0
            if agreement > REFUSED:
                multipliers = found
                curvature = _damped_update(
                    curvature,
                    candidate - x,
                    (new_jacobian[0] + multipliers @ new_jacobian[1:])
                    - (jacobian[0] + multipliers @ jacobian[1:]),
                )
                x, values, jacobian = candidate, new_values, new_jacobian
            if radius < np.finfo(float).eps:
                status = "trust region vanished"
                if penalty >= LARGEST_PENALTY:
                    break
                penalty *= 10.0
                radius = first
        violation = self._violation(values)
        return ElasticSolution(
            variables=x,
            objective=float(values[0]),
            violation=float(violation.max(initial=0.0)),
            converged=bool(
                status == "no step promises more" and violation.max(initial=0.0) <= tolerance
            ),
            status=status,
            iterations=count,
        )

    def _violation(self, values: np.ndarray) -> np.ndarray:
        equal = np.abs(values[1 : 1 + self.equalities])
        return np.concatenate([equal, np.maximum(values[1 + self.equalities :], 0.0)])

    def _merit(self, values: np.ndarray, penalty: float) -> float:
        return float(values[0] + penalty * self._violation(values).sum())

    def _step(self, curvature, values, jacobian, low, high, scale, penalty):
        """The step, the decrease of merit that its model promises, and the multipliers."""
        n, extra = self.n, self._size - self.n
        # In units of the variables' sizes and of the penalty, so that the numbers are moderate.
        weight = 1.0 / penalty
        h = np.zeros((self._size, self._size))
        h[:n, :n] = weight * scale[:, None] * curvature * scale
        h[n:, n:] = SMALLEST_CURVATURE * np.eye(extra)
        answer = self._program(
            h=h,
            g=np.r_[weight * jacobian[0] * scale, np.ones(extra)],
            a=np.hstack([jacobian[1:] * scale, self._slacks]),
            lba=np.r_[-values[1 : 1 + self.equalities], np.full(self.inequalities, -np.inf)],
            uba=-values[1:],
            lbx=np.r_[low / scale, np.zeros(extra)],
            ubx=np.r_[high / scale, np.full(extra, np.inf)],
        )
        step = np.clip(scale * answer["x"].full().ravel()[:n], low, high)
        linear = values + jacobian @ step
        model = self._merit(linear, penalty) + 0.5 * step @ curvature @ step
        return step, self._merit(values, penalty) - model, penalty * answer["lam_a"].full().ravel()


def _damped_update(b, s, y):
    """Powell's damped BFGS update, which stays positive definite."""
    bs = b @ s
    sbs = float(s @ bs)
    if sbs <= 0.0 or not np.isfinite(y).all():
        return b
    sy = float(s @ y)
    theta = 1.0 if sy >= DAMPING * sbs else (1.0 - DAMPING) * sbs / (sbs - sy)
    r = theta * y + (1.0 - theta) * bs
    return b - np.outer(bs, bs) / sbs + np.outer(r, r) / float(s @ r)
