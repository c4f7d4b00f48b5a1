"""The prediction model and its discretisation."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.guidance.law import settings
from smallsat.studies.rendezvous.model.prediction import terminal_weight, transition

N = 0.00114


@pytest.mark.parametrize("duration", [1.0, 5.0, 30.0, 60.0, 900.0])
def test_transition_is_what_an_integrator_gives(duration):
    """Dormand and Prince's method of order 8 at 1e-12, from six states."""
    matrix = rate_matrix(N)
    scale = np.array([100.0] * 3 + [0.1] * 3)
    for start in np.diag(scale):
        end = solve_ivp(
            lambda t, x: matrix @ x, (0.0, duration), start, "DOP853", rtol=1e-12, atol=1e-12
        ).y[:, -1]
        assert np.abs((transition(matrix, duration) @ start - end) / scale).max() < 1e-9


@given(st.floats(1.0, 10000.0))
def test_transition_in_closed_form(duration):
    """The known solution of the equations, e.g. Curtis (7.53), written out here."""
    t, c, s = N * duration, np.cos(N * duration), np.sin(N * duration)
    closed = np.array(
        [
            [4 - 3 * c, 0, 0, s / N, 2 * (1 - c) / N, 0],
            [6 * (s - t), 1, 0, -2 * (1 - c) / N, (4 * s - 3 * t) / N, 0],
            [0, 0, c, 0, 0, s / N],
            [3 * N * s, 0, 0, c, 2 * s, 0],
            [-6 * N * (1 - c), 0, 0, -2 * s, 4 * c - 3, 0],
            [0, 0, -N * s, 0, 0, c],
        ]
    )
    found = transition(rate_matrix(N), duration)
    scale = np.array([1.0] * 3 + [1 / N] * 3)
    assert np.allclose(found * scale[:, None] / scale, closed * scale[:, None] / scale, atol=1e-9)


def test_stable_ellipse_closes():
    """From (x, y) with velocity (n y / 2, -2 n x) the chaser is back after one orbit."""
    start = np.array([140.0, -1580.0, 60.0, -N * 790.0, -2 * N * 140.0, 0.0])
    end = transition(rate_matrix(N), 2 * np.pi / N) @ start
    assert np.allclose(end, start, atol=1e-8)


def test_an_impulse_is_the_limit_of_a_short_strong_push():
    """B = A [0; I] (3.1): a push of a hundredth of a second comes within 1e-4 of it."""
    matrix, duration, push = rate_matrix(N), 30.0, 0.01
    held = np.zeros((9, 9))
    held[:6, :6] = matrix
    held[3:6, 6:] = np.eye(3) / push
    after = scipy.linalg.expm(held * push)[:6, 6:]
    pushed = transition(matrix, duration - push) @ after
    impulse = transition(matrix, duration)[:, 3:]
    assert np.abs(pushed - impulse).max() / np.abs(impulse).max() < 2e-4


@pytest.mark.parametrize("phase", range(3))
def test_terminal_weight_solves_the_riccati_equation(law, phase):
    """Residual of P = A'PA - A'PB (R + B'PB)^-1 B'PA + Q, relative."""
    a = transition(rate_matrix(N), law.sample_times[phase])
    b, q, r = a[:, 3:], np.diag(law.state_weights[phase]), np.diag(law.control_weights[phase])
    p = terminal_weight(a, law.state_weights[phase], law.control_weights[phase])
    gain = np.linalg.solve(r + b.T @ p @ b, b.T @ p @ a)
    residual = a.T @ p @ a - a.T @ p @ b @ gain + q - p
    assert np.abs(residual).max() < 1e-9 * np.abs(p).max()


def test_bound_is_a_velocity_change(law):
    """Scaled, a control of 1 changes the velocity by the bound: 0.5 N for 5 s on 14 kg."""
    record = settings([law])[0]
    assert record["scales"][0, 3] == record["control_bounds"][0] == 0.1786
    assert pytest.approx(0.1786, abs=5e-5) == 0.5 * 5.0 / 14.0
    assert pytest.approx(0.0357, abs=5e-5) == 0.5 * 1.0 / 14.0
