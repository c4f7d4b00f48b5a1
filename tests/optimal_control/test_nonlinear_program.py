"""Both solvers on a program whose solution is known by hand."""

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.nonlinear_program import (
    IpoptSolver,
    NonlinearProgram,
    SlsqpSolver,
    StoppingRule,
)


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


def test_a_run_is_stopped_where_its_rule_is_met_first(program):
    """Every iterate before the last violates the rule; a looser rule stops no later."""
    guess = np.array([0.1, 0.9])
    iterations = []
    for tolerance in (1e-1, 1e-6):
        rule = StoppingRule(optimality=tolerance, feasibility=tolerance)
        solution = SlsqpSolver(program).solve_until(guess, rule, 1e-15)
        assert solution.converged
        *before, last = solution.path[:, 1:] <= tolerance
        assert last.all()
        assert not any(met.all() for met in before)
        assert solution.violation == solution.path[-1, 1]
        iterations.append(solution.iterations)
    assert iterations[0] <= iterations[1]
    np.testing.assert_allclose(solution.variables, [0.8, 0.6], atol=1e-5)


def test_optimality_is_the_gradient_that_no_multiplier_removes(program):
    """By hand at (0, 1): the gradient (-4, 0) is at right angles to the constraint's (0, 2)."""
    solver = SlsqpSolver(program)
    assert solver._first_order(np.array([0.0, 1.0 - 1e-6])) == pytest.approx((2e-6, 4.0), rel=1e-5)


def test_a_run_that_ends_by_itself_has_not_met_its_rule(program):
    """SLSQP's own criterion ends it where the rule asks for more than there is."""
    rule = StoppingRule(optimality=0.0, feasibility=0.0)
    solution = SlsqpSolver(program).solve_until(np.array([0.1, 0.9]), rule, 1e-6)
    assert not solution.converged
    assert len(solution.path) == solution.iterations
