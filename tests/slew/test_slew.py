"""The slew study: models, least times, plans, and what is refused."""

import numpy as np
import pytest

from smallsat.errors import InputError
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.configuration import Controller
from smallsat.studies.slew.methods import guidance_problem, minimum_time
from smallsat.studies.slew.methods.bound import (
    bound_time,
    largest_disturbance,
    reach,
    reach_by_euler,
)
from smallsat.studies.slew.methods.flights import controller
from smallsat.studies.slew.methods.guidance_problem import Guidance, Model
from smallsat.studies.slew.methods.one_axis import bang_coast_bang
from smallsat.studies.slew.methods.plans import (
    asked_once,
    best_plan,
    guidance_model,
    hold,
    least_infeasible,
    slew_of,
)
from smallsat.studies.slew.model.simulation import angles_deg, open_loop, plant, run, usage_pct
from smallsat.studies.slew.parameters import check, panels

# Bilimoria and Wie's scaled least times, as the document and the literature print them.
LITERATURE = {"half": 3.243, "quarter": 2.4211}


def test_start_is_that_of_table_2(parameters):
    """r_0 and v_0 from the elements, to the printed digits."""
    r, v = parameters.state
    assert r[0] / 1e3 == pytest.approx(6744.1, abs=0.05)
    assert r[1] / 1e3 == pytest.approx(-1.652e-12, abs=0.5e-15)
    assert r[2] / 1e3 == pytest.approx(11.77, abs=0.005)
    assert v[1] / 1e3 == pytest.approx(7.707, abs=0.0005)


def test_without_the_environment_total_momentum_stays_zero(parameters):
    """J w = h all the way where the wheels carry momentum: to 1e-6 of the wheels' limit."""
    model = plant(parameters, gradient=False, drag=0.0)
    law = Controller(natural_frequency_rad_s=0.13, damping_ratio=1.0)
    command = controller(law, parameters, "half")._replace(target=np.array([0.5, 0.5, 0.5, 0.5]))
    flown = run(parameters, model, command, 60.0, 0.01)
    rates = flown[["omega_x", "omega_y", "omega_z"]].to_numpy()
    momentum = flown[["h_x", "h_y", "h_z"]].to_numpy()
    assert np.abs(momentum).max() > 1e-3
    np.testing.assert_allclose(
        rates @ parameters.inertia, momentum, atol=1e-6 * parameters.momentum
    )


def test_step_of_the_simulation_is_fine_enough(section, parameters):
    """Half the step changes no angle of the eigenaxis turn by more than 1e-4 deg."""
    command = controller(section.controller, parameters, "quarter")
    ends = [
        angles_deg(run(parameters, plant(parameters), command, 100.0, step).tail(1))[0]
        for step in (0.01, 0.005)
    ]
    np.testing.assert_allclose(*ends, atol=1e-4)


def test_sampled_controller_approaches_the_continuous_one(section, parameters):
    """A torque held for 0.1 s moves the final yaw by below 0.01 deg, and less than 2 s do."""
    yaw = {
        held: angles_deg(
            run(
                parameters,
                plant(parameters),
                controller(section.controller, parameters, "quarter", held),
                100.0,
                0.01,
            )
        )[-1, 2]
        for held in (0, 10, 200)
    }
    assert abs(yaw[10] - yaw[0]) < min(0.01, abs(yaw[200] - yaw[0]))


def test_symmetric_panels_give_no_torque(section):
    """Table 5: area times half-depth is the same for all panels, so only the offset acts."""
    table = panels(section.spacecraft, offset=0.0)
    levers = table[:, 0] * np.linalg.norm(table[:, 4:7], axis=1)
    np.testing.assert_allclose(levers, levers[0], rtol=1e-12)


@pytest.mark.parametrize("case", ["half", "quarter"])
def test_benchmark_of_bilimoria_and_wie(section, parameters, case):
    """Least times for equal moments and unit torques: within 1e-3 of the literature."""
    few = section.numerics.with_(starts=6)
    body = Model(np.eye(3), 1.0, 1e6, 1.0, False, None)
    about = LITERATURE[case] * 1.05
    found = minimum_time.least_time(
        body, parameters.initial, parameters.targets[case], about, Mesh(10, 6), few
    )
    assert found.converged
    assert found.duration == pytest.approx(LITERATURE[case], abs=1e-3)
    assert found.attitude_miss < 1e-6


def test_bound_is_below_every_plan_and_above_the_printed_time(parameters):
    """No plan in 100 s: the bound lies between 100 s and the least time of about 105.39 s."""
    bare, outer = (bound_time(parameters, gradient) for gradient in (False, True))
    assert parameters.duration < outer < bare < 105.38
    # By hand without the environment: pi = sqrt(a_y^2 + a_z^2) t^2 / 4.
    rate = parameters.torque * np.hypot(1 / parameters.inertia[1, 1], 1 / parameters.inertia[2, 2])
    assert bare == pytest.approx(2.0 * np.sqrt(np.pi / rate), rel=1e-4)


def test_bound_of_eulers_equation_is_weaker_and_above_no_flight(section, parameters):
    """By hand without the environment, and no flight with all wheels on goes beyond it."""
    bare, outer = (bound_time(parameters, g, carried=False) for g in (False, True))
    rate = np.sqrt(3.0) * parameters.torque / parameters.inertia[1, 1]
    assert bare == pytest.approx(2.0 * np.sqrt(np.pi / rate), rel=1e-6)
    # Below the least time that the literature's method finds, 107.35 s.
    assert 0.9 * bare < outer < bare < bound_time(parameters, True) < 107.35
    body = plant(parameters, carried=False, gradient=False, drag=0.0)
    there = np.full((500, 3), parameters.torque)
    there[:, 0] *= -1.0
    torques = np.concatenate([there, -there])
    flown = run(parameters, body, open_loop(parameters, 0.1, torques), 100.0, 0.01)
    speed = np.hypot(flown["omega_y"], flown["omega_z"])
    # To the middle, whatever is left at the end.
    half = flown["time_s"] <= 50.0
    path = np.trapezoid(speed[half], flown["time_s"][half])
    assert 0.5 < path < reach_by_euler(parameters.inertia, parameters.torque, 100.0) / 2.0


def test_bound_covers_flown_motion(section, parameters):
    """The path of the x axis in a flown eigenaxis turn stays below its bound."""
    flown = run(
        parameters,
        plant(parameters),
        controller(section.controller, parameters, "half"),
        100.0,
        0.01,
    )
    speed = np.hypot(flown["omega_y"], flown["omega_z"])
    path = np.trapezoid(speed, flown["time_s"])
    left = tuple(np.abs(flown[["h_x", "h_y", "h_z"]].to_numpy()[-1]))
    bound = reach(
        parameters.inertia, parameters.torque, 100.0, left, largest_disturbance(parameters, 100.0)
    )
    assert path < bound


def test_quarter_turn_is_the_bang_coast_bang_by_hand(section, parameters):
    """Without gravity gradient: held plan within 0.05 % of the cost by hand, peak to 0.1 %."""
    model = Model(parameters.inertia, parameters.torque, parameters.momentum, 100.0, True, None)
    slew = slew_of(model, parameters, "quarter", Mesh(4, 5))
    result, starts = best_plan(slew, section.numerics, 3)
    assert starts["converged"].any()
    held = hold(slew, result, section.numerics)
    assert held.solution.converged
    cost, peak = bang_coast_bang(np.pi / 2, parameters.inertia[2, 2], parameters.torque, 100.0)
    assert held.cost == pytest.approx(cost, rel=5e-4)
    flown = np.abs(held.states[:, 9]).max() * model.momentum_unit
    assert flown == pytest.approx(peak, rel=1e-3)
    assert held.attitude_miss < 1e-6


@pytest.mark.parametrize("steps", [400, 1])
def test_less_smoothing_from_the_last_plan_is_the_same_optimum(
    section, parameters, monkeypatch, steps
):
    """To 1e-7 of the cost in fewer steps; where it takes too many, the usual solver finds it."""
    slew = slew_of(guidance_model(parameters), parameters, "half", Mesh(6, 5), 116.0)
    guess, stages = slew.guess((0.2, 0.0)), section.numerics.smoothing[:-1]
    monkeypatch.setitem(guidance_problem.FOLLOWING, "max_iter", steps)
    guidance = Guidance(slew.model, slew.stated(), slew.mesh)
    followed = guidance.solve(guess, stages)
    monkeypatch.setattr(guidance, "_following_solver", guidance._solver)
    usual = guidance.solve(guess, stages)
    assert followed.solution.converged and usual.solution.converged
    assert followed.solution.objective == pytest.approx(usual.solution.objective, rel=1e-7)
    assert (followed.iterations < usual.iterations) == (steps > 1)


def test_half_turn_in_the_printed_time_is_refused(section, parameters):
    """No plan exists in that time; the least-infeasible one converges and misses its end."""
    assert bound_time(parameters, True) > 100.0
    slew = slew_of(guidance_model(parameters), parameters, "half", Mesh(10, 6))
    assert not asked_once(slew).converged
    (result,) = least_infeasible(slew, section.numerics)
    assert result.solution.converged and result.solution.objective > 0.01


def test_usage_is_in_percent_of_the_limits(section, parameters):
    """The eigenaxis law saturates the wheel about z, and never exceeds it."""
    flown = run(
        parameters,
        plant(parameters),
        controller(section.controller, parameters, "half"),
        100.0,
        0.01,
    )
    torque, _ = usage_pct(flown, parameters)
    assert np.abs(torque[:, 2]).max() == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("spacecraft.inertia_kg_m2", np.diag([1.0, 1.0, 3.0]).tolist(), "no body"),
        ("spacecraft.inertia_kg_m2", np.diag([1.0, -1.0, 1.0]).tolist(), "positive definite"),
        ("spacecraft.inertia_kg_m2", [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], "symmetric"),
        ("manoeuvre.initial_quaternion", [0.0, 0.0, 0.0, 2.0], "unit quaternion"),
    ],
)
def test_what_a_type_cannot_refuse(section, changed, key, value, words):
    """One line that names the key."""
    with pytest.raises(InputError, match=words) as refusal:
        check(changed(section, key, value))
    assert f"slew.{key}" in str(refusal.value)
    check(section)
