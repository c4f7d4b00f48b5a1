"""Single and multiple shooting in numbers: arcs, the gaps between them, and exact derivatives."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from smallsat.optimal_control.machine_code import Chain
from smallsat.optimal_control.nonlinear_program import Numbers


class ShootingArc:
    """An integration whose derivatives are exact: those of its own steps, not of the flow.

    Parameters
    ----------
    step
        Of `smallsat.optimal_control.runge_kutta.step_function`.
    """

    def __init__(self, step: ca.Function):
        n, m = step.numel_in(0), step.numel_in(1)
        x, p, each = ca.SX.sym("x", n), ca.SX.sym("p", m), ca.SX.sym("e", 2)
        slopes = ca.SX.sym("dx", n, n + m)
        after = step(x, p, each[0], each[1])
        # Columns are the derivatives by the start, then by the parameters.
        by_parameters = ca.horzcat(ca.DM.zeros(m, n), ca.DM.eye(m))
        moved = ca.jtimes(after, ca.vertcat(x, p), ca.vertcat(slopes, ca.densify(by_parameters)))
        together = ca.densify(ca.vertcat(after, ca.vec(moved)))
        state = ca.vertcat(x, ca.vec(slopes))
        self._chain = Chain(ca.Function(step.name(), [state, p, each], [together]))
        self._start = np.eye(n, n + m).ravel(order="F")
        self._shape = (n, n + m)

    def __call__(
        self, given: np.ndarray, starts: np.ndarray, lengths: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Integrate over steps.

        Parameters
        ----------
        given
            State at the start (n,), then the parameters (m,).
        starts, lengths
            Of each step, (steps,).

        Returns
        -------
        end
            State (n,) after the last step.
        derivatives
            Of the end by start and parameters, (n, n + m).
        """
        n, _ = self._shape
        state, p = np.r_[given[:n], self._start], given[n:]
        end = self._chain(state, p, np.column_stack([starts, lengths]))
        return end[:n], end[n:].reshape(self._shape, order="F")


@dataclass(frozen=True)
class Interval:
    """Where an arc begins and what it is flown with, by the unknowns z of the whole problem.

    Attributes
    ----------
    matrix, offset
        Start and parameters are ``matrix @ z + offset``: (n + m, unknowns) and (n + m,).
    starts, lengths
        Of its steps, (steps,).
    """

    matrix: np.ndarray
    offset: np.ndarray
    starts: np.ndarray
    lengths: np.ndarray


def end_conditions(states: int, conditions: Callable[[Any], list[Any]]) -> ca.Function:
    """Conditions on the last state (n,), symbolic, as a function to their values and Jacobian."""
    end = ca.SX.sym("x", states)
    values = ca.vertcat(*conditions(end))
    return ca.Function("conditions", [end], [values, ca.jacobian(values, end)])


def shooting_numbers(
    arc: ShootingArc, intervals: Sequence[Interval], conditions: ca.Function
) -> Numbers:
    """Gaps between the arcs of intervals, then the conditions at the end, and their Jacobian.

    Parameters
    ----------
    arc
        How an interval is flown.
    intervals
        In the order of time.
    conditions
        Of `end_conditions`.
    """

    # An arc that overflows is one that leads nowhere.
    @np.errstate(all="ignore")
    @lru_cache(maxsize=1)
    def shoot(unknowns: bytes) -> tuple[np.ndarray, np.ndarray]:
        z = np.frombuffer(unknowns)
        values, slopes = [], []
        for k, interval in enumerate(intervals):
            given = interval.matrix @ z + interval.offset
            end, by_given = arc(given, interval.starts, interval.lengths)
            by_unknowns = by_given @ interval.matrix
            if k < len(intervals) - 1:
                after, n = intervals[k + 1], len(end)
                values.append(end - (after.matrix[:n] @ z + after.offset[:n]))
                slopes.append(by_unknowns - after.matrix[:n])
            else:
                errors, by_end = (output.full() for output in conditions(end))
                values.append(errors.ravel())
                slopes.append(by_end @ by_unknowns)
        return np.concatenate(values), np.vstack(slopes)

    # The Jacobian is asked for where the values were last.
    return lambda z: shoot(z.tobytes())[0], lambda z: shoot(z.tobytes())[1]
