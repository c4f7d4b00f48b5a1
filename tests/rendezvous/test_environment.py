"""The surroundings that the configuration asks for."""

import numpy as np
import pytest

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.environment.torques import ATMOSPHERE, density


def test_target_starts_on_the_circular_orbit(target, mean_motion):
    """Its rate is the mean motion, its inclination 51.6 deg, its velocity level, to rounding."""
    r, v = target[:3], target[3:]
    h = np.cross(r, v)
    assert np.linalg.norm(h) / (r @ r) == pytest.approx(mean_motion, rel=1e-14)
    assert abs(r @ v) < 1e-3
    assert h[2] / np.linalg.norm(h) == pytest.approx(np.cos(np.radians(51.6)), rel=1e-12)


@pytest.mark.parametrize("rate", [0.00109, 0.00114, 0.00116])
def test_air_falls_off_as_in_the_model(surroundings, rate):
    """Density at the orbit and 5 km above it against the table's own exponential, to rounding."""
    environment = surroundings(rate)
    altitude = environment.density_radius - egm96.RADIUS
    assert environment.density == pytest.approx(density(altitude, ATMOSPHERE), rel=1e-14)
    above = environment.density * np.exp(-5e3 / environment.scale_height)
    assert above == pytest.approx(density(altitude + 5e3, ATMOSPHERE), rel=1e-12)


def test_panels_close_the_body(surroundings):
    """The normals are of length one and the areas along them add up to nothing; 0.22 m^2 in all."""
    for panels in surroundings().panels:
        np.testing.assert_allclose(panels[:, :1].T @ panels[:, 1:], 0.0, atol=1e-17)
        np.testing.assert_allclose((panels[:, 1:] ** 2).sum(axis=1), 1.0)
        assert panels[:, 0].sum() == pytest.approx(2 * (0.06 + 0.02 + 0.03))


def test_switches_leave_parts_out(surroundings):
    """No drag and the central field alone."""
    environment = surroundings(density_factor=0.0, gravity_degree=0, gravity_order=0)
    assert environment.density == 0.0
    assert environment.gravity.shape[:2] == (1, 1)
