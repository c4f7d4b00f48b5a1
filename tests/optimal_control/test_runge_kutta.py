"""The symbolic integrator of order 8, against problems with known solutions."""

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.runge_kutta import (
    NODES,
    STAGE_MATRIX,
    WEIGHTS,
    integrate,
    step_function,
)


def test_tableau_is_consistent():
    """Row sums are the nodes and the weights sum to one, to rounding."""
    np.testing.assert_allclose(STAGE_MATRIX.sum(axis=1), NODES, atol=1e-14)
    assert WEIGHTS.sum() == pytest.approx(1.0, abs=1e-14)


def test_order_is_eight():
    """Halving the step of a non-autonomous oscillator divides the error by 2^8 (within 20 %)."""

    def rate(s, x, p):
        return [x[1], -p[0] * x[0] + ca.cos(s)]

    step = step_function(rate, 2, 1)
    # x'' + 4 x = cos s with x(0) = 1, x'(0) = 0 has x = (2 cos 2s + cos s) / 3.
    end = 2.0
    exact = (2 * np.cos(2 * end) + np.cos(end)) / 3
    errors = [
        abs(float(integrate(step, ca.DM([1.0, 0.0]), 4.0, 0.0, end, n)[0]) - exact) for n in (8, 16)
    ]
    assert errors[0] / errors[1] == pytest.approx(2**8, rel=0.2)


def test_derivatives_are_exact():
    """The symbolic derivative by the parameter equals the analytic one of exp(p s) to 1e-9."""
    step = step_function(lambda s, x, p: [p[0] * x[0]], 1, 1)
    p = ca.SX.sym("p")
    end = integrate(step, ca.SX(1.0), p, 0.0, 1.0, 10)
    derivative = ca.Function("d", [p], [ca.jacobian(end, p)])
    assert float(derivative(0.7)) == pytest.approx(np.exp(0.7), abs=1e-9)
