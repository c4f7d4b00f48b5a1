"""The Gauss pseudospectral method, held controls and switching times on problems solved by hand."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.gauss_pseudospectral import (
    GaussPseudospectral,
    Mesh,
    OptimalControlProblem,
    differentiation_matrix,
    legendre_gauss,
)
from smallsat.optimal_control.nonlinear_program import IpoptSolver
from smallsat.optimal_control.switching_times import Arcs, arcs_of, refine
from smallsat.optimal_control.zero_order_hold import HeldControl

FREE = np.full(2, np.inf)


def double_integrator(final_time, least_time):
    """From rest at 0 to rest at 1: least time with |u| <= 1, or least integral of u^2 / 2."""
    return OptimalControlProblem(
        initial=np.zeros(2),
        controls=1,
        rate=lambda x, u, t, p: ca.vertcat(x[1], u[0]),
        running_cost=lambda x, u, t, p: ca.SX(0.0) if least_time else u[0] ** 2 / 2,
        terminal=lambda x, t: ca.vertcat(x[0] - 1.0, x[1]),
        end_cost=lambda x, t, p: t if least_time else 0.0,
        state_bounds=np.array([-FREE, FREE]),
        control_bounds=np.array([[-1.0], [1.0]]) * (1.0 if least_time else np.inf),
        final_time=final_time,
    )


@pytest.mark.parametrize("nodes", [3, 8, 20])
def test_differentiation_and_quadrature_are_exact_for_polynomials(nodes):
    """Derivative of degree N and integral of degree 2N - 1, to 1e-10."""
    points, weights = legendre_gauss(nodes)
    support = np.r_[-1.0, points]
    matrix = differentiation_matrix(points)
    assert matrix.shape == (nodes, nodes + 1)
    np.testing.assert_allclose(matrix @ support**nodes, nodes * points ** (nodes - 1), atol=1e-10)
    assert weights @ points ** (2 * nodes - 2) == pytest.approx(2.0 / (2 * nodes - 1), rel=1e-12)


@pytest.mark.parametrize("mesh", [Mesh(1, 8), Mesh(4, 3)])
def test_jacobian_by_parts_is_that_of_the_constraints(mesh):
    """Of what couples points and what does not, against CasADi's of the whole: the same numbers."""
    pendulum = replace(
        double_integrator((1.0, 9.0), True),
        rate=lambda x, u, t, p: ca.vertcat(x[1], ca.sin(x[0]) * ca.cos(t) + p[0] * u[0]),
        terminal=lambda x, t: ca.vertcat(x[0] * x[1] - t, x[1]),
        parameters=1,
    )
    program = GaussPseudospectral(pendulum, mesh).program
    x, p = program.variables, program.parameters
    whole = ca.jacobian(program.constraints, x)
    both = ca.Function("both", [x, p], [whole, program.jacobian])
    z = np.random.default_rng(3).normal(size=x.shape[0])
    expected, found = both(z, [0.7])
    assert expected.nnz() == found.nnz() > 0
    np.testing.assert_array_equal(found.full(), expected.full())


@pytest.mark.parametrize("mesh", [Mesh(1, 8), Mesh(4, 3)])
def test_states_controls_and_costates_of_a_quadratic_problem(mesh):
    """By hand u = 6 - 12 t, costates (12, -6 + 12 t), H = -18 on [0, 1]: all to 1e-7."""
    method = GaussPseudospectral(double_integrator((1.0, 1.0), False), mesh)
    guess = method.guess(1.0, lambda t: np.array([t, 1.0]), lambda t: np.zeros(1))
    solution = IpoptSolver(method.program).solve(guess)
    assert solution.converged
    plan = method.plan(solution.variables, solution.multipliers)
    np.testing.assert_allclose(plan.controls[:, 0], 6.0 - 12.0 * plan.times, atol=1e-7)
    # With the rate as gradient of the cost: u = -lambda_2.
    np.testing.assert_allclose(plan.costates[:, 1], -plan.controls[:, 0], atol=1e-7)
    np.testing.assert_allclose(plan.costates[:, 0], -12.0, atol=1e-7)
    np.testing.assert_allclose(method.hamiltonian(plan, np.zeros(0)), -18.0, atol=1e-6)


def test_switching_time_of_the_double_integrator():
    """Least time 2 and one switch at 1, by hand, from a coarse collocation: to 1e-8."""
    stated = double_integrator((0.5, 10.0), True)
    method = GaussPseudospectral(stated, Mesh(3, 4))
    guess = method.guess(3.0, lambda t: np.array([t / 3.0, 0.3]), lambda t: np.zeros(1))
    solution = IpoptSolver(method.program).solve(guess)
    assert solution.converged
    plan = method.plan(solution.variables)
    arcs, refined = refine(
        lambda x, u, t: ca.vertcat(x[1], u[0]),
        stated.initial,
        stated.terminal,
        arcs_of(plan.times, plan.controls, plan.final_time),
    )
    assert refined.converged
    assert arcs.final_time == pytest.approx(2.0, abs=1e-8)
    assert [axis for axis, _ in arcs.switches()] == [0]
    assert arcs.switches()[0][1] == pytest.approx(1.0, abs=1e-8)


def test_no_arc_is_shorter_than_nothing():
    """Axes that switch together by symmetry, read as one after the other: the arc between is 0."""
    controls = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    arcs, refined = refine(
        lambda x, u, t: ca.vertcat(x[1], u[0], x[3], u[1]),
        np.zeros(4),
        # Of the second axis what is left once the first one's conditions hold.
        lambda x, final: ca.vertcat(x[0] - 1.0, x[1] + x[3]),
        Arcs(controls, np.array([0.9, 0.2, 0.9])),
    )
    assert refined.converged
    assert (arcs.durations >= 0.0).all()
    np.testing.assert_allclose(arcs.durations, [1.0, 0.0, 1.0], atol=1e-7)


def test_held_control_approaches_the_optimum_from_above():
    """Cost 6 by hand; with n pieces it is 6 / (1 - 1/n^2), to 1e-7."""
    pieces = 20
    held = HeldControl(double_integrator((1.0, 1.0), False), pieces)
    times = np.array([0.0, 1.0])
    guess = held.guess(times, np.array([[0.0, 0.0], [1.0, 0.0]]), np.zeros((2, 1)))
    solution = IpoptSolver(held.program).solve(guess)
    assert solution.converged
    assert solution.objective == pytest.approx(6.0 / (1.0 - 1.0 / pieces**2), rel=1e-7)
    assert held.controls(solution.variables).shape == (pieces, 1)


def test_derivatives_of_a_held_control_are_those_of_its_program():
    """What is put together from pieces, against CasADi's own of the whole, to 1e-14."""
    pieces, final = 4, 1.3
    stated = OptimalControlProblem(
        initial=np.array([0.1, 0.2, 0.3]),
        controls=2,
        rate=lambda x, u, t, p: ca.vertcat(
            x[1] * x[2] + u[0], ca.sin(x[0]) * u[1] + t * x[1], x[0] * u[0] ** 2 * p[0]
        ),
        running_cost=lambda x, u, t, p: ca.sqrt(ca.dot(u, u) + p[0]) * (1 + x[0] ** 2),
        terminal=lambda x, final: ca.vertcat(x[0] ** 2 * x[1], x[2] - final),
        end_cost=lambda x, final, p: ca.exp(x[0]) * p[0] + x[1] * x[2] * final,
        state_bounds=np.array([np.full(3, -9.0), np.full(3, 9.0)]),
        control_bounds=np.array([[-1.0, -1.0], [1.0, 1.0]]),
        final_time=(final, final),
        parameters=1,
    )
    x, u, p = ca.SX.sym("x", 3, pieces), ca.SX.sym("u", 2, pieces), ca.SX.sym("p", 1)
    start, cost, constraints, h = ca.SX(stated.initial), 0.0, [], final / pieces
    for i in range(pieces):
        cost += h * stated.running_cost(start, u[:, i], i * h, p)
        after = start
        for time in (i * h, (i + 0.5) * h):
            k1 = stated.rate(after, u[:, i], time, p)
            k2 = stated.rate(after + h / 4 * k1, u[:, i], time + h / 4, p)
            k3 = stated.rate(after + h / 4 * k2, u[:, i], time + h / 4, p)
            k4 = stated.rate(after + h / 2 * k3, u[:, i], time + h / 2, p)
            after += h / 12 * (k1 + 2 * k2 + 2 * k3 + k4)
        constraints.append(after - x[:, i])
        start = x[:, i]
    cost += stated.end_cost(start, final, p)
    everything = ca.vertcat(*constraints, stated.terminal(start, final))
    unknown, factor = ca.vertcat(ca.vec(x), ca.vec(u)), ca.SX.sym("lam_f")
    factors = ca.SX.sym("lam_g", everything.numel())
    lagrangian = factor * cost + ca.dot(factors, everything)
    expected = ca.Function(
        "whole",
        [unknown, p, factor, factors],
        [
            everything,
            ca.jacobian(everything, unknown),
            ca.triu(ca.hessian(lagrangian, unknown)[0]),
        ],
    )
    program = HeldControl(stated, pieces).program
    jacobian = ca.Function(
        "jacobian",
        [program.variables, program.parameters],
        [program.constraints, program.jacobian],
    )
    random = np.random.default_rng(3)
    z, lam = random.uniform(0.1, 0.9, unknown.numel()), random.normal(size=factors.numel())
    *first, second = (output.full() for output in expected(z, 0.3, 0.7, lam))
    for ours, theirs in zip(jacobian(z, 0.3), first, strict=True):
        np.testing.assert_allclose(ours.full(), theirs, rtol=0, atol=1e-14)
    np.testing.assert_allclose(program.hessian(z, 0.3, 0.7, lam).full(), second, rtol=0, atol=1e-14)


def test_a_held_control_needs_one_final_time():
    with pytest.raises(ValueError, match="needs one final time"):
        HeldControl(double_integrator((1.0, 2.0), False), 4)


def test_too_short_a_time_is_not_converged():
    """Least time is 2: a fixed time of 1.9 is refused by the solver's status."""
    stated = double_integrator((1.9, 1.9), True)
    method = GaussPseudospectral(stated, Mesh(3, 6))
    guess = method.guess(1.9, lambda t: np.array([t / 1.9, 0.5]), lambda t: np.zeros(1))
    assert not IpoptSolver(method.program).solve(guess).converged
