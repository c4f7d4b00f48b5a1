"""One closed loop for all control laws: limited wheels, gravity gradient, a body of any inertia.

As in the document the torque is computed at the start of a step and held over it, while the
classical Runge-Kutta method integrates the step.
"""

from typing import NamedTuple

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.mrp import mrp_rate, mrp_to_dcm, shadow
from smallsat.dynamics.attitude.rigid_body import weighted
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.environment.torques import gravity_gradient
from smallsat.dynamics.orbits.circular_orbits import position
from smallsat.dynamics.vectors import axpy, cross, dot, scaled, times
from smallsat.studies.mars.methods.simulation import (
    AUTOMATIC,
    START,
    reference,
    tracking_error,
)
from smallsat.studies.mars.model.control_laws import commanded_torque, next_integral
from smallsat.studies.mars.model.modes import pointing_mode

COLUMNS = (
    "time_s",
    *(f"{name}_{axis}" for name in ("sigma", "omega", "u", "h") for axis in "123"),
    "error_rad",
    "mode",
)


class Actuators(NamedTuple):
    """What makes the torque: wheels along the body's axes, or ideal ones without momentum.

    Attributes
    ----------
    carried
        1 for wheels, whose momentum takes part in the gyroscopic torque, or 0.
    torque, momentum
        Limits of each axis, N m and N m s; infinite for ideal ones.
    """

    carried: float
    torque: float
    momentum: float


class Setting(NamedTuple):
    """What a closed loop takes place in, in SI units and radians.

    Attributes
    ----------
    lmo, gmo
        Orbits of the nano-satellite and of the mothercraft.
    mu
        Of the planet, m^3/s^2, for the gravity gradient; 0 leaves it out.
    visibility
        Largest angle between the positions at which the mothercraft is visible.
    step, difference
        Control step, and finite difference of the reference's rates, s.
    """

    lmo: tuple
    gmo: tuple
    mu: float
    visibility: float
    step: float
    difference: float


@compiled
def simulate(law, actuators, setting, initial_state, inertia, command, steps):
    """Integrate a run and record it at the start of every step and at the end.

    Parameters
    ----------
    law : Law
    actuators : Actuators
    setting : Setting
    initial_state : ndarray, shape (6,)
        MRPs and rate of the body; wheels begin at rest.
    inertia : ndarray, shape (3,)
        True principal moments, kg m^2; the law has its own.
    command : int
        A pointing mode, or AUTOMATIC for the mission's.
    steps : int

    Returns
    -------
    ndarray, shape (steps + 1, 15)
        Columns as in `COLUMNS`: torque, error and mode are those computed at the row's time and
        held until the next; ``h`` is the momentum of the wheels, N m s.
    """
    out = np.empty((steps + 1, 15))
    sigma = (initial_state[0], initial_state[1], initial_state[2])
    rate = (initial_state[3], initial_state[4], initial_state[5])
    wheels = integral = (0.0, 0.0, 0.0)
    step = setting.step
    for k in range(steps + 1):
        time = START + k * step
        mode = command
        if command == AUTOMATIC:
            mode = pointing_mode(setting.lmo, setting.gmo, time, setting.visibility)
        span = setting.difference
        frame, frame_rate = reference(mode, setting.lmo, setting.gmo, time, span)
        _, later = reference(mode, setting.lmo, setting.gmo, time + span, span)
        acceleration = scaled(1.0 / span, axpy(-1.0, frame_rate, later))
        error, rate_error = tracking_error(sigma, rate, frame, frame_rate)
        if k > 0:
            integral = next_integral(law, integral, error, step)
        wanted = commanded_torque(
            law,
            error,
            rate_error,
            rate,
            times(mrp_to_dcm(sigma), acceleration),
            wheels,
            integral,
        )
        torque = (
            _possible(wanted[0], wheels[0], actuators, step),
            _possible(wanted[1], wheels[1], actuators, step),
            _possible(wanted[2], wheels[2], actuators, step),
        )
        out[k, 0] = time
        for i in range(3):
            out[k, 1 + i] = sigma[i]
            out[k, 4 + i] = rate[i]
            out[k, 7 + i] = torque[i]
            out[k, 10 + i] = wheels[i]
        out[k, 13] = 4.0 * np.arctan(np.sqrt(dot(error, error)))
        out[k, 14] = mode
        sigma, rate = _next(sigma, rate, wheels, torque, inertia, actuators, setting, time)
        wheels = axpy(-actuators.carried * step, torque, wheels)
    return out


@compiled
def _possible(wanted, wheel, actuators, step):
    """The torque of an axis within its limit, and such that its wheel keeps within its own."""
    torque = min(max(wanted, -actuators.torque), actuators.torque)
    least, most = (wheel - actuators.momentum) / step, (wheel + actuators.momentum) / step
    return min(max(torque, least), most)


@compiled
def _next(sigma, rate, wheels, torque, inertia, actuators, setting, time):
    """Attitude and rate a step on, of the short set."""
    half, step = 0.5 * setting.step, setting.step
    # The wheels take up the torque evenly over the step.
    given = scaled(-actuators.carried, torque)
    middle, end = axpy(half, given, wheels), axpy(step, given, wheels)
    s1, r1 = _rates(sigma, rate, wheels, torque, inertia, setting, time)
    s2, r2 = _rates(
        axpy(half, s1, sigma), axpy(half, r1, rate), middle, torque, inertia, setting, time + half
    )
    s3, r3 = _rates(
        axpy(half, s2, sigma), axpy(half, r2, rate), middle, torque, inertia, setting, time + half
    )
    s4, r4 = _rates(
        axpy(step, s3, sigma), axpy(step, r3, rate), end, torque, inertia, setting, time + step
    )
    new = weighted(sigma, step, s1, s2, s3, s4)
    if dot(new, new) > 1.0:
        new = shadow(new)
    return new, weighted(rate, step, r1, r2, r3, r4)


@compiled
def _rates(sigma, rate, wheels, torque, inertia, setting, time):
    """Rates of MRPs and body rate: I w' = u + L - w x (I w + h), with the gravity gradient L."""
    outer = torque
    if setting.mu > 0.0:
        tensor = ((inertia[0], 0.0, 0.0), (0.0, inertia[1], 0.0), (0.0, 0.0, inertia[2]))
        place = times(mrp_to_dcm(sigma), position(setting.lmo, time))
        outer = axpy(1.0, gravity_gradient(tensor, place, setting.mu), torque)
    momentum = (
        inertia[0] * rate[0] + wheels[0],
        inertia[1] * rate[1] + wheels[1],
        inertia[2] * rate[2] + wheels[2],
    )
    net = axpy(1.0, cross(momentum, rate), outer)
    return mrp_rate(sigma, rate), (
        net[0] / inertia[0],
        net[1] / inertia[1],
        net[2] / inertia[2],
    )


def as_table(record: np.ndarray) -> pd.DataFrame:
    """A run as a tidy table with the columns of `COLUMNS`."""
    return pd.DataFrame(record, columns=list(COLUMNS)).astype({"mode": int})
