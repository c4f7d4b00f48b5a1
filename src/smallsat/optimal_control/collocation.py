"""Direct collocation on Gauss-Legendre or Gauss-Radau points, with a free control at each point."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import casadi as ca
import numpy as np

from smallsat.optimal_control.nonlinear_program import NonlinearProgram


@dataclass(frozen=True)
class Collocation:
    """A mesh of equal intervals with the same collocation points in each.

    Attributes
    ----------
    intervals, degree
        Number of intervals and of collocation points in each.
    points
        ``legendre`` (order 2 degree) or ``radau`` (order 2 degree - 1).
    """

    intervals: int
    degree: int
    points: Literal["legendre", "radau"]

    @property
    def nodes(self) -> np.ndarray:
        """Collocation points (degree,) in an interval, between 0 and 1."""
        return np.array(ca.collocation_points(self.degree, self.points))


def collocation_program(
    rate: Callable[[Any, Any], list[Any]],
    initial_state: np.ndarray,
    terminal_error: Callable[[Any], list[Any]],
    mesh: Collocation,
    time_bounds: tuple[float, float],
) -> NonlinearProgram:
    """Minimum-time problem by direct collocation.

    Parameters
    ----------
    rate
        Time derivative of the state (n,) for a state and a scalar control.
    initial_state
        State (n,) at the start.
    terminal_error
        Expressions that vanish at the end.
    mesh
        Intervals and points.
    time_bounds
        Bounds of the final time.

    Returns
    -------
    NonlinearProgram
        Its variables are, interval by interval, the states (n) and then the controls (1) at the
        collocation points, the state at the interval's end, and last the final time.
    """
    size, degree = len(initial_state), mesh.degree
    c_matrix, d_vector, _ = ca.collocation_coeff(list(mesh.nodes))
    final_time = ca.MX.sym("t_f")
    h = final_time / mesh.intervals
    state: Any = ca.DM(initial_state)
    variables, constraints = [], []
    x, u = ca.SX.sym("x", size), ca.SX.sym("u")
    f = ca.Function("f", [x, u], [ca.vertcat(*rate(x, u))]).map(degree)
    for _ in range(mesh.intervals):
        states = ca.MX.sym("X", size, degree)
        controls = ca.MX.sym("U", 1, degree)
        end = ca.MX.sym("x_end", size)
        variables += [ca.vec(states), ca.vec(controls), end]
        all_states = ca.horzcat(state, states)
        constraints.append(ca.vec(h * f(states, controls) - ca.mtimes(all_states, c_matrix)))
        constraints.append(ca.mtimes(all_states, d_vector) - end)
        state = end
    constraints.append(ca.vertcat(*terminal_error(state)))
    z = ca.vertcat(*variables, final_time)
    lower = np.full(z.shape[0], -np.inf)
    upper = np.full(z.shape[0], np.inf)
    lower[-1], upper[-1] = time_bounds
    return NonlinearProgram(z, final_time, ca.vertcat(*constraints), lower, upper)


def collocation_guess(
    mesh: Collocation,
    final_time: float,
    state_at: Callable[[float], np.ndarray],
    control_at: Callable[[float], float],
) -> np.ndarray:
    """Guess for `collocation_program` from a state and a control as functions of time."""
    h = final_time / mesh.intervals
    parts = []
    for k in range(mesh.intervals):
        times = (k + mesh.nodes) * h
        parts += [np.concatenate([state_at(t) for t in times])]
        parts += [np.array([control_at(t) for t in times]), state_at((k + 1) * h)]
    return np.concatenate([*parts, [final_time]])


def collocation_control(mesh: Collocation, states: int, z: np.ndarray) -> np.ndarray:
    """Controls (intervals, degree) at the collocation points of a solution."""
    width = mesh.degree * (states + 1) + states
    rows = np.reshape(z[:-1], (mesh.intervals, width))
    return rows[:, mesh.degree * states : mesh.degree * (states + 1)]
