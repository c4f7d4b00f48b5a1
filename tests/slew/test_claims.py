"""Predicates of the slew claims on small tables: each has one outcome and the other."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.slew.evidence import claims

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


def test_the_gradient_dominates_from_the_printed_altitude_on(judged):
    """Below it drag may be the larger one; above it, in the densest air, it may not."""
    predicate = claims.gradient_dominates
    longer = environment([0.5, 0.5, 0.5], offset=10.0)
    for gradient, outcome in (([0.5, 2.0, 2.0], "holds"), ([2.0, 2.0, 0.9], "fails")):
        table = pd.concat([environment(gradient), longer])
        assert judged(predicate, {"environment.csv": table}) == outcome
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
