"""A failed wheel and stored momentum: against turns by hand, and flown by another integrator."""

from dataclasses import replace

import numpy as np
import pytest

from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.results import read_table
from smallsat.studies.slew.methods.flown import propagate_held
from smallsat.studies.slew.methods.one_axis import eigenaxis_time
from smallsat.studies.slew.methods.plans import best_plan, guidance_model, hold, slew_of
from smallsat.studies.slew.methods.wheel_states import HEALTHY


def test_least_times_without_a_wheel(parameters, tested_run):
    """Without the x or y wheel that of the turn about z alone by hand, to 1e-3; else as said."""
    table = read_table(tested_run / "data/results/slew/wheel-states.csv")
    assert table["converged"].all()
    times = table.set_index("wheels")["least_time_s"]
    alone = eigenaxis_time(np.pi, parameters.inertia[2, 2], parameters.torque, parameters.momentum)
    for axis in "xy":
        assert times[f"wheel {axis} failed"] == pytest.approx(alone, rel=1e-3)
    assert times["wheel z failed"] > alone > times[HEALTHY]
    assert times["25 % in wheel y"] < parameters.duration


def test_least_times_are_flown_to_their_ends(tested_run):
    """By the independent integrator, to 1e-9 rad and rad/s, where switching times were refined."""
    results = tested_run / "data/results/slew"
    cases = read_table(results / "switches.csv")["case"].unique()
    table = read_table(results / "minimum-times.csv").set_index("case")
    refined = table.loc[cases]
    assert refined["converged"].all() and len(refined) > 1
    assert (refined[["attitude_miss_rad", "rate_miss_rad_s"]] < 1e-9).all(axis=None)


def test_a_plan_in_the_printed_time_flies_if_a_wheel_holds_momentum(section, parameters):
    """A quarter in the wheel about y: to its end within 1e-6 rad, by the independent integrator."""
    model = replace(guidance_model(parameters), stored=(0.0, 0.25, 0.0))
    slew = slew_of(model, parameters, "half", Mesh(6, 6))
    few = section.numerics.with_(smoothing=(1.0,), held_smoothing=0.1, held_intervals=60)
    result, _ = best_plan(slew, few, 2)
    assert result.solution.converged
    held = hold(slew, result, few)
    assert held.solution.converged and held.attitude_miss < 1e-6
    used = np.abs(held.states[:, 7:]).max() * model.momentum_unit
    assert used <= parameters.momentum * (1.0 + 1e-9)


def test_momentum_of_body_and_wheels_keeps_its_size(parameters):
    """Without environment |J w - h| stays what the wheels held, whatever they do: to 1e-9."""
    model = replace(guidance_model(parameters), parameters=None, stored=(0.1, -0.2, 0.3))
    controls = np.array([[1.0, -0.5, 0.2], [-1.0, 0.3, 0.8], [0.1, 1.0, -1.0]])
    start = np.r_[parameters.initial, model.start]
    states = propagate_held(model, start, np.full(3, 0.2), controls)
    total = states[:, 4:7] / model.unit @ parameters.inertia - states[:, 7:] * model.momentum_unit
    sizes = np.linalg.norm(total, axis=1) / parameters.momentum
    np.testing.assert_allclose(sizes, np.linalg.norm([0.1, -0.2, 0.3]), rtol=1e-9)


def test_a_piece_of_no_length_changes_nothing(parameters):
    """Be it shorter than the spacing of times around it: the same end, to 1e-15."""
    model = guidance_model(parameters)
    start = np.r_[parameters.initial, model.start]
    controls = np.array([[1.0, -0.5, 0.2], [-1.0, 0.3, 0.8]])
    without = propagate_held(model, start, np.array([0.5, 0.0]), controls)
    nearly = propagate_held(model, start, np.array([0.5, 1e-18]), controls)
    np.testing.assert_allclose(nearly[-1], without[-1], rtol=0, atol=1e-15)
