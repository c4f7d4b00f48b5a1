"""The linear model with oblateness: where it predicts better than without, and where not."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import least_squares

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.orbits.kepler_orbits import Elements, acceleration, state_of
from smallsat.studies.rendezvous.model.prediction_j2 import J2, oblateness, schweighart_sedwick
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state

N = 0.00114
RADIUS = (egm96.MU / N**2) ** (1 / 3)
PERIOD = 2 * np.pi / N
OFF = np.zeros(3)
# Small, so that the curvature of the orbit does not hide the oblateness.
MOTIONS = {
    "ellipse": np.array([14.0, -158.0, 0.0, -0.09, -2 * N * 14.0, 0.0]),
    "radial": np.array([10.0, 0.0, 0.0, 0.0, -2 * N * 10.0, 0.0]),
    "normal": np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.05]),
}


@pytest.fixture(scope="module")
def oblate(surroundings):
    return surroundings(density_factor=0.0, gravity_degree=2, gravity_order=0)


def moved(environment, target, relative, times):
    pair = pair_from_relative(target, relative)
    for duration in np.diff(times, prepend=0.0):
        advance(pair, 0.0, duration, OFF, OFF, environment)
        yield pair


def near_circular(environment, inclination, latitude):
    """Target whose distance has no first harmonic over an orbit; its mean turning rate, rad/s."""
    r, v = state_of(Elements(RADIUS, 0.0, inclination, 0.0, 0.0, latitude), egm96.MU)
    times = np.arange(1, 73) * PERIOD / 72

    def state(change):
        along, radial = change
        speed = np.linalg.norm(v)
        return np.concatenate([r, v * (1 + along) + radial * speed * r / np.linalg.norm(r)])

    def harmonic(change):
        path = [p[0].copy() for p in moved(environment, state(change), np.zeros(6), times)]
        distance = np.linalg.norm(np.array(path)[:, :3], axis=1)
        return [(distance * wave(N * times)).mean() for wave in (np.cos, np.sin)]

    target = state(least_squares(harmonic, [0.0, 0.0], x_scale=1e-4, diff_step=1e-5).x)
    path = np.array([p[0].copy() for p in moved(environment, target, np.zeros(6), times)])
    momentum = np.linalg.norm(np.cross(path[:, :3], path[:, 3:]), axis=1)
    return target, (momentum / (path[:, :3] ** 2).sum(axis=1)).mean()


def prediction_errors(environment, inclination, horizon, latitudes):
    """Root mean square error, m, of Clohessy-Wiltshire and with oblateness, for each motion.

    Both know the frame's own rate: the mean motion of the first is the target's mean rate.
    """
    found = {name: [] for name in MOTIONS}
    for latitude in latitudes:
        target, rate = near_circular(environment, inclination, latitude)
        plain = schweighart_sedwick(rate, 0.5 * np.arccos(-1 / 3), RADIUS)
        n = rate / np.sqrt(1.0 + oblateness(inclination, RADIUS))
        models = [expm(m * horizon) for m in (plain, schweighart_sedwick(n, inclination, RADIUS))]
        for name, start in MOTIONS.items():
            (pair,) = moved(environment, target, start, [horizon])
            position = relative_state(pair)[:3]
            found[name].append([((position - (m @ start)[:3]) ** 2).sum() for m in models])
    return {name: np.sqrt(np.mean(errors, axis=0)) for name, errors in found.items()}


def test_vanishing_oblateness_is_clohessy_wiltshire():
    """At cos 2i = -1/3 the matrix is that of Eq. 2.2, to rounding."""
    expected = np.zeros((6, 6))
    expected[:3, 3:] = np.eye(3)
    expected[3, 0], expected[3, 4], expected[4, 3], expected[5, 2] = (
        3 * N * N,
        2 * N,
        -2 * N,
        -N * N,
    )
    matrix = schweighart_sedwick(N, 0.5 * np.arccos(-1 / 3), RADIUS)
    np.testing.assert_allclose(matrix, expected, rtol=1e-14, atol=1e-20)
    assert pytest.approx(1.0826e-3, rel=1e-4) == J2


def test_exact_on_an_equatorial_circular_orbit():
    """Against the field's own gradient in the frame of the exact circular orbit, to 1e-5."""
    h = 10.0
    gradient = np.array(
        [
            np.subtract(
                acceleration(RADIUS * np.eye(3)[0] + h * e, egm96.MU, egm96.RADIUS, J2),
                acceleration(RADIUS * np.eye(3)[0] - h * e, egm96.MU, egm96.RADIUS, J2),
            )
            / (2 * h)
            for e in np.eye(3)
        ]
    )
    pull = -acceleration(RADIUS * np.eye(3)[0], egm96.MU, egm96.RADIUS, J2)[0]
    rate = np.sqrt(pull / RADIUS)
    expected = gradient + np.diag([rate**2, rate**2, 0.0])
    matrix = schweighart_sedwick(N, 0.0, RADIUS)
    # 1e-5: the terms in the square of J2.
    np.testing.assert_allclose(matrix[3:, :3], expected, atol=1e-5 * N**2)
    assert matrix[3, 4] == pytest.approx(2 * rate, rel=1e-5)


@pytest.mark.parametrize("horizon", [900.0, PERIOD], ids=["15 min", "orbit"])
def test_far_better_on_an_equatorial_orbit(oblate, horizon):
    """In and out of the plane, over a horizon of 30 steps and over an orbit: by a factor of 5."""
    for name, (plain, better) in prediction_errors(oblate, 0.0, horizon, [0.0]).items():
        assert better < 0.2 * plain, name


def test_somewhat_better_at_thirty_degrees(oblate):
    """Over an orbit, mean over the starts on it: 11 % in and out of the plane, radially 61 %."""
    errors = prediction_errors(oblate, np.radians(30.0), PERIOD, np.arange(0, 2 * np.pi, np.pi / 4))
    gains = {name: 1.0 - better / plain for name, (plain, better) in errors.items()}
    assert gains == pytest.approx({"ellipse": 0.11, "radial": 0.61, "normal": 0.11}, abs=0.02)


def test_no_better_at_the_inclination_of_the_default(oblate):
    """At 51.6 deg: within 2 % of Clohessy-Wiltshire, in or out of the plane, either horizon.

    What is averaged away is what is wrong there, several times over.
    """
    for horizon in (900.0, PERIOD):
        latitudes = np.arange(0, 2 * np.pi, np.pi / 4)
        errors = prediction_errors(oblate, np.radians(51.6), horizon, latitudes)
        for name, (plain, better) in errors.items():
            assert better == pytest.approx(plain, rel=0.02), name
