"""A rigid body about its principal axes: equations of motion, invariants, one Runge-Kutta step.

Attitude is the MRP set of the body relative to the inertial frame, angular velocity is in body
components, rad/s, and ``inertia`` holds the principal moments, kg m^2. Vectors have the shape (3,).
"""

from smallsat.dynamics.attitude.mrp import mrp_rate, shadow
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, cross, dot


@compiled
def angular_momentum(inertia, rate):
    """Angular momentum in body components, kg m^2/s."""
    return (inertia[0] * rate[0], inertia[1] * rate[1], inertia[2] * rate[2])


@compiled
def kinetic_energy(inertia, rate):
    """Kinetic energy of rotation, J."""
    return 0.5 * dot(rate, angular_momentum(inertia, rate))


@compiled
def angular_acceleration(inertia, rate, torque):
    """Euler's equation: angular acceleration, rad/s^2, under a torque in body components, N m."""
    net = axpy(1.0, cross(angular_momentum(inertia, rate), rate), torque)
    return (net[0] / inertia[0], net[1] / inertia[1], net[2] / inertia[2])


@compiled
def runge_kutta_step(sigma, rate, inertia, torque, step, switch_norm):
    """One step of the classical Runge-Kutta method with the torque held over the step.

    Parameters
    ----------
    sigma, rate : shape (3,)
        Attitude and angular velocity at the start of the step.
    inertia, torque : shape (3,)
    step : float
        Seconds.
    switch_norm : float
        After the step the attitude goes over to its shadow set where its norm exceeds this.

    Returns
    -------
    sigma, rate : tuple, shape (3,)
        At the end of the step.
    """
    s1 = mrp_rate(sigma, rate)
    r1 = angular_acceleration(inertia, rate, torque)
    rate2 = axpy(0.5 * step, r1, rate)
    s2 = mrp_rate(axpy(0.5 * step, s1, sigma), rate2)
    r2 = angular_acceleration(inertia, rate2, torque)
    rate3 = axpy(0.5 * step, r2, rate)
    s3 = mrp_rate(axpy(0.5 * step, s2, sigma), rate3)
    r3 = angular_acceleration(inertia, rate3, torque)
    rate4 = axpy(step, r3, rate)
    s4 = mrp_rate(axpy(step, s3, sigma), rate4)
    r4 = angular_acceleration(inertia, rate4, torque)

    new = weighted(sigma, step, s1, s2, s3, s4)
    if dot(new, new) > switch_norm * switch_norm:
        new = shadow(new)
    return new, weighted(rate, step, r1, r2, r3, r4)


@compiled
def weighted(start, step, k1, k2, k3, k4):
    """Where a step of the classical Runge-Kutta method ends, by the rates of its four stages."""
    outer, inner = axpy(1.0, k4, k1), axpy(1.0, k3, k2)
    return axpy(step / 6.0, axpy(2.0, inner, outer), start)
