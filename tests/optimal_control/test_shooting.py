"""Multiple shooting in numbers: against the same functions in CasADi's symbols, and differences."""

import warnings

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.runge_kutta import integrate, step_function
from smallsat.optimal_control.shooting import (
    Interval,
    ShootingArc,
    end_conditions,
    shooting_numbers,
)

STEPS, COUNT = 5, 3


def rate(s, x, p):
    """A driven pendulum; what it is driven with is the second parameter."""
    return [x[1], -p[0] * ca.sin(x[0]) + p[1] * ca.cos(s)]


def conditions(end):
    return [end[0] ** 2 + end[1], end[1] - 0.5]


@pytest.fixture(scope="module")
def pendulum():
    """Numbers of three intervals, by the nodes but the first and a parameter of all of them."""
    step = step_function(rate, 2, 2)
    everything = np.eye(2 * COUNT + 1)
    everything[-1] *= 0.7
    intervals = []
    for k in range(COUNT):
        taken = everything[[2 * k, 2 * k + 1, -1, -1]]
        taken[2] = 0.0
        intervals.append(
            Interval(
                matrix=taken[:, 2:],
                offset=taken[:, :2] @ [0.3, 0.0] + [0.0, 0.0, 1.3, 0.0],
                starts=k + np.arange(STEPS) / STEPS,
                lengths=np.full(STEPS, 1.0 / STEPS),
            )
        )
    return shooting_numbers(ShootingArc(step), intervals, end_conditions(2, conditions))


@pytest.fixture(scope="module")
def symbolic():
    step, z = step_function(rate, 2, 2), ca.MX.sym("z", 2 * COUNT - 1)
    nodes = [ca.DM([0.3, 0.0]), z[:2], z[2:4]]
    ends = [integrate(step, node, ca.vertcat(1.3, 0.7 * z[-1]), k, k + 1, STEPS)
            for k, node in enumerate(nodes)]  # fmt: skip
    values = ca.vertcat(ends[0] - nodes[1], ends[1] - nodes[2], *conditions(ends[2]))
    return ca.Function("f", [z], [values, ca.jacobian(values, z)])


Z = np.array([0.2, -0.1, 0.5, 0.4, 0.9])


def test_gaps_and_their_jacobian_are_those_of_the_symbols(pendulum, symbolic):
    """Values to 1e-15, derivatives to 1e-13: times of steps round otherwise."""
    values, jacobian = (output.full() for output in symbolic(Z))
    np.testing.assert_allclose(pendulum[0](Z), values.ravel(), rtol=0, atol=1e-15)
    np.testing.assert_allclose(pendulum[1](Z), jacobian, rtol=0, atol=1e-13)


def test_derivatives_are_those_of_differences(pendulum):
    """Central differences, to 1e-9."""
    h = 1e-5
    columns = [
        (pendulum[0](Z + h * unit) - pendulum[0](Z - h * unit)) / (2 * h) for unit in np.eye(len(Z))
    ]
    np.testing.assert_allclose(pendulum[1](Z), np.transpose(columns), rtol=0, atol=1e-9)


def test_an_arc_that_overflows_is_no_number_and_no_warning(pendulum):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not np.isfinite(pendulum[0](1e200 * Z)).all()
