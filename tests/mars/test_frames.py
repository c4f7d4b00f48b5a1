"""Reference frames: orthonormal, pointing where they should, turning as their rates say."""

import numpy as np
import pytest

from smallsat.dynamics.orbits.circular_orbits import position, velocity
from smallsat.studies.mars.model.frames import (
    SUN_FRAME,
    gmo_frame,
    gmo_frame_rate,
    nadir_frame,
    nadir_frame_rate,
)

TIMES = np.linspace(0.0, 88_620.0, 40)


def derivative_rate(frame, time, h=0.05):
    """Inertial rate by a central difference: [NR] d[RN]/dt is minus the cross-product matrix."""
    change = (np.array(frame(time + h)) - np.array(frame(time - h))) / (2 * h)
    tilde = -np.array(frame(time)).T @ change
    return np.array([tilde[2, 1], tilde[0, 2], tilde[1, 0]])


@pytest.mark.parametrize("time", TIMES)
def test_frames_are_rotations(parameters, time):
    """Orthonormal and right-handed, to 1e-13."""
    frames = (
        SUN_FRAME,
        nadir_frame(parameters.lmo, time),
        gmo_frame(parameters.lmo, parameters.gmo, time),
    )
    for frame in map(np.array, frames):
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), rtol=0, atol=1e-13)
        assert np.linalg.det(frame) == pytest.approx(1.0)


@pytest.mark.parametrize("time", TIMES)
def test_frames_point_where_they_should(parameters, time):
    """b3 to the Sun, b1 to Mars's centre with b2 along the velocity, -b1 to the mothercraft."""
    r, v = np.array(position(parameters.lmo, time)), np.array(velocity(parameters.lmo, time))
    np.testing.assert_allclose(SUN_FRAME[2], [0.0, 1.0, 0.0])
    nadir = np.array(nadir_frame(parameters.lmo, time))
    np.testing.assert_allclose(nadir[0], -r / np.linalg.norm(r), atol=1e-13)
    np.testing.assert_allclose(nadir[1], v / np.linalg.norm(v), atol=1e-13)
    sight = np.array(position(parameters.gmo, time)) - r
    to_gmo = np.array(gmo_frame(parameters.lmo, parameters.gmo, time))
    np.testing.assert_allclose(-to_gmo[0], sight / np.linalg.norm(sight), atol=1e-13)
    assert to_gmo[1, 2] == 0.0


@pytest.mark.parametrize("time", TIMES[:10])
def test_nadir_rate(parameters, time):
    """The closed form against a central difference, to 1e-6 of its size."""
    expected = derivative_rate(lambda t: nadir_frame(parameters.lmo, t), time)
    rate = nadir_frame_rate(parameters.lmo, time)
    np.testing.assert_allclose(rate, expected, rtol=0, atol=1e-6 * parameters.lmo.rate)


@pytest.mark.parametrize("time", TIMES[:10])
def test_gmo_rate_approaches_the_derivative(parameters, time):
    """The forward difference's error falls in proportion to its span, to 10 %."""
    exact = derivative_rate(lambda t: gmo_frame(parameters.lmo, parameters.gmo, t), time)
    errors = [
        np.linalg.norm(gmo_frame_rate(parameters.lmo, parameters.gmo, time, span) - exact)
        for span in (2.0, 1.0)
    ]
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
