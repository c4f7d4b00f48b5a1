"""Closed forms of relative motion against the matrix exponential."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from smallsat.dynamics.orbits.clohessy_wiltshire import (
    costate_transition,
    held_input_rows,
    rate_matrix,
    transition,
)

N = 2.0 * np.pi / 10800.0
times = st.floats(min_value=0.01, max_value=20000.0)


@given(times)
def test_transition_is_the_exponential(t):
    """To 1e-10 of the largest entry, up to two orbits."""
    exact = expm(rate_matrix(N) * t)
    assert np.abs(transition(N, t) - exact).max() < 1e-10 * np.abs(exact).max()


@given(times)
def test_costates_keep_their_product_with_the_state(t):
    """The product p . x is constant along a free flight: 1e-9 of its terms."""
    x, p = np.arange(1.0, 7.0), np.linspace(-1.0, 2.0, 6)
    later = (costate_transition(N, t) @ p) * (transition(N, t) @ x)
    assert later.sum() == pytest.approx(p @ x, abs=1e-9 * np.abs(later).max())


@given(st.floats(min_value=1.0, max_value=2000.0))
def test_a_held_thrust_is_the_integral(t):
    """Against the exponential of the system with the thrust as states, to 1e-9 of each entry."""
    larger = np.zeros((9, 9))
    larger[:6, :6], larger[3:6, 6:] = rate_matrix(N), np.eye(3)
    exact = expm(larger * t)[:6, 6:]
    error = np.abs(np.array(held_input_rows(N, t)) - exact)
    assert error.max() < 1e-9 * np.abs(exact).max()
