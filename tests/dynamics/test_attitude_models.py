"""Quaternions, the closed-form propagator, environment torques and orbits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from smallsat.dynamics.attitude.attitude_propagator import propagate, transition
from smallsat.dynamics.attitude.quaternions import (
    error_quaternion,
    product,
    quaternion_rate,
    quaternion_to_dcm,
    roll_pitch_yaw,
    turn_angle,
)
from smallsat.dynamics.environment.torques import ATMOSPHERE, density, gravity_gradient, panel_drag
from smallsat.dynamics.orbits.kepler_orbits import (
    Elements,
    Gravity,
    period,
    propagate_orbit,
    state_of,
)

EARTH = Gravity(3.986004418e14, 6378e3, 1.08262668e-3)


def random_quaternions(count):
    return Rotation.random(count, random_state=3).as_quat()


def test_quaternion_algebra_against_scipy():
    """Direction cosines, products and error turns of 50 random attitudes, to 1e-14."""
    p, q = random_quaternions(50), random_quaternions(100)[50:]
    for a, b in zip(p, q, strict=True):
        first, second = Rotation.from_quat(a), Rotation.from_quat(b)
        np.testing.assert_allclose(quaternion_to_dcm(tuple(a)), first.as_matrix().T, atol=1e-14)
        both = Rotation.from_quat(product(tuple(a), tuple(b)))
        np.testing.assert_allclose(both.as_matrix(), (first * second).as_matrix(), atol=1e-14)
        angle = turn_angle(error_quaternion(tuple(b), tuple(a)))
        assert angle == pytest.approx((first.inv() * second).magnitude(), abs=1e-12)


def test_roll_pitch_yaw_against_scipy():
    """The angles of the sequence yaw, pitch, roll of 50 random attitudes, to 1e-12 rad."""
    for q in random_quaternions(50):
        yaw, pitch, roll = Rotation.from_quat(q).as_euler("ZYX")
        np.testing.assert_allclose(roll_pitch_yaw(tuple(q)), (roll, pitch, yaw), atol=1e-12)


def test_transition_is_exact_for_a_constant_rate():
    """Against scipy's rotation vector, to 1e-14, no turn and a tiny one included."""
    for turn in ((0.3, -0.2, 0.5), (1e-9, 0.0, 2e-9), (0.0, 0.0, 0.0)):
        q = tuple(random_quaternions(1)[0])
        expected = Rotation.from_quat(q) * Rotation.from_rotvec(turn)
        found = Rotation.from_quat(transition(q, turn))
        np.testing.assert_allclose(found.as_matrix(), expected.as_matrix(), atol=1e-14)


def test_propagator_is_of_second_order():
    """Rates about a moving axis, against an adaptive integrator: error over 40 s falls by four."""

    def rate(t):
        return np.array([0.05 * np.sin(0.2 * t), 0.03 * np.cos(0.1 * t), 0.04])

    start = (0.0, 0.0, 0.0, 1.0)
    exact = solve_ivp(
        lambda t, q: quaternion_rate(tuple(q), tuple(rate(t))),
        (0.0, 40.0),
        start,
        rtol=1e-12,
        atol=1e-14,
    ).y[:, -1]
    errors = []
    for step in (1.0, 0.5):
        rates = np.array([rate(t) for t in np.arange(0.0, 40.0 + step / 2, step)])
        found = propagate(np.array(start), rates, step)[-1]
        errors.append(turn_angle(error_quaternion(tuple(found), tuple(exact))))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_gravity_gradient_of_a_full_tensor():
    """Against point masses: the torque of the tidal forces on six masses, to 1e-6 of itself."""
    generator = np.random.default_rng(1)
    places = generator.normal(size=(6, 3))
    masses = generator.uniform(0.5, 2.0, size=6)
    places -= masses @ places / masses.sum()
    inertia = sum(
        m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(masses, places, strict=True)
    )
    r = 7e6 * np.array([0.6, -0.48, 0.64])
    exact = np.zeros(3)
    for m, p in zip(masses, places, strict=True):
        # The field's gradient, by hand, keeps what the difference of two large forces would lose.
        unit = r / np.linalg.norm(r)
        tide = EARTH.mu / np.linalg.norm(r) ** 3 * (3.0 * unit * (unit @ p) - p)
        exact += np.cross(p, m * tide)
    found = np.array(gravity_gradient(inertia, r, EARTH.mu))
    np.testing.assert_allclose(found, exact, atol=1e-6 * np.linalg.norm(exact))


def test_drag_on_one_panel():
    """Force times lever by hand; a panel that faces away feels nothing."""
    panels = np.array([[2.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0], [2.0, -1.0, 0.0, 0.0, 0.0, 9.0, 0.0]])
    rho, speed = 1e-12, 7500.0
    torque = panel_drag(panels, (speed, 0.0, 0.0), rho, 2.2)
    force = 0.5 * rho * 2.2 * 2.0 * speed**2
    np.testing.assert_allclose(torque, (0.0, 0.0, 0.1 * force), rtol=1e-12)


def test_density_meets_its_table_and_falls():
    """At the base altitudes the table's values; never rising with altitude."""
    for base, rho, _ in ATMOSPHERE:
        assert density(1e3 * base, ATMOSPHERE) == pytest.approx(rho, rel=1e-12)
    heights = np.linspace(150e3, 1000e3, 300)
    values = [density(h, ATMOSPHERE) for h in heights]
    assert np.all(np.diff(values) < 0.0)


def test_orbit_returns_after_a_period_and_keeps_energy():
    """Two-body: the state after a period to 1 m and 1 mm/s; with J2, the drift of the node."""
    elements = Elements(7000e3, 0.01, np.radians(50.0), 0.3, 0.7, 0.2)
    r, v = state_of(elements, EARTH.mu)
    around = period(elements.semi_major_axis, EARTH.mu)
    end = propagate_orbit(r, v, EARTH._replace(j2=0.0), np.array([0.0, around]))[-1]
    np.testing.assert_allclose(end[:3], r, atol=1.0)
    np.testing.assert_allclose(end[3:], v, atol=1e-3)

    turns = 5
    state = propagate_orbit(r, v, EARTH, np.array([0.0, turns * around]))[-1]
    normal = np.cross(state[:3], state[3:])
    node = np.arctan2(normal[0], -normal[1])
    semilatus = elements.semi_major_axis * (1 - elements.eccentricity**2)
    drift = -1.5 * EARTH.j2 * (EARTH.radius / semilatus) ** 2 * np.cos(elements.inclination)
    expected = elements.raan + 2 * np.pi * turns * drift
    assert node == pytest.approx(expected, abs=2e-4)
