"""Times in which there is no plan: rows that say so, and nothing that rests on them."""

import numpy as np
import pandas as pd
import pytest

from smallsat.drawing.style import apply_style
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.evidence import claims
from smallsat.studies.slew.evidence.observations import chosen_plan, comparable_time, short_of
from smallsat.studies.slew.figures import motions as plots
from smallsat.studies.slew.methods import minimum_time
from smallsat.studies.slew.methods.environment_study import crossover_km
from smallsat.studies.slew.methods.flown import _position
from smallsat.studies.slew.methods.guidance_problem import Model, kepler_steps
from smallsat.studies.slew.methods.one_axis import eigenaxis_time
from smallsat.studies.slew.methods.plan_names import EULER, ONE_SEGMENT, WHEELS, plan_names
from smallsat.studies.slew.methods.plans import HELD_COLUMNS, joined
from smallsat.studies.slew.methods.turns import euler_plan, turn_plans
from smallsat.studies.slew.parameters import Parameters


@pytest.fixture(scope="module")
def small(section):
    """Few points and starts, for solves that end in a second."""
    manoeuvre, few = section.manoeuvre, {"nodes": 8, "segments": 2, "segment_nodes": 4}
    return section.with_(
        numerics=section.numerics.with_(starts=1, held_intervals=20),
        manoeuvre=manoeuvre.with_(
            quarter=manoeuvre.quarter.with_(**few), half=manoeuvre.half.with_(**few)
        ),
    )


def timed(section, duration):
    """The study with a time of its own."""
    return section.with_(manoeuvre=section.manoeuvre.with_(duration_s=duration))


def planned(section, case, duration):
    """The plans of a turn on both meshes, in a time of its own."""
    other = timed(section, duration)
    return list(turn_plans(Parameters.from_section(other), case, other))


def test_a_quarter_turn_in_a_fraction_of_its_time_is_a_row(small):
    """40 s of the 85 s it needs: listed with status and residual, and not called optimal."""
    for turn in planned(small, "quarter", 40.0):
        first = turn.missing[0]
        assert first.case.startswith("90 deg, ")
        assert "no plan can exist" in first.status and "nfeasible" in first.status
        assert first.residual > 1e-3
        assert turn.held is None and turn.starts is None
        assert "least infeasible" in turn.row["plan"]


def test_a_half_turn_that_cannot_be_is_a_result(small):
    """The document's own case: in the table of what is infeasible, and not among the failures."""
    for turn in planned(small, "half", 100.0):
        assert not turn.missing and not turn.infeasible["hard_converged"]
        assert turn.infeasible["miss"] > 0.01


def test_a_half_turn_with_time_enough_is_of_least_torque(small):
    """In 150 s it is planned like the other one, and held, and flown to its target."""
    one, several = planned(small, "half", 150.0)
    assert one.infeasible["hard_converged"] and several.infeasible["hard_converged"]
    assert several.row["plan"] == "180 deg, segments"
    assert several.row["held_converged"] and several.row["attitude_miss_rad"] < 1e-3
    assert not one.missing and not several.missing


def test_a_half_turn_by_eulers_equation_is_planned_as_well(small):
    """In 100 s the least infeasible, no failure, and named so; in 150 s that of least torque."""
    for duration, place in ((100.0, 1), (150.0, 0)):
        other = timed(small, duration)
        parameters = Parameters.from_section(other)
        turn = euler_plan(parameters, other)
        assert turn.row["plan"] == plan_names(parameters, "half", ONE_SEGMENT, EULER)[place]
        assert turn.infeasible["model"] == turn.model == EULER and not turn.timed
        assert turn.infeasible["hard_converged"] == (duration == 150.0)
        assert turn.nodes is not None and not turn.missing


def test_no_plan_at_all_leaves_tables_with_their_columns():
    """What draws and judges finds no rows, not no table."""
    assert joined([], HELD_COLUMNS).columns.tolist() == list(HELD_COLUMNS)
    assert len(joined([], HELD_COLUMNS)) == 0


def test_claims_are_undecided_or_right_about_another_time(section, tmp_path, grounds, changed):
    """With a plan the document's guess fails; between the bound and a plan nobody knows."""
    times = pd.DataFrame(
        {
            "case": ["180 deg, wheels and gravity gradient"],
            "duration_s": [105.39],
            "converged": [True],
        }
    )
    times.to_csv(tmp_path / "minimum-times.csv", index=False)
    bound = pd.DataFrame(
        {"model": [WHEELS, EULER], "gravity_gradient": True, "bound_s": [102.5, 90.9]}
    )
    bound.to_csv(tmp_path / "bound.csv", index=False)
    outcomes = {}
    for duration, solved in ((100.0, False), (104.0, False), (130.0, True)):
        answer = {
            "model": [WHEELS],
            "mesh": ["segments"],
            "hard_status": ["status"],
            "hard_converged": [solved],
        }
        pd.DataFrame(answer | {"miss": [0.1]}).to_csv(tmp_path / "infeasible.csv", index=False)
        other = changed(section, "manoeuvre.duration_s", duration)
        given = grounds("slew", other, tmp_path)
        outcomes[duration] = (
            claims.not_in_the_given_time(given).outcome,
            claims.valid_trajectory_at_limits(given).outcome,
        )
    assert outcomes == {
        100.0: ("holds", "fails"),
        104.0: ("undecided", "undecided"),
        130.0: ("fails", "holds"),
    }


def test_a_least_time_that_was_not_found_decides_nothing(section, tmp_path, grounds):
    """A LookupError, which the judge calls undecided."""
    times = {"case": ["180 deg, wheels"], "duration_s": [np.nan], "converged": [False]}
    pd.DataFrame(times).to_csv(tmp_path / "minimum-times.csv", index=False)
    with pytest.raises(LookupError):
        claims.eigenaxis_is_not_fastest(grounds("slew", section, tmp_path))


def test_claims_about_yaw_need_a_turn_about_z(section, tmp_path, grounds, changed):
    """For another axis the printed words mean nothing: not judged."""
    other = changed(section, "manoeuvre.quarter.target_quaternion", (0.6, 0.0, 0.0, 0.8))
    for predicate in (claims.better_than_eigenaxis, claims.open_loop_follows):
        with pytest.raises(LookupError, match="not about"):
            predicate(grounds("slew", other, tmp_path))


@pytest.mark.parametrize(
    ("angle", "target", "short"),
    [(80.0, 90.0, 10.0), (-165.0, 180.0, -15.0), (170.0, -170.0, 20.0)],
)
def test_what_is_short_of_a_target_goes_the_shorter_way(angle, target, short):
    """Across half a turn, either way."""
    assert short_of(angle, target) == short


def test_a_flight_that_never_settles_has_no_time(parameters):
    """Not a number, instead of a place beyond the table; at rest at the target it is the start."""
    turn = np.radians(45.0)
    rows = {"time_s": [0.0, 1.0], "q_1": 0.0, "q_2": 0.0, "q_3": np.sin(turn), "q_4": np.cos(turn)}
    flown = pd.DataFrame(rows | {"omega_z": np.radians([0.5, 0.1])})
    assert np.isnan(comparable_time(flown, 45.0, 0.9, 1.0))
    assert comparable_time(flown, 90.0, 0.9, 1.0) == 0.0
    assert comparable_time(flown, 90.0, 0.9, 0.2) == 1.0


def test_the_least_infeasible_plan_stands_in_where_there_is_no_other(parameters):
    """The plan of least torque is shown if there is one."""
    names = ["180 deg, least infeasible, segments", "180 deg, segments"]
    both = pd.DataFrame({"plan": names})
    assert chosen_plan(both, "plan", parameters, "half", "segments")[0] == names[1]
    assert chosen_plan(both[:1], "plan", parameters, "half", "segments")[0] == names[0]
    assert not len(chosen_plan(both[:0], "plan", parameters, "half", "segments")[1])


def test_drag_that_dominates_everywhere_has_no_crossover():
    """Not the highest altitude studied; and altitudes may stand in any order."""
    table = pd.DataFrame(
        {
            "altitude_km": [500.0, 300.0],
            "offset_mm": 1.0,
            "density_factor": 1.0,
            "gravity_gradient_N_m": [2.0, 1.0],
            "drag_N_m": [1.0, 2.0],
        }
    )
    assert crossover_km(table, 1.0) == pytest.approx(400.0)
    assert np.isnan(crossover_km(table.assign(drag_N_m=3.0), 1.0))


def test_an_eccentric_orbit_is_followed_as_well_as_a_round_one(parameters):
    """Kepler's equation of the guidance and of the independent flight agree to 1e-9."""
    orbit = parameters.orbit._replace(eccentricity=0.6)
    mean = 0.7
    anomaly = mean
    for _ in range(kepler_steps(0.6)):
        anomaly = mean + 0.6 * np.sin(anomaly)
    assert anomaly - 0.6 * np.sin(anomaly) == pytest.approx(mean, abs=1e-12)
    time = mean * np.sqrt(orbit.semi_major_axis**3 / parameters.gravity.mu)
    radius = np.linalg.norm(_position(orbit, parameters.gravity.mu, time))
    expected = orbit.semi_major_axis * (1.0 - 0.6 * np.cos(anomaly))
    assert radius == pytest.approx(expected, rel=1e-9)


def test_a_time_without_a_plan_is_a_cross_and_no_point():
    """Drawn as missing, in both panels, and a row without values in the figure's data."""
    apply_style()
    solved = np.array([True, False])
    table = pd.DataFrame({"duration_s": [110.0, 104.0], "converged": True})
    table["held_converged"] = solved
    for name in ("held_cost_N_m_s", *(f"held_peak_{axis}_pct" for axis in "xyz")):
        table[name] = np.where(solved, 1.0, np.nan)
    figure, data = plots.trade_off(table, 100.0, np.nan, 102.5)
    for panel in figure.axes:
        crosses = [line for line in panel.get_lines() if line.get_label() == "no plan"]
        assert [line.get_xdata().tolist() for line in crosses] == [[104.0]]
    assert data["duration_s"].tolist() == [110.0, 104.0]
    assert data["held_cost_N_m_s"].isna().tolist() == [False, True]


def test_a_missing_figure_says_which():
    """A word in its place, and the same word in its data."""
    figure, data = plots.missing("no plan: 90 deg, one segment")
    assert figure.axes[0].texts[0].get_text() == data["note"][0] == "no plan: 90 deg, one segment"


def test_axes_that_switch_together_have_their_least_time(section, parameters):
    """120 deg about (1, 1, 1), unit moments and torques: by hand 2 sqrt(angle / sqrt 3)."""
    body = Model(np.eye(3), 1.0, 1e6, 1.0, False, None)
    few = section.numerics.with_(starts=1)
    target = np.full(4, 0.5)
    found = minimum_time.least_time(body, parameters.initial, target, 2.3, Mesh(4, 6), few)
    assert found.converged
    assert found.duration == pytest.approx(
        2.0 * np.sqrt(2.0 * np.pi / 3.0 / np.sqrt(3.0)), rel=1e-3
    )
    assert found.attitude_miss < 1e-3


def test_a_wheel_that_fills_slows_the_turn_and_is_not_taken_for_bang_bang(section, parameters):
    """Momentum a third of what the unlimited turn uses: a longer time, without switching times."""
    few = section.numerics.with_(starts=1)
    times = {}
    for limit in (1e6, 0.5):
        body = Model(np.eye(3), 1.0, limit, 1.0, False, None)
        found = minimum_time.least_time(
            body, parameters.initial, parameters.targets["quarter"], 3.0, Mesh(6, 6), few
        )
        assert found.converged and found.momentum_limited == (limit < 1.0)
        times[limit] = found.duration
    assert times[0.5] > 1.2 * times[1e6]
    assert times[0.5] <= eigenaxis_time(np.pi / 2.0, 1.0, 1.0, 0.5) + 1e-2
