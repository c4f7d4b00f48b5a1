"""A Kalman filter for the relative state, in place of the raw measurements (section 5.5).

The model is the guidance's own: the linear equations with impulses that are known up to the
thrust's amplitude error. Every measurement is the whole relative state with independent normal
errors (Eqs. 5.6 and 5.7), so that it is taken in component by component, without an inverse.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled

# Of a variance before any axis is measured: less than this share of it is rounding.
ROUNDING = 1e-12


class FilterModel(NamedTuple):
    """What the filter takes its errors to be, each a standard deviation.

    Attributes
    ----------
    position_error, velocity_error
        Error of a measurement, m and m/s, along each axis.
    amplitude_error
        Error of the thrust, as a fraction of an impulse.
    gradient_error
        Error of the linear equations' acceleration, as a fraction of n^2 times the distance: what
        the oblateness, the curvature and the frame leave.
    other_acceleration
        What is left at no distance, such as differential drag, m/s^2.
    mean_motion
        n, rad/s.
    """

    position_error: float
    velocity_error: float
    amplitude_error: float
    gradient_error: float
    other_acceleration: float
    mean_motion: float


@compiled
def begin(model, covariance):
    """Fill the covariance (6, 6) of a first measurement, which is the first estimate."""
    for i in range(6):
        for j in range(6):
            covariance[i, j] = 0.0
        covariance[i, i] = model.position_error**2 if i < 3 else model.velocity_error**2


@compiled
def predict(estimate, covariance, delta_v, transition, duration, model):
    """Move the estimate (6,) and covariance (6, 6) over a step, in place.

    Parameters
    ----------
    estimate, covariance
        Before the control.
    delta_v : shape (3,)
        Commanded impulse at the start of the step, m/s.
    transition : shape (6, 6)
        Transition matrix of the prediction model over the step.
    duration : float
        Length of the step, s.
    model : FilterModel

    The model's error is an acceleration that is constant over a step and independent between steps.
    """
    for k in range(3):
        estimate[3 + k] += delta_v[k]
        covariance[3 + k, 3 + k] += (model.amplitude_error * delta_v[k]) ** 2
    moved = np.zeros(6)
    half = np.zeros((6, 6))
    for i in range(6):
        for k in range(6):
            moved[i] += transition[i, k] * estimate[k]
            for j in range(6):
                half[i, j] += transition[i, k] * covariance[k, j]
    for i in range(6):
        estimate[i] = moved[i]
        for j in range(i + 1):
            total = 0.0
            for k in range(6):
                total += half[i, k] * transition[j, k]
            covariance[i, j] = covariance[j, i] = total
    distance = sqrt(estimate[0] ** 2 + estimate[1] ** 2 + estimate[2] ** 2)
    gradient = model.gradient_error * model.mean_motion**2 * distance
    variance = (gradient * gradient + model.other_acceleration**2) * duration * duration
    for k in range(3):
        covariance[k, k] += 0.25 * variance * duration * duration
        covariance[k, 3 + k] += 0.5 * variance * duration
        covariance[3 + k, k] += 0.5 * variance * duration
        covariance[3 + k, 3 + k] += variance


@compiled
def update(estimate, covariance, measurement, model):
    """Correct estimate (6,) and covariance (6, 6) by a measurement (6,), in place.

    What the measurement of another axis has determined already, which measurements without error
    do, is taken as measured.
    """
    gain, prior = np.empty(6), np.diag(covariance).copy()
    for axis in range(6):
        noise = model.position_error**2 if axis < 3 else model.velocity_error**2
        innovation = measurement[axis] - estimate[axis]
        variance = covariance[axis, axis] + noise
        if variance <= ROUNDING * prior[axis]:
            estimate[axis] = measurement[axis]
            continue
        scale = 1.0 / variance
        for i in range(6):
            gain[i] = covariance[i, axis]
        for i in range(6):
            estimate[i] += gain[i] * scale * innovation
            for j in range(6):
                covariance[i, j] -= gain[i] * scale * gain[j]
