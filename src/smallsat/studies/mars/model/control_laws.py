"""Control laws for tracking a reference frame: the document's, and more advanced ones.

All work on the tracking error of Section VIII.A, sigma_B/R and omega_B/R, and know nominal moments
of inertia. Feed-forward and integral are those of Schaub and Junkins, Analytical Mechanics of Space
Systems, Chapter 8, the document's Ref. [2].
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are

from smallsat.dynamics.attitude.mrp import mrp_rate
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, cross, scaled

# The laws, by their places among the names.
PD, FEED_FORWARD, INTEGRAL, LQR, SLIDING_MODE = range(5)
LAWS = ("PD", "feed-forward", "integral", "LQR", "sliding mode")


class Law(NamedTuple):
    """A law and its gains, in SI units and radians.

    Attributes
    ----------
    kind
        Place in `LAWS`.
    k, p
        Gains of attitude and rate, N m and N m s.
    inertia
        Nominal principal moments, shape (3,), kg m^2.
    integral_time
        Time constant with which the integral follows, s.
    integral_limit
        Largest size of a component of the integral, N m s.
    lqr
        Gains of the regulator, shape (3, 2): of attitude, N m, and rate, N m s, by axis.
    slope, reaching, layer
        Of the sliding mode: rate that it asks for by attitude, rad/s; acceleration towards the
        surface, rad/s^2; distance from it within which that acceleration is smaller, rad/s.
    """

    kind: int
    k: float
    p: float
    inertia: np.ndarray
    integral_time: float
    integral_limit: float
    lqr: np.ndarray
    slope: float
    reaching: float
    layer: float


@compiled
def commanded_torque(
    law, attitude_error, rate_error, rate, reference_acceleration, wheels, integral
):
    """Torque on the body, N m, that a law commands.

    Parameters
    ----------
    law : Law
    attitude_error, rate_error : shape (3,)
        sigma_B/R, the short set, and omega_B/R, rad/s, in body components.
    rate : shape (3,)
        omega_B/N, rad/s.
    reference_acceleration : shape (3,)
        Inertial derivative of omega_R/N in body components, rad/s^2.
    wheels : shape (3,)
        Momentum of the wheels relative to the body, N m s, zero without wheels.
    integral : shape (3,)
        Integral of K sigma_B/R over time, N m s.
    """
    inertia = law.inertia
    proportional = axpy(-law.p, rate_error, scaled(-law.k, attitude_error))
    if law.kind == PD:
        return proportional
    # What turns the body with the reference and against its own gyroscopic torque.
    reference_rate = axpy(-1.0, rate_error, rate)
    follow = axpy(-1.0, cross(rate, reference_rate), reference_acceleration)
    momentum = axpy(1.0, wheels, _times_moments(inertia, rate))
    forward = axpy(1.0, cross(rate, momentum), _times_moments(inertia, follow))
    if law.kind == FEED_FORWARD:
        return axpy(1.0, forward, proportional)
    if law.kind == INTEGRAL:
        # z = K integral of sigma + I omega_B/R, with P K_I = 1 / integral_time.
        z = axpy(1.0, integral, _times_moments(inertia, rate_error))
        return axpy(-1.0 / law.integral_time, z, axpy(1.0, forward, proportional))
    if law.kind == LQR:
        gains = law.lqr
        return (
            forward[0] - gains[0, 0] * attitude_error[0] - gains[0, 1] * rate_error[0],
            forward[1] - gains[1, 0] * attitude_error[1] - gains[1, 1] * rate_error[1],
            forward[2] - gains[2, 0] * attitude_error[2] - gains[2, 1] * rate_error[2],
        )
    # Crassidis and Markley, Journal of Guidance, Control, and Dynamics 19 (1996): on the surface
    # omega_B/R + slope sigma_B/R = 0 the error decays, and the boundary layer keeps it from
    # chattering.
    surface = axpy(law.slope, attitude_error, rate_error)
    drift = scaled(law.slope, mrp_rate(attitude_error, rate_error))
    reach = (
        drift[0] + law.reaching * _clipped(surface[0] / law.layer, 1.0),
        drift[1] + law.reaching * _clipped(surface[1] / law.layer, 1.0),
        drift[2] + law.reaching * _clipped(surface[2] / law.layer, 1.0),
    )
    return axpy(-1.0, _times_moments(inertia, reach), forward)


@compiled
def next_integral(law, integral, attitude_error, step):
    """The integral a step on, each component held within its limit."""
    grown = axpy(law.k * step, attitude_error, integral)
    limit = law.integral_limit
    return (_clipped(grown[0], limit), _clipped(grown[1], limit), _clipped(grown[2], limit))


@compiled
def _clipped(value, limit):
    return min(max(value, -limit), limit)


@compiled
def _times_moments(inertia, a):
    return (inertia[0] * a[0], inertia[1] * a[1], inertia[2] * a[2])


def lqr_gains(
    inertia: np.ndarray, step: float, largest_sigma: float, largest_rate: float, torque: float
) -> np.ndarray:
    """Gains, shape (3, 2), of the regulator of each axis, linearised, with the torque held a step.

    The weights are one over the squares of the largest values that are asked for (Bryson's rule).

    Parameters
    ----------
    inertia
        Nominal principal moments, shape (3,), kg m^2.
    step
        For which a torque is held, s.
    largest_sigma, largest_rate, torque
        MRP, rate, rad/s, and torque, N m.
    """
    transition = np.array([[1.0, step / 4.0], [0.0, 1.0]])
    weights, cost = np.diag([largest_sigma**-2, largest_rate**-2]), np.array([[torque**-2]])
    rows = []
    for moment in inertia:
        control = np.array([[step**2 / 8.0], [step]]) / moment
        value = solve_discrete_are(transition, control, weights, cost)
        gain = np.linalg.solve(cost + control.T @ value @ control, control.T @ value @ transition)
        rows.append(gain[0])
    return np.array(rows)
