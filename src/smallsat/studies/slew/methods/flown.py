"""Plans flown anew, by an integrator that has nothing in common with the optimisation."""

import numpy as np
from scipy.integrate import solve_ivp

from smallsat.dynamics.attitude.quaternions import (
    error_quaternion,
    quaternion_rate,
    quaternion_to_dcm,
    turn_angle,
)
from smallsat.dynamics.attitude.reaction_wheels import angular_acceleration
from smallsat.dynamics.environment.torques import gravity_gradient
from smallsat.dynamics.orbits.kepler_orbits import Elements, perifocal_frame
from smallsat.studies.slew.methods.guidance_problem import Model

# Six steps find the root of Kepler's equation to rounding up to this eccentricity, the others
# beyond it.
NEWTON_STEPS, NEWTON_STEPS_BEYOND = 6, 20
MODERATE = 0.7


def propagate_held(
    model: Model, initial: np.ndarray, durations: np.ndarray, controls: np.ndarray
) -> np.ndarray:
    """States (pieces + 1, 10), scaled, under controls (pieces, 3) held for the scaled durations.

    In SI units inside, with an adaptive method of order eight restarted at each piece, and Kepler's
    equation solved by Newton's method. Not a number from where the integration fails.
    """
    inverse = np.linalg.inv(model.inertia)
    carried = float(model.carried)
    y = np.r_[initial[:4], initial[4:7] / model.unit, initial[7:] * model.momentum_unit]
    states, time = [y], 0.0
    for duration, control in zip(durations, controls, strict=True):
        torque = control * model.torque

        # Counted from the start of the piece, which may be shorter than the spacing of later times.
        def rate(t: float, y: np.ndarray, torque=torque, began=time) -> np.ndarray:
            q = tuple(y[:4])
            outer = (0.0, 0.0, 0.0)
            if model.parameters is not None:
                r = _position(model.parameters.orbit, model.parameters.gravity.mu, began + t)
                body = np.array(quaternion_to_dcm(q)) @ r
                outer = gravity_gradient(model.inertia, body, model.parameters.gravity.mu)
            w = angular_acceleration(
                model.inertia, inverse, tuple(y[4:7]), tuple(y[7:]), tuple(torque), outer, carried
            )
            return np.r_[quaternion_rate(q, tuple(y[4:7])), w, torque]

        length = float(duration) * model.unit
        if length > 0.0 and np.isfinite(y).all() and np.isfinite(torque).all():
            solution = solve_ivp(rate, (0.0, length), y, method="DOP853", rtol=1e-11, atol=1e-13)
            y = solution.y[:, -1] if solution.success else np.full(10, np.nan)
            time += length
        elif length != 0.0:
            y = np.full(10, np.nan)
        states.append(y)
    table = np.array(states)
    table[:, 4:7] *= model.unit
    table[:, 7:] /= model.momentum_unit
    return table


def miss(model: Model, state: np.ndarray, target: np.ndarray) -> tuple[float, float]:
    """Angle, rad, from the target attitude, and body rate, rad/s, of a scaled state."""
    angle = turn_angle(error_quaternion(tuple(state[:4]), tuple(target)))
    return float(angle), float(np.linalg.norm(state[4:7])) / model.unit


def _position(orbit: Elements, mu: float, t: float) -> np.ndarray:
    a, e = orbit.semi_major_axis, orbit.eccentricity
    start = 2.0 * np.arctan2(
        np.sqrt(1.0 - e) * np.sin(orbit.true_anomaly / 2.0),
        np.sqrt(1.0 + e) * np.cos(orbit.true_anomaly / 2.0),
    )
    mean = start - e * np.sin(start) + np.sqrt(mu / a**3) * t
    anomaly = mean
    for _ in range(NEWTON_STEPS if e < MODERATE else NEWTON_STEPS_BEYOND):
        anomaly -= (anomaly - e * np.sin(anomaly) - mean) / (1.0 - e * np.cos(anomaly))
    place = np.array([np.cos(anomaly) - e, np.sqrt(1.0 - e * e) * np.sin(anomaly), 0.0])
    return a * place @ perifocal_frame(orbit)
