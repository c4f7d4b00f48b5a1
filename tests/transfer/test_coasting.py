"""Where thrust switches: signs, conserved quantities, another method, and a bound."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram
from smallsat.optimal_control.runge_kutta import integrate, step_function
from smallsat.studies.transfer.methods import coasting
from smallsat.studies.transfer.methods.direct import polynomial
from smallsat.studies.transfer.methods.experiments import extremal_table
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem


@pytest.fixture(scope="module")
def problem(config):
    return TransferProblem.of(config.transfer.problem)


@pytest.fixture(scope="module")
def found(config):
    return coasting.coasting(config.transfer)


def test_least_time_never_coasts(problem, config):
    """The switching function of least time is positive, and mass is worth nothing at the end."""
    path = coasting.of_least_time(problem, extremal_table(config.transfer))
    assert path["lambda_m"].iloc[-1] == pytest.approx(0.0, abs=1e-9)
    assert (path["lambda_m"].diff().dropna() > 0.0).all()
    assert (path["switching"] > 0.0).all()


def test_the_documents_costate_would_rather_not_thrust(problem, config):
    """With its mass worth 1 at the end the function is negative until it vanishes there.

    On the final orbit H = 0 is T times the switching function.
    """
    value = coasting.switching(problem, extremal_table(config.transfer))
    assert value.iloc[-1] == pytest.approx(0.0, abs=1e-9)
    assert (value.iloc[:-1] < 0.0).all()


def test_thrust_switches_where_the_function_changes_its_sign(problem, found):
    """Zero at both switches to 1e-8, its signs those of the throttle, and two switches a flight."""
    flights, paths = found
    assert (flights["status"].iloc[1:] == "coasts").all()
    for excess, path in paths[paths["excess"] > 0.0].groupby("excess"):
        on = path["thrusting"].astype(bool).to_numpy()
        value = path["switching"].to_numpy()
        switches = np.flatnonzero(on[1:] != on[:-1])
        assert len(switches) == 2, excess
        assert np.abs(value[switches]).max() < 1e-8
        assert value[on].min() > -1e-8
        assert value[~on].max() < 1e-8


def test_hamiltonian_is_constant_through_thrust_and_coast(problem, found):
    """An autonomous problem: one value along thrust, coast and thrust, to 1e-9."""
    off = replace(problem, thrust=0.0)
    for _, path in found[1].groupby("excess"):
        values = [
            (problem if row["thrusting"] else off).hamiltonian(
                row[list(STATES)].to_numpy(float), row[list(COSTATES)].to_numpy(float)
            )
            for _, row in path.iloc[::20].iterrows()
        ]
        assert np.ptp(values) < 1e-9


def test_longer_flights_leave_more_mass_but_less_than_two_impulses(problem, found):
    """Hohmann's two impulses need the least velocity of all transfers between these orbits."""
    mass = found[0]["final_mass"].to_numpy()
    ratio = problem.final_radius / problem.initial_radius
    speed = np.sqrt(problem.mu / problem.initial_radius)
    first = speed * (np.sqrt(2.0 * ratio / (1.0 + ratio)) - 1.0)
    second = speed / np.sqrt(ratio) * (1.0 - np.sqrt(2.0 / (1.0 + ratio)))
    bound = problem.initial_mass * np.exp(-(first + second) / problem.exhaust_speed)
    assert (np.diff(mass) > 0.0).all()
    assert mass[-1] < bound
    assert mass[-1] == pytest.approx(bound, abs=1e-3)


def test_a_direct_method_finds_the_same_mass(problem, found):
    """Angles cubic in each thrust arc, with free switches and no costate: less mass, by 1e-5."""
    row = found[0].set_index("excess").loc[0.1]
    z = ca.MX.sym("z", 10)
    off, on, final_time = z[0], z[1], row["final_time"]

    def rate(one):
        return lambda s, x, p: [
            p[-1] * value
            for value in one.state_rate(
                x, ca.sin(polynomial(p[:-1], s)), ca.cos(polynomial(p[:-1], s))
            )
        ]

    state = ca.DM(problem.initial_state)
    idle = replace(problem, thrust=0.0)
    for one, angle, duration in (
        (problem, z[2:6], off),
        (idle, z[2:6], on - off),
        (problem, z[6:10], final_time - on),
    ):
        step = step_function(rate(one), 5, 5)
        state = integrate(step, state, ca.vertcat(angle, duration), 0.0, 1.0, 40)
    program = NonlinearProgram(
        z,
        -state[4],
        ca.vertcat(*problem.terminal_error(state)),
        np.r_[0.1, 1.5, np.full(8, -10.0)],
        np.r_[1.5, 3.4, np.full(8, 10.0)],
    )
    solution = IpoptSolver(program).solve(np.r_[1.0, 2.5, np.zeros(8)])
    assert solution.converged
    assert -solution.objective < row["final_mass"] + 1e-9
    assert -solution.objective == pytest.approx(row["final_mass"], abs=1e-5)
    assert solution.variables[:2] == pytest.approx([row["off"], row["on"]], abs=1e-2)


def test_a_flight_that_should_not_thrust_so_is_refused(problem, found):
    """Beyond the best time the same equations have a solution whose signs are wrong."""
    path = found[1][found[1]["excess"] == 0.5]
    last = found[0].set_index("excess").loc[0.5]
    start = path.iloc[0][["lambda_r", "lambda_vr", "lambda_vtheta", "lambda_m"]]
    guess = np.array([*start, last["off"], last["on"]], dtype=float)
    coast = coasting.solve_coast(problem, guess, 1.6 / 1.5 * last["final_time"], 192)
    assert coast.residual < coasting.SOLVED
    assert not coasting.obeys_switching(coasting.fly(problem, coast))
