"""Circular orbits: frames, and velocity as the derivative of position."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from smallsat.dynamics.orbits.circular_orbits import (
    CircularOrbit,
    hill_frame,
    orbit_frame,
    position,
    velocity,
)

angle = st.floats(0.0, 2.0 * np.pi)
orbits = st.builds(
    CircularOrbit, st.floats(3e6, 3e7), angle, st.floats(0.0, np.pi), angle, st.floats(1e-5, 1e-3)
)
times = st.floats(0.0, 1e5)


@given(orbits, times)
def test_orbit_frame_is_the_3_1_3_rotation(orbit, time):
    """Against scipy's Euler angles, to 1e-13; hence orthonormal and right-handed."""
    angles = [orbit.raan, orbit.inclination, orbit.argument_of_latitude + orbit.rate * time]
    expected = Rotation.from_euler("ZXZ", angles).as_matrix().T
    np.testing.assert_allclose(orbit_frame(orbit, time), expected, rtol=0, atol=1e-13)


@given(orbits, times)
def test_velocity_is_the_derivative_of_position(orbit, time):
    """Against a central difference, to 1e-6 of the speed."""
    h = 1e-3 / orbit.rate
    by_difference = (np.array(position(orbit, time + h)) - position(orbit, time - h)) / (2 * h)
    speed = orbit.radius * orbit.rate
    np.testing.assert_allclose(velocity(orbit, time), by_difference, rtol=0, atol=1e-6 * speed)


@given(orbits, times)
def test_hill_frame_is_the_orbit_frame(orbit, time):
    """Both definitions of the frame agree to 1e-13."""
    hill = hill_frame(position(orbit, time), velocity(orbit, time))
    np.testing.assert_allclose(hill, orbit_frame(orbit, time), rtol=0, atol=1e-13)
