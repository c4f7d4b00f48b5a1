"""The equations of the transfer against their own invariants and against each other."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from smallsat.studies.transfer.model.problem import TransferProblem

COAST = {"mu": 1.0, "thrust": 1e-300, "exhaust_speed": 1.0}
ORBITS = {"initial_radius": 1.0, "final_radius": 1.5, "initial_mass": 1.0}
finite = st.floats(-2.0, 2.0)


@pytest.fixture(scope="module")
def problem(config):
    return TransferProblem.of(config.transfer.problem)


@given(st.floats(0.6, 1.4), st.floats(-0.3, 0.3), st.floats(0.7, 1.2))
def test_coasting_keeps_energy_and_angular_momentum(r, v_r, v_theta):
    """Without thrust both are constant to 1e-9 over two time units, whatever the start."""
    problem = TransferProblem(**COAST, **ORBITS)
    start = np.array([r, 0.0, v_r, v_theta, 1.0])
    end = solve_ivp(
        lambda _, x: problem.state_rate(x, 0.0, 1.0),
        (0, 2),
        start,
        rtol=1e-11,
        atol=1e-12,
        method="DOP853",
    ).y[:, -1]

    def energy(x):
        return 0.5 * (x[2] ** 2 + x[3] ** 2) - 1 / x[0]

    assert energy(end) == pytest.approx(energy(start), abs=1e-9)
    assert end[0] * end[3] == pytest.approx(r * v_theta, abs=1e-9)


@given(st.lists(finite, min_size=5, max_size=5).filter(lambda c: c[2] ** 2 + c[3] ** 2 > 1e-2))
def test_costate_rates_are_the_gradient_of_the_hamiltonian(costate):
    """Equations 29 to 33 against automatic differentiation of equation 28, to 1e-10.

    At the optimal control the Hamiltonian's derivative by beta vanishes, so the total and the
    partial derivative by the state agree.
    """
    problem = TransferProblem(1.0, 0.1405, 1.8658344, **ORBITS)
    x, c = ca.SX.sym("x", 5), ca.SX.sym("c", 5)
    gradient = ca.Function("g", [x, c], [ca.gradient(problem.hamiltonian(x, c), x)])
    state = np.array([1.2, 0.4, 0.1, 0.9, 0.85])
    rates = problem.extremal_rate(state, np.array(costate))[5:]
    np.testing.assert_allclose(rates, -gradient(state, costate).full().ravel(), atol=1e-10)


def test_mass_follows_from_time(problem):
    """The closed form of the mass equals the integrated one to 1e-12."""
    end = solve_ivp(
        lambda _, x: problem.state_rate(x, 0.0, 1.0), (0, 3), problem.initial_state, rtol=1e-11
    ).y[:, -1]
    assert end[4] == pytest.approx(problem.final_mass(3.0), abs=1e-12)
