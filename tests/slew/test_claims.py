"""Predicates of the slew claims on small tables: each has one outcome and the other."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.slew.evidence import claims, model_claims, torque_claims
from smallsat.studies.slew.methods.models import LEFT, PEAKS
from smallsat.studies.slew.methods.plan_names import MODELS

QUARTER, HALF = "90 deg", "180 deg"


@pytest.fixture
def judged(section, tmp_path, grounds):
    """The outcome of a predicate for tables by their names, and for other printed values."""

    def of(predicate, tables, printed=None):
        for file, table in tables.items():
            if file.endswith(".parquet"):
                table.to_parquet(tmp_path / file)
            else:
                table.to_csv(tmp_path / file, index=False)
        return predicate(grounds("slew", section, tmp_path, printed)).outcome

    return of


def environment(gradient, offset=0.1):
    return pd.DataFrame(
        {
            "altitude_km": [300.0, 400.0, 500.0],
            "offset_mm": offset,
            "density_factor": [1.0, 1.0, 3.0],
            "gravity_gradient_N_m": gradient,
            "drag_N_m": 1.0,
        }
    )


def air(gradient):
    return pd.DataFrame(
        {
            "atmosphere": "MSIS-86",
            "solar_flux": [70.0, 230.0],
            "altitude_km": 400.0,
            "gravity_gradient_N_m": gradient,
            "drag_N_m": 1.0,
            "equal_lever_mm": 1.0,
        }
    )


def test_the_gradient_dominates_from_the_printed_altitude_on(judged):
    """Below it drag may be the larger one; above it, in the densest air of either kind, not."""
    predicate = claims.gradient_dominates
    longer = environment([0.5, 0.5, 0.5], offset=10.0)
    for gradient, msis, outcome in (
        ([0.5, 2.0, 2.0], [3.0, 2.0], "holds"),
        ([2.0, 2.0, 0.9], [3.0, 2.0], "fails"),
        ([0.5, 2.0, 2.0], [3.0, 0.9], "fails"),
    ):
        table = pd.concat([environment(gradient), longer])
        tables = {"environment.csv": table, "atmospheres.csv": air(msis)}
        assert judged(predicate, tables) == outcome
    with pytest.raises(LookupError):
        judged(predicate, {"environment.csv": longer})


def test_torque_all_the_time_is_of_the_least_used_wheel(judged):
    """A wheel that rests for a fifth of the points."""
    work = pd.DataFrame(
        {"plan": f"{HALF}, least infeasible, one segment", "node": 1}, index=range(10)
    )
    for axis in "xyz":
        work[f"u_{axis}"] = 1e-4
    assert judged(claims.torque_all_the_time, {"plan-nodes.parquet": work}) == "holds"
    work.loc[:1, "u_y"] = 0.0
    assert judged(claims.torque_all_the_time, {"plan-nodes.parquet": work}) == "fails"


def test_minima_are_counted_by_their_costs(judged):
    """Two starts at one cost to the last digits, and a third at another."""
    starts = pd.DataFrame(
        {"plan": f"{QUARTER}, one segment", "converged": True, "cost_N_m_s": [5e-3, 5.0000001e-3]}
    )
    assert judged(claims.local_minima, {"plan-starts.csv": starts}) == "fails"
    another = pd.concat([starts, starts.head(1).assign(cost_N_m_s=6e-3)])
    assert judged(claims.local_minima, {"plan-starts.csv": another}) == "holds"


def test_a_printed_peak_below_ours_could_be_the_global_minimum(judged):
    """By hand 2 x 26.4 % of 10.3 mN m s are the cost of the optimum."""
    plan = {"plan": [f"{QUARTER}, segments"], "held_converged": True, "held_cost_N_m_s": 5.436e-3}
    tables = {"plans.csv": pd.DataFrame(plan)}
    name = "section-vi-b/maximum-angular-momentum-usage/90-deg-torque-optimal/z"
    assert judged(claims.not_the_global_minimum, tables) == "holds"
    assert judged(claims.not_the_global_minimum, tables, {name: "26.4"}) == "fails"


def along(path):
    """A plan whose z axis has this path in the x-y plane, as complex numbers."""
    tilt = np.arcsin(np.abs(path))
    heading = np.angle(path)
    return pd.DataFrame(
        {
            "plan": f"{HALF}, 110 s",
            "time_s": np.linspace(0.0, 110.0, len(path)),
            "q_1": -np.sin(tilt / 2.0) * np.sin(heading),
            "q_2": np.sin(tilt / 2.0) * np.cos(heading),
            "q_3": 0.0,
            "q_4": np.cos(tilt / 2.0),
        }
    )


def test_a_cardioid_is_known_from_a_circle(judged):
    """Turned and scaled; and an axis that hardly moves draws neither."""
    angle = np.linspace(0.0, 2.0 * np.pi, 201)
    cardioid = 0.3 * np.exp(0.7j) * (1.0 - np.cos(angle)) * np.exp(1j * angle)
    circle = 0.3 * (1.0 - np.exp(1j * angle))
    for path, outcome in (
        (cardioid, "holds"),
        (circle, "undecided"),
        (1e-3 * cardioid, "fails"),
    ):
        tables = {"trade-off-plans.parquet": along(path)}
        assert judged(claims.path_like_a_cardioid, tables) == outcome


def test_controllers_that_give_the_peak_too_refute_that_none_does(judged):
    """A miss of half a unit counts as given."""
    questions = (
        "all but the peak of 90 deg",
        "90 deg, its peak included",
        "all, the peak of 90 deg included",
    )
    for together, outcome in ((26.0, "holds"), (0.9, "fails")):
        misses = [0.3, 2.0, together]
        table = pd.DataFrame({"fitted": questions, "worst_miss_half_units": misses})
        assert judged(claims.peak_of_another_controller, {"controllers.csv": table}) == outcome


@pytest.mark.parametrize(
    ("change", "feasible", "constant"),
    [
        ({}, "holds", "holds"),
        ({"attitude_miss_rad": 1e-3}, "fails", "holds"),
        ({"largest_torque_share": 1.01}, "fails", "holds"),
        ({"hamiltonian_spread": 0.12}, "holds", "fails"),
    ],
)
def test_our_plans_are_all_asked(judged, change, feasible, constant):
    """One plan of the document's own turns that misses, or whose Hamiltonian varies, is enough."""
    row = {
        "plan": ["a plan"],
        "converged": True,
        "held_converged": True,
        "attitude_miss_rad": 1e-9,
        "largest_torque_share": 1.0,
        "hamiltonian_spread": 0.01,
    }
    good = pd.DataFrame(row)
    tables = {
        "plans.csv": good.assign(**change),
        "trade-off.csv": good,
        "minimum-times.csv": good.rename(columns={"plan": "case"}),
    }
    assert judged(claims.plans_are_feasible, tables) == feasible
    assert judged(claims.hamiltonian_is_constant, tables) == constant


def flights(**columns):
    """Both eigenaxis turns, at rest and without torque but for what is said."""
    rows = {"time_s": [0.0, 100.0], "omega_z": [0.0, 0.02], "u_x": 0.0, "u_y": 0.0, "u_z": 1e-4}
    table = pd.DataFrame(rows | columns)
    return {
        "flights.parquet": pd.concat(
            [table.assign(flight=f"eigenaxis {case}") for case in ("quarter", "half")]
        )
    }


def test_the_eigenaxis_turns_use_one_wheel_and_end_moving(judged):
    """A torque about x of a twentieth, and a rate below what the document calls rest."""
    assert judged(claims.z_wheel_alone, flights()) == "holds"
    assert judged(claims.z_wheel_alone, flights(u_x=5e-6)) == "fails"
    assert judged(claims.eigenaxis_not_at_rest, flights()) == "holds"
    assert judged(claims.eigenaxis_not_at_rest, flights(omega_z=1e-5)) == "fails"


def test_the_environment_costs_torque_if_the_law_uses_more_with_it(judged):
    """Torque all the time is more than the flight without environment uses, half of it is less."""
    predicate = torque_claims.eigenaxis_fights_environment
    assert judged(predicate, flights()) == "holds"
    assert judged(predicate, flights(u_z=5e-5)) == "fails"


def saved():
    """By both models in a time, of which either claim speaks beside its own plans."""
    share = {"duration_s": 126.0, "saved_off_axis_pct": 13.0, "saved_by_gradient_pct": -0.1}
    return pd.DataFrame([{"model": model} | share for model in MODELS])


@pytest.mark.parametrize(("cost", "outcome"), [(5.3e-3, "holds"), (5.4358e-3, "fails")])
def test_a_saving_by_the_environment_is_a_hundredth(judged, cost, outcome):
    """Of the plan without it."""
    plans = pd.DataFrame(
        {
            "plan": [f"{QUARTER}, segments", f"{QUARTER}, no gravity gradient, segments"],
            "held_converged": True,
            "held_cost_N_m_s": [cost, 5.4370e-3],
        }
    )
    tables = {"plans.csv": plans, "savings.csv": saved()}
    assert judged(torque_claims.environment_saves_torque, tables) == outcome


@pytest.mark.parametrize(("cost", "outcome"), [(9.6e-3, "holds"), (9.73e-3, "fails")])
def test_a_path_saves_against_the_turn_about_one_axis(judged, cost, outcome):
    """By hand that takes 9.7345 mN m s in 130 s."""
    plans = {"plan": [f"{HALF}, 130 s"], "duration_s": 130.0, "held_cost_N_m_s": cost}
    still = pd.DataFrame({f"{n}_{a}": [0.0] for n in ("omega", "h") for a in "xyz"})
    tables = {
        "trade-off.csv": pd.DataFrame(plans | {"converged": True, "held_converged": True}),
        "trade-off-plans.parquet": still.assign(plan=f"{HALF}, 130 s"),
        "savings.csv": saved(),
    }
    assert judged(torque_claims.path_saves_torque, tables) == outcome


def test_torque_about_z_and_both_respects_follow_the_print(judged):
    """A smaller peak would save torque; a larger one than the law's would not outperform it."""
    peak = "section-vi-b/maximum-angular-momentum-usage/180-deg-torque-optimal"
    for printed, z_less, better in (
        ({}, "fails", "holds"),
        ({f"{peak}/z": "40.0"}, "holds", "holds"),
        ({f"{peak}/y": "60.0"}, "fails", "fails"),
    ):
        tables = flights()
        plan = tables["flights.parquet"].head(2).assign(flight="a model", rate_weight=1.0)
        tables["models-flights.parquet"] = plan
        assert judged(torque_claims.z_torque_significantly_less, tables, printed) == z_less
        assert judged(torque_claims.better_in_both_respects, {}, printed) == better


def quarter_plan(nodes, tilt=0.0):
    times = 50.0 * (np.polynomial.legendre.leggauss(nodes)[0] + 1.0)
    return pd.DataFrame(
        {
            "plan": f"{QUARTER}, one segment",
            "node": 1,
            "time_s": times,
            "q_1": np.sin(tilt / 2.0),
            "q_2": 0.0,
        }
    )


def test_points_that_follow_the_motion_are_told_from_fixed_ones(judged):
    """A plan whose points were moved; and one that tilts by a half right angle."""
    plan = quarter_plan(12)
    tables = {"plan-nodes.parquet": plan}
    assert judged(claims.points_cluster_for_the_motion, tables) == "fails"
    assert judged(claims.near_eigenaxis, tables) == "holds"
    moved = plan.assign(time_s=plan["time_s"] ** 2 / 100.0)
    assert judged(claims.points_cluster_for_the_motion, {"plan-nodes.parquet": moved}) == "holds"
    tilted = {"plan-nodes.parquet": quarter_plan(12, tilt=np.pi / 4.0)}
    assert judged(claims.near_eigenaxis, tilted) == "fails"


@pytest.mark.parametrize(("rate", "outcome"), [(1e-5, "holds"), (1e-3, "fails")])
def test_a_plan_at_rest_is_below_the_printed_bound(judged, rate, outcome):
    """0.01 deg/s are 1.7e-4 rad/s."""
    end = {f"omega_{axis}": [rate] for axis in "xyz"} | {"flight": f"{QUARTER}, one segment"}
    assert judged(claims.plan_comes_to_rest, {"replays.parquet": pd.DataFrame(end)}) == outcome


@pytest.mark.parametrize(
    ("wheels", "euler", "outcome"),
    [(5.0, 1.0, "holds"), (1.0, 5.0, "fails"), (5.0, 4.0, "undecided")],
)
def test_models_are_told_apart_by_half_the_distance(judged, wheels, euler, outcome):
    """The nearest plan of each counts."""
    off = {"printed": [0.0], "wheels' momentum": [wheels, 9.0]}
    off["Euler's equation alone"] = [9.0, euler]
    table = pd.DataFrame(
        [
            {"model": model, "reading": "J w", "rate_weight": 1.0, "off_printed_pct": one}
            for model, several in off.items()
            for one in several
        ]
    )
    table = table.assign(**dict.fromkeys([*PEAKS, *LEFT, "pitch_deg"], 1.0))
    assert judged(model_claims.printed_run_is_eulers, {"models.csv": table}) == outcome


@pytest.mark.parametrize(
    ("given", "outcome"),
    [((0.0, 0.0), "undecided"), ((0.01, 0.0), "holds"), ((0.0, 0.01), "fails")],
)
def test_gyroscopic_torque_is_asked_of_both_models(judged, given, outcome):
    """A spin about z of 0.02 rad/s with momentum about x, of the body or of the wheels alone."""
    wheels, body = given
    spin = {"omega_y": 0.0, "omega_z": 0.02, "h_y": 0.0, "h_z": 0.126 * 0.02, "time_s": 95.0}
    rows = [
        {"flight": "wheels' momentum", "omega_x": 0.01, "h_x": 0.059 * 0.01 + wheels},
        {"flight": "Euler's equation alone", "omega_x": 0.0 if body else 0.01, "h_x": 0.0},
    ]
    table = pd.DataFrame([row | spin for row in rows])
    predicate = model_claims.gyroscopic_torques_deflect_the_end
    assert judged(predicate, {"models-flights.parquet": table}) == outcome
