"""Fixed-step integration of order 8 as a symbolic function, for shooting with exact derivatives."""

from collections.abc import Callable
from typing import Any

import casadi as ca
from scipy.integrate import DOP853

# Dormand and Prince's 12 stages of order 8, without the error estimate: SciPy keeps the tableau.
STAGE_MATRIX = DOP853.A[: DOP853.n_stages, : DOP853.n_stages]
WEIGHTS = DOP853.B
NODES = DOP853.C[: DOP853.n_stages]


def step_function(
    rate: Callable[[Any, Any, Any], Any], states: int, parameters: int, name: str = "step"
) -> ca.Function:
    """One step of order 8 for ``dx/ds = rate(s, x, p)``.

    Parameters
    ----------
    rate
        Maps ``s`` (scalar), ``x`` (states,) and ``p`` (parameters,), all symbolic, to ``dx/ds``
        (a list or vector of length states).
    states, parameters
        Lengths of x and p.
    name
        Name of the function.

    Returns
    -------
    casadi.Function
        ``(x, p, s, h) -> x`` at ``s + h``. The local error is of order 9 in h.
    """
    x, p = ca.SX.sym("x", states), ca.SX.sym("p", parameters)
    s, h = ca.SX.sym("s"), ca.SX.sym("h")
    slopes: list[Any] = []
    for row, node in zip(STAGE_MATRIX, NODES, strict=True):
        increment = sum(
            (float(a) * slope for a, slope in zip(row, slopes, strict=False) if a != 0.0),
            ca.SX.zeros(states),
        )
        slope = rate(s + float(node) * h, x + h * increment, p)
        slopes.append(ca.vertcat(*slope) if isinstance(slope, list) else slope)
    total = sum(float(b) * slope for b, slope in zip(WEIGHTS, slopes, strict=True) if b != 0.0)
    return ca.Function(name, [x, p, s, h], [x + h * total])


def integrate(step: ca.Function, x: Any, p: Any, start: float, end: float, steps: int) -> Any:
    """State at ``end`` after equal steps from ``start``; symbolic in, symbolic out."""
    h = (end - start) / steps
    for i in range(steps):
        x = step(x, p, start + i * h, h)
    return x
