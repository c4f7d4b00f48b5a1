"""Gravity in spherical harmonics: a gradient, another implementation, Laplace, the poles."""

import heyoka as hy
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import assoc_legendre_p

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.environment.spherical_harmonics import acceleration, normalisation, terms
from smallsat.dynamics.orbits.kepler_orbits import acceleration as oblate

FULL = terms(egm96.COEFFICIENTS, 8, 8)
POINTS = st.tuples(
    st.floats(6.6e6, 7.5e6), st.floats(-np.pi / 2, np.pi / 2), st.floats(-np.pi, np.pi)
)


def cartesian(point):
    r, latitude, longitude = point
    return r * np.array(
        [
            np.cos(latitude) * np.cos(longitude),
            np.cos(latitude) * np.sin(longitude),
            np.sin(latitude),
        ]
    )


def gravity(position, table=FULL):
    return np.array(acceleration(*position, egm96.MU, egm96.RADIUS, table))


def potential(position, degree, order):
    """Textbook sum over Legendre functions of latitude and longitude, relative to no table here."""
    x, y, z = position
    r, longitude = np.sqrt(position @ position), np.arctan2(y, x)
    total = 1.0 + 0.0 * r
    for n, m, c, s in egm96.COEFFICIENTS:
        if n <= degree and m <= order:
            # SciPy's functions carry the phase (-1)^m, geodesy's do not.
            legendre = (-1) ** m * assoc_legendre_p(n, m, z / r)[0]
            wave = c * np.cos(m * longitude) + s * np.sin(m * longitude)
            total += (egm96.RADIUS / r) ** n * normalisation(n, m) * legendre * wave
    return egm96.MU / r * total


def test_coefficients_are_those_of_the_earth():
    """J2, J3 and the equator's ellipticity, known otherwise, and EGM2008 within 1.1e-9.

    The difference to EGM2008 is that between two models of the Earth (the largest, of 1.0e-9, is
    that of C20), four orders below the coefficients of degree 2 to 8 but for those near zero.
    """
    known = {(n, m): (c, s) for n, m, c, s in egm96.COEFFICIENTS}
    assert len(known) == sum(n + 1 for n in range(2, 9))
    assert -known[2, 0][0] * np.sqrt(5) == pytest.approx(1.0826e-3, rel=1e-4)
    assert -known[3, 0][0] * np.sqrt(7) == pytest.approx(-2.5327e-6, rel=1e-4)
    sectoral = np.hypot(*known[2, 2]) * normalisation(2, 2)
    assert sectoral == pytest.approx(1.8155e-6, rel=1e-4)
    newer = np.array(hy.model.get_egm2008_CS())[: len(known)]
    np.testing.assert_allclose(list(known.values()), newer, rtol=0, atol=1.1e-9)
    assert pytest.approx(hy.model.get_egm2008_mu()) == egm96.MU
    assert pytest.approx(hy.model.get_egm2008_a()) == egm96.RADIUS


@pytest.mark.parametrize(("degree", "order"), [(0, 0), (2, 0), (2, 2), (5, 3), (8, 0), (8, 8)])
def test_is_the_gradient_of_the_textbook_potential(degree, order):
    """Central differences of fourth order, to 1e-9 m/s^2 (their own error at steps of 2 km)."""
    table = terms(egm96.COEFFICIENTS, degree, order)
    h = 2e3
    for latitude in (-1.2, -0.3, 0.0, 0.9, 1.5):
        p = cartesian((6.7e6, latitude, 2.0 * latitude))
        slope = [
            sum(
                w * (potential(p + k * e, degree, order) - potential(p - k * e, degree, order))
                for k, w in ((h, 8.0), (2 * h, -1.0))
            )
            / (12 * h)
            for e in np.eye(3)
        ]
        np.testing.assert_allclose(gravity(p, table), slope, rtol=0, atol=1e-9)


def test_agrees_with_another_implementation():
    """Heyoka's expression with these coefficients at 200 points, to 1e-14 of the acceleration."""
    rows = [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], *([c, s] for _, _, c, s in egm96.COEFFICIENTS)]
    xyz = hy.make_vars("x", "y", "z")
    other = hy.cfunc(hy.model.sh_gravity_acc(xyz, rows, mu=egm96.MU, a=egm96.RADIUS), xyz)
    directions = np.random.default_rng(5).normal(size=(200, 3))
    points = 6.8e6 * directions / np.linalg.norm(directions, axis=1)[:, None]
    ours = np.array([gravity(p) for p in points])
    np.testing.assert_allclose(ours, other(points.T.copy()).T, rtol=0, atol=1e-13)


@given(POINTS)
def test_is_harmonic_and_free_of_rotation(point):
    """Laplace's equation, and symmetric derivatives: to 1e-6 of the gradient, 2.6e-6 1/s^2."""
    p, h = cartesian(point), 5e3
    jacobian = np.array(
        [
            (8 * (gravity(p + h * e) - gravity(p - h * e)) - gravity(p + 2 * h * e)
             + gravity(p - 2 * h * e)) / (12 * h)
            for e in np.eye(3)
        ]
    )  # fmt: skip
    scale = egm96.MU / point[0] ** 3
    assert abs(np.trace(jacobian)) < 1e-6 * scale
    assert abs(jacobian - jacobian.T).max() < 1e-6 * scale


@given(POINTS)
def test_degree_two_is_the_oblate_field(point):
    """Against the closed form that the other studies use, to 1e-14 of the acceleration."""
    j2 = -egm96.COEFFICIENTS[0][2] * np.sqrt(5)
    expected = oblate(cartesian(point), egm96.MU, egm96.RADIUS, j2)
    table = terms(egm96.COEFFICIENTS, 2, 0)
    np.testing.assert_allclose(gravity(cartesian(point), table), expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("pole", [1.0, -1.0])
def test_poles_are_points_like_any_other(pole):
    """The field at a pole is the mean of two points 1 m to its sides, to 1e-12 m/s^2."""
    side = np.array([1.0, 0.0, 0.0])
    p = np.array([0.0, 0.0, pole * 6.7e6])
    mean = 0.5 * (gravity(p + side) + gravity(p - side))
    np.testing.assert_allclose(gravity(p), mean, rtol=0, atol=1e-12)


def test_bad_size_is_refused():
    """An order above the degree, and a degree that the coefficients do not reach."""
    with pytest.raises(ValueError, match="order 3 exceeds the degree 2"):
        terms(egm96.COEFFICIENTS, 2, 3)
    with pytest.raises(ValueError, match="degree 9"):
        terms(egm96.COEFFICIENTS, 9, 0)
