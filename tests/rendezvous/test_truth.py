"""The two bodies' motion: other integrators, the linear equations, invariants, frames."""

import heyoka as hy
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from smallsat.dynamics.environment import egm96
from smallsat.studies.rendezvous.model.truth import (
    advance,
    drag,
    pair_from_relative,
    rate_of_change,
    relative_state,
)

START = np.array([140.0, -1580.0, 60.0, -0.90, -0.32, 0.0])
NO_THRUST = np.zeros(3)
DURATION = 1744.0
# A front and a back alone: no panel turns from lee to luff, so the force is smooth.
ENDS = np.array([[0.02, 0.0, 1.0, 0.0], [0.02, 0.0, -1.0, 0.0]])


def flown(environment, target, relative, durations, thrust=NO_THRUST, on=NO_THRUST, time=0.0):
    pair = pair_from_relative(target, relative)
    for duration in durations:
        advance(pair, time, duration, thrust, on, environment)
        time += duration
    return pair


@pytest.fixture(scope="module")
def taylor(surroundings):
    """Heyoka's Taylor integrator at 1e-18 of one body: (environment, body, state, times) -> states.

    Its equations are written apart from the package: heyoka's own spherical harmonics, and drag on
    a front alone. The parameters are the drag's coefficient over the mass and the thrust.
    """
    environment = surroundings()
    r, v = hy.make_vars("x", "y", "z"), hy.make_vars("vx", "vy", "vz")
    x, y, z = r
    angle = environment.earth_angle + environment.earth_rate * hy.time
    c, s = hy.cos(angle), hy.sin(angle)
    rows = [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], *([c, s] for _, _, c, s in egm96.COEFFICIENTS)]
    gx, gy, gz = hy.model.sh_gravity_acc(
        [c * x + s * y, c * y - s * x, z], rows, mu=egm96.MU, a=egm96.RADIUS
    )
    wind = [v[0] + environment.earth_rate * y, v[1] - environment.earth_rate * x, v[2]]
    distance = hy.sqrt(x**2 + y**2 + z**2)
    radial = [q / distance for q in r]
    level = [
        v[i] - sum(a * b for a, b in zip(radial, v, strict=True)) * radial[i] for i in range(3)
    ]
    speed = hy.sqrt(sum(q**2 for q in level))
    facing = 0.02 * sum(a * b for a, b in zip(level, wind, strict=True)) / speed
    height = (distance - environment.density_radius) / environment.scale_height
    factor = -0.5 * environment.density * hy.exp(-height) * hy.par[0] * facing
    gravity = [c * gx - s * gy, s * gx + c * gy, gz]
    equations = list(zip(r, v, strict=True)) + [
        (v[i], gravity[i] + factor * wind[i] + hy.par[1 + i]) for i in range(3)
    ]
    integrator = hy.taylor_adaptive(
        equations, [0.0] * 6, pars=[0.0] * 4, tol=1e-18, compact_mode=True
    )

    def fly(state, start, end, coefficient, thrust=NO_THRUST):
        integrator.time = start
        integrator.state[:] = state
        integrator.pars[:] = [coefficient, *thrust]
        outcome = integrator.propagate_until(end)[0]
        assert outcome == hy.taylor_outcome.time_limit
        return integrator.state.copy()

    return fly


def smooth(environment):
    return environment._replace(panels=np.stack([ENDS, ENDS]))


@pytest.mark.parametrize(
    ("step", "duration", "metres"),
    [(30.0, DURATION, 2e-6), (10.0, DURATION, 5e-7), (30.0, 12e3, 5e-6)],
)
def test_agrees_with_a_taylor_integrator(taylor, surroundings, target, step, duration, metres):
    """8x8 field and drag, a manoeuvre and 200 minutes: relative position to 2e-6 and 5e-6 m."""
    environment = smooth(surroundings(step_s=step))
    pair = pair_from_relative(target, START)
    expected = np.array([taylor(pair[i], 0.0, duration, environment.drag[i]) for i in range(2)])
    found = flown(environment, target, START, [duration])
    difference = relative_state(found) - relative_state(expected)
    assert abs(difference[:3]).max() < metres
    assert abs(difference[3:]).max() < 1e-2 * metres


def test_finite_pulses_agree_with_a_taylor_integrator(taylor, surroundings, target):
    """Three burns of different lengths in a step of 30 s: to 1e-7 m, and not without the burns."""
    environment = smooth(surroundings())
    thrust, on = np.array([0.0357, -0.0357, 0.0357]), np.array([5.0, 2.3, 0.0])
    pair = pair_from_relative(target, START)
    axes = np.array([pair_from_relative(target, e)[1] - pair[0] for e in np.eye(6)])[:3, :3]
    expected, time = pair.copy(), 100.0
    for end, burning in ((2.3, (1, 1, 0)), (5.0, (1, 0, 0)), (30.0, (0, 0, 0))):
        force = (thrust * burning) @ axes
        expected = np.array(
            [
                taylor(expected[0], time, 100.0 + end, environment.drag[0]),
                taylor(expected[1], time, 100.0 + end, environment.drag[1], force),
            ]
        )
        time = 100.0 + end
    found = flown(environment, target, START, [30.0], thrust, on, 100.0)
    difference = relative_state(found) - relative_state(expected)
    assert abs(difference[:3]).max() < 1e-7
    assert abs(difference[3:]).max() < 1e-9
    without = relative_state(flown(environment, target, START, [30.0], time=100.0))
    assert abs(without - relative_state(expected))[0] > 1.0


def test_whole_body_agrees_with_an_adaptive_integrator(surroundings, target):
    """All six panels, whose drag has kinks: SciPy's DOP853 at 1e-13 and steps of 2 s, to 1e-5 m."""
    environment = surroundings()
    pair = pair_from_relative(target, START)

    def rates(time, y):
        found = np.empty((2, 6))
        rate_of_change(time, y.reshape(2, 6), (0.0, 0.0, 0.0), environment, found)
        return found.ravel()

    solution = solve_ivp(
        rates, (0.0, DURATION), pair.ravel(), "DOP853", rtol=1e-13, atol=1e-8, max_step=2.0
    )
    expected = solution.y[:, -1].reshape(2, 6)
    found = flown(environment, target, START, [DURATION])
    np.testing.assert_allclose(
        relative_state(found)[:3], relative_state(expected)[:3], rtol=0, atol=1e-5
    )


def test_order_of_the_method_is_six(surroundings, target):
    """Halving steps of 240 s divides the error by 2^6 or a little more, in a smooth field."""
    errors = []
    exact = flown(surroundings(density_factor=0.0, step_s=15.0), target, START, [3840.0])
    for step in (240.0, 120.0, 60.0):
        environment = surroundings(density_factor=0.0, step_s=step)
        errors.append(abs(flown(environment, target, START, [3840.0]) - exact)[:, :3].max())
    ratios = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all((ratios > 5.8) & (ratios < 7.5)), ratios


def test_steps_do_not_matter_to_the_caller(surroundings, target):
    """A duration in one call or in many, equal or not, to 1e-5 m: the whole drag included."""
    environment = surroundings()
    whole = relative_state(flown(environment, target, START, [1800.0]))
    pieces = relative_state(flown(environment, target, START, [5.0] * 100 + [20.0] * 50 + [300.0]))
    np.testing.assert_allclose(pieces[:3], whole[:3], rtol=0, atol=1e-5)


def test_zonal_field_keeps_energy_and_momentum(surroundings, target):
    """Without drag, energy and the axial angular momentum of both bodies, to 2e-12 over 2 h."""
    environment = surroundings(density_factor=0.0, gravity_degree=2, gravity_order=0)
    j2 = -egm96.COEFFICIENTS[0][2] * np.sqrt(5)

    def invariants(pair):
        r, v = pair[:, :3], pair[:, 3:]
        distance = np.linalg.norm(r, axis=1)
        legendre = 1.5 * (r[:, 2] / distance) ** 2 - 0.5
        flat = 1.0 - j2 * (egm96.RADIUS / distance) ** 2 * legendre
        energy = 0.5 * (v**2).sum(axis=1) - egm96.MU / distance * flat
        return np.array([energy, r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0]])

    before = invariants(pair_from_relative(target, START))
    after = invariants(flown(environment, target, START, [7200.0]))
    np.testing.assert_allclose(after, before, rtol=2e-12)


def clohessy_wiltshire(n, duration):
    """Transition matrix of Eqs. 2.1 and 2.2."""
    a = np.zeros((6, 6))
    a[:3, 3:] = np.eye(3)
    a[3, 0], a[3, 4], a[4, 3], a[5, 2] = 3 * n * n, 2 * n, -2 * n, -n * n
    return expm(a * duration)


def test_small_separations_follow_the_linear_equations(surroundings, target, mean_motion):
    """In the central field the error of Clohessy-Wiltshire falls with the separation squared.

    Measured after a quarter of an orbit, over separations from 1.6 km down to 25 m: at 1.6 km it is
    metres, and each halving divides it by four within 3 %.
    """
    environment = surroundings(density_factor=0.0, gravity_degree=0, gravity_order=0)
    duration = 0.5 * np.pi / mean_motion
    transition = clohessy_wiltshire(mean_motion, duration)
    errors = []
    for scale in 0.5 ** np.arange(7):
        found = relative_state(flown(environment, target, scale * START, [duration]))
        errors.append(np.linalg.norm((found - transition @ (scale * START))[:3]))
    assert 0.1 < errors[0] < 10.0
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.05)


states = st.tuples(
    *[st.floats(-3e3, 3e3)] * 3,
    *[st.floats(-3.0, 3.0)] * 3,
).map(np.array)


@given(states)
def test_relative_state_and_back(target, relative):
    """Round trip to the rounding of inertial positions, 1e-8 m and 1e-11 m/s."""
    back = relative_state(pair_from_relative(target, relative))
    np.testing.assert_allclose(back[:3], relative[:3], rtol=0, atol=1e-8)
    np.testing.assert_allclose(back[3:], relative[3:], rtol=0, atol=2e-11)


def test_relative_velocity_is_the_derivative_of_the_position(surroundings, target):
    """By central differences along the motion, to 5e-7 m/s in the central field.

    In the oblate field the plane turns, which the velocity leaves out: at most 3 mm/s.
    """
    h = 1.0
    for degree, order, bound in ((0, 0, 5e-7), (2, 0, 3e-3)):
        environment = surroundings(density_factor=0.0, gravity_degree=degree, gravity_order=order)
        worst = 0.0
        for start in np.linspace(0.0, 5400.0, 10):
            pair = flown(environment, target, START, [start + 1e-9])
            now = relative_state(pair)
            ends = []
            for sign in (1.0, -1.0):
                # Backwards in time: the mirrored velocities, the Earth's rotation does not matter.
                other = pair * [1, 1, 1, sign, sign, sign]
                advance(other, 0.0, h, NO_THRUST, NO_THRUST, environment)
                ends.append(relative_state(other * [1, 1, 1, sign, sign, sign])[:3])
            worst = max(worst, abs((ends[0] - ends[1]) / (2 * h) - now[3:]).max())
        assert worst < bound
    assert worst > 1e-4


def test_panels_face_the_wind(surroundings):
    """Eq. 5.5 by hand for a body flying across still air: its front alone, to rounding."""
    environment = surroundings()._replace(earth_rate=0.0)
    r, v = environment.density_radius, 7.7e3
    found = drag(r, 0.0, 0.0, 0.0, v, 0.0, environment.panels[1], 1.4 / 14.0, environment)
    front = 0.2 * 0.1
    expected = -0.5 * environment.density * v * v * 1.4 / 14.0 * front
    np.testing.assert_allclose(found, [0.0, expected, 0.0], rtol=1e-14)
    tilted = drag(r, 0.0, 0.0, 100.0, v, 0.0, environment.panels[1], 1.4 / 14.0, environment)
    assert tilted[1] < expected


def test_drag_takes_the_target_back(surroundings, target):
    """The target, whose coefficient is larger, sinks below a chaser released with it: cm to m."""
    relative = [
        relative_state(flown(surroundings(density_factor=f), target, np.zeros(6), [1800.0]))
        for f in (0.0, 1.0)
    ]
    np.testing.assert_allclose(relative[0], 0.0, atol=1e-8)
    assert relative[1][0] > 0.0
    assert 0.02 < np.linalg.norm(relative[1][:3]) < 2.0
