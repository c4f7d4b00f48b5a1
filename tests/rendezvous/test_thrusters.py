"""Pulses: on-times, the minimum impulse bit, and the error of taking them for impulses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state

MASS, FORCE = 14.0, 0.5
START = np.array([140.0, -1580.0, 60.0, -0.90, -0.32, 0.0])
commands = st.tuples(*[st.floats(-0.2, 0.2)] * 3).map(np.array)


def pulses(delta_v, minimum=0.0, flown_from=0.0):
    on_times, burn = np.empty(3), np.empty(3)
    pulse_on_times(delta_v, MASS, FORCE, minimum, flown_from, on_times)
    thrust_acceleration(delta_v, MASS, FORCE, burn)
    return on_times, burn


def impulsive_error(target, delta_v, duration, environment):
    """Relative state after an impulse less that after pulses of the same momentum, (6,).

    Both start together. A pulse acts as an impulse at its middle: for a velocity change dv that
    takes a time T the position is dv T/2 ahead, but for the curvature of the motion, and T is
    itself proportional to dv.
    """
    on_times, burn = pulses(delta_v)
    impulsive = pair_from_relative(target, START + np.concatenate([np.zeros(3), delta_v]))
    pulsed = pair_from_relative(target, START)
    advance(impulsive, 0.0, duration, burn, np.zeros(3), environment)
    advance(pulsed, 0.0, duration, burn, on_times, environment)
    return relative_state(impulsive) - relative_state(pulsed)


def test_largest_controls_are_five_seconds_and_one():
    """The bounds of Table 3.1 as velocity changes take 5 s and 1 s of thrust, to their digits."""
    on_times, _ = pulses(np.array([0.1786, -0.1786, 0.0357]))
    np.testing.assert_allclose(on_times, [5.0, 5.0, 1.0], rtol=2e-3)


@given(commands, st.floats(0.0, 1.0))
def test_momentum_is_what_was_commanded_or_nothing(delta_v, minimum):
    """On-time times acceleration is the command, to rounding, from the minimum impulse bit on."""
    on_times, burn = pulses(delta_v, minimum, minimum)
    needed = MASS * abs(delta_v) / FORCE
    impulse = np.where(needed >= minimum, delta_v, 0.0)
    np.testing.assert_allclose(on_times * burn, impulse, rtol=1e-15, atol=0)
    assert np.all((on_times == 0.0) | (on_times >= minimum))


@given(commands, st.floats(0.0, 1.0))
def test_rounded_momentum_is_off_by_half_a_bit_at_most(delta_v, minimum):
    """Above the bit it is what was commanded, below the nearer of nothing and the bit."""
    on_times, burn = pulses(delta_v, minimum, 0.5 * minimum)
    needed, bit = MASS * abs(delta_v) / FORCE, FORCE * minimum / MASS
    off = np.abs(on_times * burn - delta_v)
    assert np.all(off <= np.where(needed >= minimum, 1e-15, 0.5 * bit * (1.0 + 1e-12)))
    assert np.all((on_times == 0.0) | (on_times >= minimum))


def test_impulsive_error_is_half_the_burn(surroundings, target):
    """In a step of 30 s: the impulse is ahead by dv T/2, to 1 %, along either axis of the plane.

    For the largest control of 0.1786 m/s, which burns for 5 s, that is 0.45 m; it grows with the
    square of the control. The velocity is off by less than 2 mm/s.
    """
    for axis in range(2):
        for size in (0.1786, 0.0893, -0.0357):
            delta_v = size * np.eye(3)[axis]
            burn = MASS * abs(size) / FORCE
            error = impulsive_error(target, delta_v, 30.0, surroundings())
            assert error[axis] == pytest.approx(0.5 * size * burn, rel=0.01)
            assert abs(error[3:]).max() < 2e-3


def test_no_command_no_error(surroundings, target):
    """Nothing burns, nothing differs, to the rounding of inertial positions."""
    error = impulsive_error(target, np.zeros(3), 30.0, surroundings())
    np.testing.assert_allclose(error, 0.0, atol=1e-12)
