"""Indirect and direct solutions against each other, another integrator, and known bounds."""

import numpy as np
import pytest

from smallsat.optimal_control.nonlinear_program import IpoptSolver
from smallsat.transfer import beyond
from smallsat.transfer.direct import Case, control_history, fitted_guess, shooting_program
from smallsat.transfer.indirect import condition_error, fly_extremal, solve_extremal
from smallsat.transfer.problem import TransferProblem
from smallsat.transfer.trajectory import boundary_error, fly


@pytest.fixture(scope="module")
def problem(config):
    return TransferProblem.from_config(config["transfer"])


@pytest.fixture(scope="module")
def extremal(problem, config):
    return solve_extremal(problem, 1, config["transfer"]["guess"], 192)


def test_extremal_meets_its_conditions_with_another_integrator(problem, extremal):
    """LSODA against the fixed-step solution: all six conditions to 1e-9."""
    final, _ = fly_extremal(problem, extremal, 3)
    assert condition_error(problem, final) < 1e-9


def test_hamiltonian_vanishes_along_the_extremal(problem, extremal):
    """Autonomous problem with free final time: H = 0 throughout, to 1e-9."""
    _, table = fly_extremal(problem, extremal, 200)
    assert table["hamiltonian"].abs().max() < 1e-9


def test_indirect_collocation_agrees(problem, extremal):
    """Another method of solution (solve_bvp): the same final time to 1e-7."""
    row = beyond.indirect_collocation(problem, np.array([-1.0, 0.0, -0.5, 1.0, 0.5])).iloc[0]
    assert row["converged"]
    assert row["final_time"] == pytest.approx(extremal.final_time, abs=1e-7)


def _solve(problem, case, extremal, **options):
    _, table = fly_extremal(problem, extremal, 481)
    program = shooting_program(problem, case, 112, time_bounds=(3.0, 4.0), **options)
    bound = 5 * (case.intervals - 1)
    program.lower[:bound], program.upper[:bound] = -1.0, 4.0
    program.lower[bound:-1], program.upper[bound:-1] = -12.0, 12.0
    return IpoptSolver(program, mu_init=1e-4).solve(fitted_guess(case, table))


def test_bases_span_the_same_controls(problem, extremal):
    """Global and local basis give the same optimum to 1e-8 where both are well conditioned."""
    times = [
        _solve(problem, Case(2, 2, basis), extremal).objective for basis in ("global", "local")
    ]
    assert times[0] == pytest.approx(times[1], abs=1e-8)


def test_direct_solutions_nest_and_stay_above_the_extremal(problem, extremal):
    """A higher degree never flies longer, none beats the extremal, all are feasible to 1e-9."""
    previous = np.inf
    for degree in (2, 3, 4):
        case = Case(degree, 4, "local")
        solution = _solve(problem, case, extremal)
        final, _ = fly(problem, control_history(case, solution.variables))
        assert solution.converged
        assert boundary_error(problem, final) < 1e-9
        assert extremal.final_time - 1e-9 < solution.objective <= previous + 1e-9
        previous = solution.objective


def test_continuity_holds_and_costs(problem, extremal):
    """The continuous control does not jump (1e-9 rad) and flies no shorter than the free one."""
    case = Case(3, 2, "local")
    free = _solve(problem, case, extremal)
    continuous = _solve(problem, case, extremal, continuous=True)
    path = control_history(case, continuous.variables)
    middle = path.times[1]
    assert path.controls[0](middle) == pytest.approx(path.controls[1](middle), abs=1e-9)
    assert continuous.objective >= free.objective - 1e-9
