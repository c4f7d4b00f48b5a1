"""Bang-bang controls by their switching times: the flow through the arcs is integrated.

A second method for minimum-time problems, with no mesh: the arcs' durations are the only unknowns,
and the end conditions hold to the error of the integrator.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram, Solution
from smallsat.optimal_control.runge_kutta import integrate, step_function


@dataclass(frozen=True)
class Arcs:
    """Controls held over arcs.

    Attributes
    ----------
    controls
        Control of each arc, (arcs, m).
    durations
        Duration of each arc, (arcs,).
    """

    controls: np.ndarray
    durations: np.ndarray

    @property
    def final_time(self) -> float:
        """Sum of the durations."""
        return float(np.sum(self.durations))

    def switches(self) -> list[tuple[int, float]]:
        """Axis and time of every change of sign, in order of time."""
        times = np.cumsum(self.durations)[:-1]
        return [
            (int(axis), float(time))
            for time, before, after in zip(
                times, self.controls[:-1], self.controls[1:], strict=True
            )
            for axis in np.flatnonzero(before != after)
        ]


def arcs_of(times: np.ndarray, controls: np.ndarray, final_time: float) -> Arcs:
    """Read the arcs off controls (n, m) at times (n,): a switch is a change of sign.

    Each axis switches at the zero of the line between the two points; the controls of the arcs are
    -1 and 1.
    """
    signs = np.where(controls >= 0.0, 1.0, -1.0)
    switches = sorted(
        (
            float(
                times[k]
                + (times[k + 1] - times[k])
                * abs(controls[k, axis])
                / (abs(controls[k, axis]) + abs(controls[k + 1, axis]))
            ),
            int(axis),
        )
        for k, axis in zip(*np.nonzero(np.diff(signs, axis=0)), strict=True)
    )
    held = [signs[0].copy()]
    for _, axis in switches:
        held.append(held[-1].copy())
        held[-1][axis] *= -1.0
    ends = np.r_[0.0, [time for time, _ in switches], final_time]
    return Arcs(np.array(held), np.diff(ends))


def refine(
    rate: Callable[[Any, Any, Any], Any],
    initial: np.ndarray,
    terminal: Callable[[Any, Any], Any],
    arcs: Arcs,
    steps: int = 12,
) -> tuple[Arcs, Solution]:
    """Least final time over the durations of the arcs.

    Parameters
    ----------
    rate
        Maps state (n,), control (m,) and time to the state's rate, symbolic.
    initial
        State (n,) at time 0.
    terminal
        Maps the last state and the final time to expressions that vanish.
    arcs
        Sequence of controls, and durations to start from.
    steps
        Runge-Kutta steps of order 8 in an arc.
    """
    n, m = len(initial), arcs.controls.shape[1]

    def arc_rate(s: Any, x: Any, p: Any) -> Any:
        # s runs from 0 to 1 in the arc; p holds the control, the duration and the arc's start.
        return p[m] * rate(x, p[:m], p[m + 1] + s * p[m])

    step = step_function(arc_rate, n, m + 2)
    durations = ca.MX.sym("d", len(arcs.durations))
    x: Any = ca.DM(initial)
    start: Any = ca.DM(0.0)
    for k, control in enumerate(arcs.controls):
        x = integrate(step, x, ca.vertcat(ca.DM(control), durations[k], start), 0.0, 1.0, steps)
        start = start + durations[k]
    lower = np.zeros(len(arcs.durations))
    program = NonlinearProgram(
        durations,
        ca.sum1(durations),
        ca.vertcat(terminal(x, start)),
        lower,
        np.full_like(lower, np.inf),
    )
    solution = IpoptSolver(program, tol=1e-11, bound_relax_factor=0.0).solve(arcs.durations)
    # An arc that vanishes may be below its bound by rounding.
    return Arcs(arcs.controls, np.maximum(solution.variables, lower)), solution
