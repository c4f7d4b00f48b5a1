"""What a step of the closed-form attitude transition costs, and what other steps do."""

from itertools import product
from typing import Any

import casadi as ca
import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle

QUATERNION = [f"q_{i}" for i in range(1, 5)]
RATES = ["omega_x", "omega_y", "omega_z"]

CLOSED_FORM = "closed form"
# Coefficients of explicit Runge-Kutta methods, the third order that of the document's `ode3`: times
# and slopes of the stages, each from the one before it alone, and the weights.
RUNGE_KUTTA = {
    "Euler": ((0.0,), (1.0,)),
    "Heun": ((0.0, 1.0), (1 / 2, 1 / 2)),
    "Runge-Kutta 3": ((0.0, 1 / 2, 3 / 4), (2 / 9, 1 / 3, 4 / 9)),
    "Runge-Kutta 4": ((0.0, 1 / 2, 1 / 2, 1.0), (1 / 6, 1 / 3, 1 / 3, 1 / 6)),
}
QUATERNION = [f"q_{i}" for i in range(1, 5)]
RATES = [f"omega_{axis}" for axis in "xyz"]
COLUMNS = ("method", "flight", "step_s", "operations", "operations_per_s", "error_deg", "at_rest")


def closed_form() -> ca.Function:
    """Eqs. 24 to 26 as they stand: quaternion, rates at both ends of a step, and its length."""
    q, before, after, step = _arguments()
    turn = step / 2.0 * (before + after)
    norm = ca.sqrt(ca.dot(turn, turn))
    transition = ca.DM.eye(4) * ca.cos(norm / 2.0) + _matrix(turn) / norm * ca.sin(norm / 2.0)
    return ca.Function(CLOSED_FORM.replace(" ", "_"), [q, before, after, step], [transition @ q])


def runge_kutta(method: str) -> ca.Function:
    """The same step of the kinematics by a Runge-Kutta method, and the quaternion normalised."""
    q, before, after, step = _arguments()
    times, weights = RUNGE_KUTTA[method]
    slope: Any = ca.DM.zeros(4)
    total: Any = q
    for time, weight in zip(times, weights, strict=True):
        rate = before + time * (after - before)
        slope = _matrix(rate) / 2.0 @ (q + time * step * slope)
        total = total + weight * step * slope
    name = method.replace(" ", "_").replace("-", "_")
    return ca.Function(name, [q, before, after, step], [total / ca.sqrt(ca.dot(total, total))])


def operations(step: ca.Function) -> int:
    """Arithmetic operations of a step, functions counted as one each."""
    return int(step.n_instructions() - step.nnz_in() - step.nnz_out())


def compared_steps(flights: dict[str, pd.DataFrame], step_s: float) -> pd.DataFrame:
    """Operations and attitude error at the end of flights, deg, by method, for a step and twice it.

    The rates are those of the flight, read at the step, and the reference is its own attitude.
    The last column says whether a step without any rotation gives numbers.
    """
    steps = {CLOSED_FORM: closed_form()} | {name: runge_kutta(name) for name in RUNGE_KUTTA}
    rest = (np.r_[0.0, 0.0, 0.0, 1.0], np.zeros(3), np.zeros(3), 1.0)
    rows = []
    for (name, step), (flight, flown) in product(steps.items(), flights.items()):
        spacing = flown["time_s"].iloc[1] - flown["time_s"].iloc[0]
        q, rates = flown[QUATERNION].to_numpy(), flown[RATES].to_numpy()
        for length in (step_s, 2.0 * step_s):
            every = max(1, round(length / spacing))
            read = rates[::every].T
            # A flight begins at rest, where the closed form is singular.
            known = step.mapaccum(read.shape[1] - 2)
            start = steps["Runge-Kutta 4"](q[0], read[:, 0], read[:, 1], length)
            end = known(start, read[:, 1:-1], read[:, 2:], length).full()[:, -1]
            last = (len(rates) - 1) // every * every
            error = turn_angle(error_quaternion(tuple(end / np.linalg.norm(end)), tuple(q[last])))
            count = operations(step)
            values = (count, count / length, float(f"{np.degrees(error):.2g}"))
            finite = bool(np.isfinite(step(*rest).full()).all())
            rows.append(dict(zip(COLUMNS, (name, flight, length, *values, finite), strict=True)))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _arguments() -> tuple[Any, Any, Any, Any]:
    return ca.SX.sym("q", 4), ca.SX.sym("w0", 3), ca.SX.sym("w1", 3), ca.SX.sym("dt")


def _matrix(turn: Any) -> Any:
    """Eq. 24d without its factor one half."""
    u, v, w = turn[0], turn[1], turn[2]
    rows = ((0, w, -v, u), (-w, 0, u, v), (v, -u, 0, w), (-u, -v, -w, 0))
    return ca.vertcat(*(ca.horzcat(*row) for row in rows))
