"""Both solvers on a program whose solution is known by hand."""

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram, SlsqpSolver


@pytest.fixture
def program():
    # The point of the unit circle nearest to (2, 1), with x kept below 0.8.
    x = ca.MX.sym("x", 2)
    objective = (x[0] - 2) ** 2 + (x[1] - 1) ** 2
    circle = x[0] ** 2 + x[1] ** 2 - 1
    return NonlinearProgram(x, objective, circle, np.array([-1.0, 0.0]), np.array([0.8, 1.0]))


@pytest.mark.parametrize("method", ["slsqp", "ipopt"])
def test_solution_is_the_bounded_nearest_point(program, method):
    """Against the hand solution (0.8, 0.6), to 1e-6, with the constraint met to 1e-8."""
    guess = np.array([0.1, 0.9])
    if method == "slsqp":
        solution = SlsqpSolver(program).solve(guess, 1e-12)
    else:
        solution = IpoptSolver(program).solve(guess)
    assert solution.converged
    np.testing.assert_allclose(solution.variables, [0.8, 0.6], atol=1e-6)
    assert solution.violation < 1e-8


def test_an_infeasible_program_is_not_converged():
    """A solver that cannot meet the constraint says so in its status."""
    x = ca.MX.sym("x", 1)
    program = NonlinearProgram(x, x[0], x[0] - 5, np.array([0.0]), np.array([1.0]))
    assert not IpoptSolver(program).solve([0.5]).converged
    assert not SlsqpSolver(program).solve(np.array([0.5]), 1e-9).converged
