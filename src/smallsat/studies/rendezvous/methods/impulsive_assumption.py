"""What the guidance's impulses leave out: that thrusters take time (section 2.1.2)."""

import numpy as np

from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import (
    Environment,
    advance,
    pair_from_relative,
    relative_state,
)


def impulsive_error(
    target: np.ndarray,
    relative: np.ndarray,
    delta_v: np.ndarray,
    duration: float,
    mass: float,
    force: float,
    environment: Environment,
) -> np.ndarray:
    """Relative state after an impulse less that after pulses of the same momentum, shape (6,).

    Both start together. A pulse acts as an impulse at its middle: for a velocity change dv that
    takes a time T the position is dv T/2 ahead, but for the curvature of the motion, and T is
    itself proportional to dv.

    Parameters
    ----------
    target, relative : shape (6,)
        The target's inertial state, and the relative state before the control; m and m/s.
    delta_v : shape (3,)
        Velocity change in the target's LVLH frame, m/s.
    duration : float
        From the start of the control, s.
    mass, force : float
        Of the chaser, kg, and of each thruster, N.
    environment : Environment
    """
    burn, on_times, coast = np.empty(3), np.empty(3), np.zeros(3)
    thrust_acceleration(delta_v, mass, force, burn)
    pulse_on_times(delta_v, mass, force, 0.0, on_times)
    pushed = relative + np.concatenate([np.zeros(3), delta_v])
    impulsive = pair_from_relative(target, pushed)
    pulsed = pair_from_relative(target, relative)
    advance(impulsive, 0.0, duration, burn, coast, environment)
    advance(pulsed, 0.0, duration, burn, on_times, environment)
    return relative_state(impulsive) - relative_state(pulsed)
