"""Random initial states: their distribution, their independence of the set's size, the ellipse."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.stats import kstest

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.monte_carlo.initial_states import (
    IN_PLANE,
    ISOTROPIC,
    Distribution,
    initial_state,
    initial_states,
    quadrant,
    stable_velocity,
)

THESIS = Distribution(150.0, 2500.0, 0.5, IN_PLANE)
LIFTED = THESIS._replace(direction=ISOTROPIC)
SEED = 42


def test_distribution(mean_motion):
    """3000 states: distance, angle and velocity errors by Kolmogorov's test at 1e-4 each.

    In the plane or not; the height's cosine is uniform for the isotropic ones.
    """
    for distribution in (THESIS, LIFTED):
        states = initial_states(3000, SEED, distribution, mean_motion)
        position, velocity = states[:, :3], states[:, 3:]
        distance = np.linalg.norm(position, axis=1)
        angle = np.arctan2(position[:, 1], position[:, 0])
        error = velocity - stable_velocity(position, mean_motion)
        found = [
            kstest((distance - 150.0) / 2350.0, "uniform"),
            kstest((angle + np.pi) / (2 * np.pi), "uniform"),
            *(kstest(error[:, k] / 0.5, "norm") for k in range(3)),
        ]
        if distribution is LIFTED:
            found.append(kstest(0.5 + 0.5 * position[:, 2] / distance, "uniform"))
        else:
            assert np.all(position[:, 2] == 0.0)
        assert min(test.pvalue for test in found) > 1e-4
        assert (
            abs(np.corrcoef(np.column_stack([distance, angle, error]).T) - np.eye(5)).max() < 0.08
        )


@given(st.integers(0, 2**31), st.integers(0, 10**6))
def test_a_state_is_its_own(seed, sample):
    """Drawn alone or twice it is the same; its neighbour, or the next seed's, is another."""
    state = initial_state(sample, seed, THESIS, 1.1e-3)
    assert np.array_equal(state, initial_state(sample, seed, THESIS, 1.1e-3))
    assert not np.array_equal(state, initial_state(sample + 1, seed, THESIS, 1.1e-3))
    assert not np.array_equal(state, initial_state(sample, seed + 1, THESIS, 1.1e-3))


def test_a_set_begins_with_the_smaller_set(mean_motion):
    """125 of 500: the same rows."""
    few, many = (initial_states(n, SEED, THESIS, mean_motion) for n in (125, 500))
    assert np.array_equal(many[:125], few)


def test_lifted_states_share_distance_and_errors(mean_motion):
    """The two readings differ by the direction alone."""
    flat, lifted = (initial_states(20, SEED, d, mean_motion) for d in (THESIS, LIFTED))
    np.testing.assert_allclose(
        np.linalg.norm(lifted[:, :3], axis=1), np.linalg.norm(flat[:, :3], axis=1), rtol=1e-13
    )
    np.testing.assert_array_equal(lifted[:, 5], flat[:, 5])
    assert np.ptp(lifted[:, 2]) > 500.0


@given(st.tuples(*[st.floats(-3e3, 3e3)] * 3).map(np.array), st.floats(9e-4, 1.2e-3))
def test_stable_velocity_closes_the_orbit(position, n):
    """By the linear equations the state comes back after an orbit, to 1e-6 m."""
    a = np.zeros((6, 6))
    a[:3, 3:] = np.eye(3)
    a[3, 0], a[3, 4], a[4, 3], a[5, 2] = 3 * n * n, 2 * n, -2 * n, -n * n
    state = np.concatenate([position, stable_velocity(position, n)])
    # In units of the mean motion, which the matrix exponential needs for its accuracy.
    unit = np.repeat([1.0, n], 3)
    orbit = expm((a * unit / unit[:, None]) * 2 * np.pi / n)
    np.testing.assert_allclose((orbit @ (state / unit))[:3], position, rtol=0, atol=1e-6)


@pytest.mark.parametrize(("n", "printed"), [(0.001133, True), (0.001145, True), (0.001147, False)])
def test_printed_start_is_on_the_stable_ellipse(n, printed):
    """Table 3.2's velocity comes out to its digits for mean motions of 0.001133 to 0.001145."""
    velocity = stable_velocity(np.array([140.0, -1580.0, 60.0]), n)
    assert ([f"{v:.2f}" for v in velocity[:2]] == ["-0.90", "-0.32"]) == printed


def test_quadrants():
    """Four points, one a quadrant, the last two on the side away from the port."""
    states = np.zeros((4, 6))
    states[:, :2] = [[1.0, 2.0], [-1.0, 2.0], [-1.0, -2.0], [1.0, -2.0]]
    assert quadrant(states).tolist() == [1, 2, 3, 4]


def test_streams_are_independent():
    """Numbers of 200 streams side by side are uncorrelated with their neighbours', to 5 sigma."""
    numbers = np.array([stream(SEED, k).standard_normal(400) for k in range(200)])
    products = (numbers[:-1] * numbers[1:]).ravel()
    assert abs(products.mean()) < 5.0 / np.sqrt(products.size)
