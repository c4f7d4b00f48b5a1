"""The rigid body: equations against plain NumPy, invariants, and the integrator's order."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from smallsat.dynamics.attitude.rigid_body import (
    angular_acceleration,
    angular_momentum,
    kinetic_energy,
    runge_kutta_step,
)

INERTIA = np.array([10.0, 5.0, 7.5])
NO_SWITCH = 1e9
vector = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)


def plain_step(state, torque, step):
    """One Runge-Kutta step with matrices, as textbooks write it."""

    def tilde(v):
        return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

    def rate_of(y):
        sigma, rate = y[:3], y[3:]
        matrix = (1 - sigma @ sigma) * np.eye(3) + 2 * tilde(sigma) + 2 * np.outer(sigma, sigma)
        inertia = np.diag(INERTIA)
        return np.r_[
            0.25 * matrix @ rate,
            np.linalg.solve(inertia, torque - tilde(rate) @ inertia @ rate),
        ]

    k1 = rate_of(state)
    k2 = rate_of(state + step / 2 * k1)
    k3 = rate_of(state + step / 2 * k2)
    k4 = rate_of(state + step * k3)
    return state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def propagate(state, torque, step, steps, switch=1.0):
    sigma, rate = tuple(state[:3]), tuple(state[3:])
    for _ in range(steps):
        sigma, rate = runge_kutta_step(sigma, rate, INERTIA, torque, step, switch)
    return np.array(sigma), np.array(rate)


@given(vector, vector, vector)
def test_one_step_is_the_textbooks(sigma, rate, torque):
    """The compiled step against matrices in plain NumPy, to 1e-12."""
    new = np.concatenate(runge_kutta_step(sigma, rate, INERTIA, torque, 1.0, NO_SWITCH))
    expected = plain_step(np.r_[sigma, rate], torque, 1.0)
    np.testing.assert_allclose(new, expected, rtol=0, atol=1e-12)


@given(vector, vector)
def test_acceleration_balances_momentum(rate, torque):
    """Euler's equation: the momentum's change in inertial axes is the torque, to 1e-12."""
    change = INERTIA * angular_acceleration(INERTIA, rate, torque)
    gyroscopic = np.cross(rate, angular_momentum(INERTIA, rate))
    np.testing.assert_allclose(change + gyroscopic, torque, rtol=0, atol=1e-12)
    assert kinetic_energy(INERTIA, rate) == pytest.approx(0.5 * np.sum(INERTIA * rate**2))


def test_momentum_and_energy_are_conserved_without_torque():
    """1000 s at 0.1 s, switching sets on the way: both to 1e-11 of their size."""
    state = np.array([0.3, -0.4, 0.5, 0.02, 0.03, -0.04])
    sigma, rate = propagate(state, np.zeros(3), 0.1, 10_000)
    before = Rotation.from_mrp(state[:3]).apply(INERTIA * state[3:])
    after = Rotation.from_mrp(sigma).apply(INERTIA * rate)
    np.testing.assert_allclose(after, before, rtol=0, atol=1e-11 * np.linalg.norm(before))
    energy = kinetic_energy(INERTIA, state[3:])
    assert kinetic_energy(INERTIA, rate) == pytest.approx(energy, rel=1e-11)


def test_order_is_four():
    """Halving the step divides the error by 16, to 10 %, against a step 16 times smaller."""
    state = np.array([0.1, 0.0, 0.0, 0.1, 0.2, -0.1])
    torque = np.array([0.01, -0.01, 0.02])

    def end(step):
        return np.concatenate(propagate(state, torque, step, round(20.0 / step), NO_SWITCH))

    exact = end(1.0 / 32)
    errors = [np.linalg.norm(end(step) - exact) for step in (1.0, 0.5)]
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)


def test_attitude_switches_to_its_shadow_set_above_the_norm_only():
    """A step across norm 1 switches at threshold 1 and does not at a higher one; same attitude."""
    sigma, rate = (0.0, 0.0, 0.999), (0.0, 0.0, 0.1)
    switched, _ = runge_kutta_step(sigma, rate, INERTIA, np.zeros(3), 1.0, 1.0)
    kept, _ = runge_kutta_step(sigma, rate, INERTIA, np.zeros(3), 1.0, 1.1)
    assert switched[2] < 0.0 < kept[2]
    one, other = Rotation.from_mrp(switched), Rotation.from_mrp(kept)
    assert (one.inv() * other).magnitude() < 1e-7
