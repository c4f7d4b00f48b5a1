"""The fuller model that plans and controllers are flown in: attitude, wheels and orbit together."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.quaternions import (
    error_quaternion,
    quaternion_rate,
    quaternion_to_dcm,
    roll_pitch_yaw,
)
from smallsat.dynamics.attitude.reaction_wheels import angular_acceleration
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.environment.torques import ATMOSPHERE, density, gravity_gradient, panel_drag
from smallsat.dynamics.orbits.kepler_orbits import acceleration
from smallsat.dynamics.vectors import dot, times
from smallsat.studies.slew.parameters import Parameters

# What commands the torque.
EIGENAXIS, OPEN_LOOP, TRACKING = range(3)
# The Earth's rate, rad/s: the air turns with it.
EARTH_RATE = 7.2921159e-5

COLUMNS = (
    "time_s",
    "q_1", "q_2", "q_3", "q_4",
    "omega_x", "omega_y", "omega_z",
    "h_x", "h_y", "h_z",
    "r_x", "r_y", "r_z",
    "v_x", "v_y", "v_z",
    "u_x", "u_y", "u_z",
)  # fmt: skip


class Plant(NamedTuple):
    """The spacecraft and its surroundings, as the compiled loop takes them.

    ``carried``, ``gradient`` and ``drag`` switch the wheels' momentum, the gravity gradient and
    the drag on (1) or off (0); ``drag`` is also a factor of the density.
    """

    inertia: np.ndarray
    inverse: np.ndarray
    mu: float
    radius: float
    j2: float
    panels: np.ndarray
    drag_coefficient: float
    torque: float
    momentum: float
    carried: float
    gradient: float
    drag: float


class Command(NamedTuple):
    """What the controller does, as the compiled loop takes it.

    Attributes
    ----------
    mode
        `EIGENAXIS` (a PD law to a target), `OPEN_LOOP` (a torque history) or `TRACKING` (a PID law
        about a planned motion, with its torque fed forward).
    stiffness, damping, integral
        Gains of the laws, each times the inertia: 1/s^2, 1/s and 1/s^3.
    gain_inertia
        Inertia tensor that the law knows.
    target
        Quaternion, for `EIGENAXIS`.
    hold
        Steps for which a torque is held; 0 for a continuous one.
    table_step
        Time between rows of the plan, s.
    plan
        Shape (n, 10): torque, quaternion, rate; linear between rows.
    """

    mode: int
    stiffness: float
    damping: float
    integral: float
    gain_inertia: np.ndarray
    target: np.ndarray
    hold: int
    table_step: float
    plan: np.ndarray


@compiled
def _planned(plan, table_step, time):
    place = min(max(time / table_step, 0.0), plan.shape[0] - 1.0)
    k = min(int(place), plan.shape[0] - 2)
    part = place - k
    return plan[k] + part * (plan[k + 1] - plan[k])


@compiled
def _command(time, y, integral, command, plant):
    """Torque of the wheels on the body, N m, within their limits."""
    q = (y[0], y[1], y[2], y[3])
    if command.mode == 0:
        error = error_quaternion(q, command.target)
        sign = 1.0 if error[3] >= 0.0 else -1.0
        wanted = (
            -sign * command.stiffness * error[0] - command.damping * y[4],
            -sign * command.stiffness * error[1] - command.damping * y[5],
            -sign * command.stiffness * error[2] - command.damping * y[6],
        )
        u = times(command.gain_inertia, wanted)
    else:
        row = _planned(command.plan, command.table_step, time)
        u = (row[0], row[1], row[2])
        if command.mode == 2:
            error = error_quaternion(q, (row[3], row[4], row[5], row[6]))
            sign = 1.0 if error[3] >= 0.0 else -1.0
            wanted = (
                -sign * command.stiffness * error[0]
                - command.damping * (y[4] - row[7])
                - command.integral * integral[0],
                -sign * command.stiffness * error[1]
                - command.damping * (y[5] - row[8])
                - command.integral * integral[1],
                -sign * command.stiffness * error[2]
                - command.damping * (y[6] - row[9])
                - command.integral * integral[2],
            )
            extra = times(command.gain_inertia, wanted)
            u = (u[0] + extra[0], u[1] + extra[1], u[2] + extra[2])
    return (
        _limited(u[0], y[7], plant.torque, plant.momentum),
        _limited(u[1], y[8], plant.torque, plant.momentum),
        _limited(u[2], y[9], plant.torque, plant.momentum),
    )


@compiled
def _limited(u, given, torque, momentum):
    if abs(given) >= momentum and u * given > 0.0:
        return 0.0
    return min(torque, max(-torque, u))


@compiled
def outer_torques(y, plant):
    """Gravity-gradient and drag torque, N m, in body components."""
    dcm = quaternion_to_dcm((y[0], y[1], y[2], y[3]))
    r = (y[10], y[11], y[12])
    body = times(dcm, r)
    g = gravity_gradient(plant.inertia, body, plant.mu)
    altitude = dot(r, r) ** 0.5 - plant.radius
    wind = times(dcm, (y[13] + EARTH_RATE * y[11], y[14] - EARTH_RATE * y[10], y[15]))
    d = panel_drag(plant.panels, wind, density(altitude, ATMOSPHERE), plant.drag_coefficient)
    return g, d


@compiled
def _rate(y, u, plant, out):
    qd = quaternion_rate((y[0], y[1], y[2], y[3]), (y[4], y[5], y[6]))
    outer = (0.0, 0.0, 0.0)
    if plant.gradient != 0.0 or plant.drag != 0.0:
        g, d = outer_torques(y, plant)
        outer = (
            plant.gradient * g[0] + plant.drag * d[0],
            plant.gradient * g[1] + plant.drag * d[1],
            plant.gradient * g[2] + plant.drag * d[2],
        )
    wd = angular_acceleration(
        plant.inertia,
        plant.inverse,
        (y[4], y[5], y[6]),
        (y[7], y[8], y[9]),
        u,
        outer,
        plant.carried,
    )
    a = acceleration((y[10], y[11], y[12]), plant.mu, plant.radius, plant.j2)
    for i in range(4):
        out[i] = qd[i]
    for i in range(3):
        out[4 + i] = wd[i]
        out[7 + i] = u[i]
        out[10 + i] = y[13 + i]
        out[13 + i] = a[i]


@compiled
def integrate(start, plant, command, steps, step, every):
    """Classical Runge-Kutta with equal steps.

    Returns
    -------
    array, shape (steps // every + 1, 20)
        Rows with the columns `COLUMNS`, every so many steps.
    """
    record = np.empty((steps // every + 1, 20))
    y = start.copy()
    integral = np.zeros(3)
    k1, k2, k3, k4 = np.empty(16), np.empty(16), np.empty(16), np.empty(16)
    held = (0.0, 0.0, 0.0)
    for k in range(steps + 1):
        time = k * step
        if command.hold == 0 or k % command.hold == 0:
            held = _command(time, y, integral, command, plant)
        if k % every == 0:
            row = k // every
            record[row, 0] = time
            record[row, 1:17] = y
            record[row, 17:20] = held
        if k == steps:
            break
        free = command.hold == 0
        _rate(y, held, plant, k1)
        z = y + 0.5 * step * k1
        u = _command(time + 0.5 * step, z, integral, command, plant) if free else held
        _rate(z, u, plant, k2)
        z = y + 0.5 * step * k2
        u = _command(time + 0.5 * step, z, integral, command, plant) if free else held
        _rate(z, u, plant, k3)
        z = y + step * k3
        u = _command(time + step, z, integral, command, plant) if free else held
        _rate(z, u, plant, k4)
        if command.mode == 2:
            row_now = _planned(command.plan, command.table_step, time)
            error = error_quaternion(
                (y[0], y[1], y[2], y[3]), (row_now[3], row_now[4], row_now[5], row_now[6])
            )
            sign = 1.0 if error[3] >= 0.0 else -1.0
            for i in range(3):
                integral[i] += step * sign * error[i]
        y = y + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        length = (y[0] ** 2 + y[1] ** 2 + y[2] ** 2 + y[3] ** 2) ** 0.5
        for i in range(4):
            y[i] /= length
    return record


def plant(
    parameters: Parameters,
    *,
    carried: bool = True,
    gradient: bool = True,
    drag: float = 1.0,
    inertia_factor: float = 1.0,
) -> Plant:
    """The spacecraft of the document in the fuller model, or with parts of it left out."""
    inertia = inertia_factor * parameters.inertia
    return Plant(
        inertia,
        np.linalg.inv(inertia),
        *parameters.gravity,
        parameters.panels,
        parameters.drag_coefficient,
        parameters.torque,
        parameters.momentum,
        float(carried),
        float(gradient),
        float(drag),
    )


def eigenaxis(
    parameters: Parameters,
    target: np.ndarray,
    natural_frequency: float,
    damping_ratio: float,
    *,
    factor: float = 1.0,
    hold: int = 0,
) -> Command:
    """The document's PD law: J times (-factor wn^2 q_e - 2 zeta wn omega)."""
    return Command(
        EIGENAXIS,
        factor * natural_frequency**2,
        2.0 * damping_ratio * natural_frequency,
        0.0,
        parameters.inertia,
        target,
        hold,
        1.0,
        np.zeros((2, 10)),
    )


def open_loop(parameters: Parameters, table_step: float, torques: np.ndarray) -> Command:
    """A torque history (n, 3) at equal times, linear in between."""
    plan = np.zeros((len(torques), 10))
    plan[:, :3] = torques
    return Command(
        OPEN_LOOP, 0.0, 0.0, 0.0, parameters.inertia, parameters.initial, 0, table_step, plan
    )


def start_state(parameters: Parameters) -> np.ndarray:
    """State (16,) at the start: at rest, wheels at rest."""
    return np.r_[parameters.initial, np.zeros(6), *parameters.state]


def run(
    parameters: Parameters,
    model: Plant,
    command: Command,
    duration: float,
    step: float,
    every: float = 0.1,
) -> pd.DataFrame:
    """Fly from the start; rows about every so many seconds, with the columns `COLUMNS`.

    The steps are such that the last row is the end.
    """
    between = max(1, round(every / step))
    steps = between * max(1, round(duration / step / between))
    record = integrate(start_state(parameters), model, command, steps, duration / steps, between)
    return pd.DataFrame(record, columns=list(COLUMNS))


def angles_deg(table: pd.DataFrame) -> np.ndarray:
    """Roll, pitch and yaw (n, 3), deg."""
    q = table[["q_1", "q_2", "q_3", "q_4"]].to_numpy()
    return np.degrees([roll_pitch_yaw(row) for row in q])


def usage_pct(table: pd.DataFrame, parameters: Parameters) -> tuple[np.ndarray, np.ndarray]:
    """Torque and momentum of each wheel (n, 3), percent of the limits."""
    torque = table[["u_x", "u_y", "u_z"]].to_numpy() / parameters.torque
    momentum = table[["h_x", "h_y", "h_z"]].to_numpy() / parameters.momentum
    return 100.0 * torque, 100.0 * momentum
