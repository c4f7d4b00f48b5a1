"""Indirect and direct solutions against each other, another integrator, and known bounds."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.collocation import Collocation
from smallsat.optimal_control.nonlinear_program import IpoptSolver
from smallsat.studies.transfer.methods import collocation as beyond
from smallsat.studies.transfer.methods.continuation import minimum_time
from smallsat.studies.transfer.methods.direct import (
    Case,
    control_history,
    fitted_guess,
    program_numbers,
    shooting_program,
)
from smallsat.studies.transfer.methods.extremals import Found, find_extremals
from smallsat.studies.transfer.methods.indirect import condition_error, propagate_extremal
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.trajectory import boundary_error, propagate
from smallsat.studies.transfer.model.units import canonical, units_of


@pytest.fixture(scope="module")
def problem(config):
    return TransferProblem.of(config.transfer.problem)


def extremals(problem, config, intervals=(1,)):
    """Solutions by number of intervals, in canonical units."""
    guess = config.transfer.guess
    found = find_extremals(canonical(problem), units_of(problem), intervals, guess, 192)
    assert all(isinstance(result, Found) for result in found.values()), found
    return {count: result.extremal for count, result in found.items()}


@pytest.fixture(scope="module")
def extremal(problem, config):
    return extremals(problem, config)[1]


def test_extremal_meets_its_conditions_with_another_integrator(problem, extremal):
    """LSODA against the fixed-step solution: all six conditions to 1e-9."""
    final, _ = propagate_extremal(problem, extremal, 3)
    assert condition_error(problem, final) < 1e-9


def test_hamiltonian_vanishes_along_the_extremal(problem, extremal):
    """Autonomous problem with free final time: H = 0 throughout, to 1e-9."""
    _, table = propagate_extremal(problem, extremal, 200)
    assert table["hamiltonian"].abs().max() < 1e-9


@pytest.mark.parametrize("basis", ["global", "local"])
@pytest.mark.parametrize(("degree", "intervals"), [(2, 1), (4, 4), (6, 16)])
def test_constraints_in_numbers_are_those_of_the_program(problem, degree, intervals, basis):
    """Their values to the bit, their Jacobian to 1e-12 of its largest entry."""
    case = Case(degree, intervals, basis)
    z = 0.1 + np.random.default_rng(7).uniform(0.5, 1.0, case.size)
    program = shooting_program(problem, case, 48)
    x, jacobian = program.variables, ca.jacobian(program.constraints, program.variables)
    symbolic = ca.Function("g", [x], [program.constraints, jacobian])
    values, slopes = (output.full() for output in symbolic(z))
    constraints, derivatives = program_numbers(problem, case, 48)
    assert np.array_equal(constraints(z), values.ravel())
    np.testing.assert_allclose(derivatives(z), slopes, atol=1e-12 * np.abs(slopes).max())


def test_indirect_collocation_agrees(problem, extremal):
    """Another method of solution (solve_bvp) from a rough guess: the same final time to 1e-7."""
    table = propagate_extremal(problem, extremal, 481)[1]
    solution, _ = beyond.indirect_collocation(problem, table, rough=True)
    assert solution.success
    assert solution.p[0] == pytest.approx(extremal.final_time, abs=1e-7)


OTHERS = [
    {"thrust": 0.07},
    {"thrust": 0.2},
    {"thrust": 0.281},
    {"final_radius": 0.7},
    {"final_radius": 2.0},
    {"final_radius": 3.0},
    {"thrust": 0.04, "final_radius": 0.6},
    {"exhaust_speed": 1.0},
]


# Here the primer vector passes within 2e-4 of zero, and the thrust turns about almost at once.
FAST_TURN = {"thrust": 0.04, "final_radius": 1.3}


@pytest.fixture(scope="module", params=[*OTHERS, FAST_TURN], ids=str)
def other_transfer(request, problem, config):
    """Another problem and its extremals for some numbers of intervals."""
    other = replace(problem, **request.param)
    return other, extremals(other, config, (1, 3, 8))


def test_other_transfers_are_solved_for_every_number_of_intervals(other_transfer):
    """One extremal for all K (final times to 1e-8), its conditions met in another integrator."""
    other, found = other_transfer
    times = [one.final_time for one in found.values()]
    assert np.ptp(times) < 1e-8
    for one in found.values():
        assert condition_error(other, propagate_extremal(other, one, 3)[0]) < 1e-8
        assert other.final_mass(one.final_time) > 0.0


def test_direct_collocation_from_a_rough_guess_ends_at_the_same_time(other_transfer):
    """Direct collocation knows no costate and starts afar; 160 intervals of order 8 agree to 1e-5.

    Where the thrust turns faster than the mesh can follow, they agree to 1e-4.
    """
    other, found = other_transfer[0], other_transfer[1][1]
    turns_fast = other.thrust == FAST_TURN["thrust"] and other.final_radius > 1.0
    mesh = Collocation(160, 4, "legendre")
    table = propagate_extremal(other, found, 481)[1]
    solution, _ = beyond.direct_collocation(other, table, mesh, rough=True)
    assert solution.converged
    room = 1e-4 if turns_fast else 1e-5
    assert solution.objective == pytest.approx(found.final_time, abs=room)


@pytest.mark.parametrize(
    ("length", "mu", "mass"), [(2.0, 4.0, 3.0), (149.6e9, 1.32712e20, 1000.0), (0.1, 0.5, 1e-3)]
)
def test_units_do_not_matter(problem, config, extremal, length, mu, mass):
    """The same transfer in other units takes the same time in units of sqrt(length^3 / mu)."""
    time = np.sqrt(length**3 / mu)
    other = TransferProblem(
        mu=mu,
        thrust=problem.thrust * mass * mu / length**2,
        exhaust_speed=problem.exhaust_speed * length / time,
        initial_radius=length,
        final_radius=problem.final_radius * length,
        initial_mass=mass,
    )
    assert units_of(other).time == pytest.approx(time, rel=1e-14)
    found = extremals(other, config, (1, 2))
    for one in found.values():
        assert one.final_time == pytest.approx(extremal.final_time, rel=1e-9)


def test_time_falls_with_thrust_and_rises_with_distance(problem):
    """More thrust is never slower, and a farther orbit never nearer in time."""

    def times(key, values):
        return np.diff([minimum_time(replace(problem, **{key: v})).final_time for v in values])

    assert np.all(times("thrust", (0.05, 0.1, 0.2, 0.4)) < 0.0)
    assert np.all(times("final_radius", (1.01, 1.2, 2.5, 4.0)) > 0.0)
    assert np.all(times("final_radius", (0.99, 0.8, 0.6, 0.5)) > 0.0)


def _solve(problem, case, extremal, **options):
    _, table = propagate_extremal(problem, extremal, 481)
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
        final, _ = propagate(problem, control_history(case, solution.variables))
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
