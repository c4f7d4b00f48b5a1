"""What the path and the environment can save: against costs by hand, and by laws of scaling."""

import numpy as np
import pandas as pd
import pytest

from smallsat.drawing.style import apply_style
from smallsat.studies.slew.figures import motions
from smallsat.studies.slew.methods.one_axis import eigenaxis_cost
from smallsat.studies.slew.methods.outer_torques import outer_torques
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.methods.savings import savings
from smallsat.studies.slew.parameters import Parameters

LATE = 160.0


@pytest.fixture(scope="module")
def air(root):
    return pd.read_csv(root / "data/accepted/slew/density.csv")


def test_with_time_enough_no_path_is_cheaper_than_the_axis(section, parameters):
    """By both models, to what the smoothing and few points leave; and the same plan by both."""
    manoeuvre = section.manoeuvre
    few = section.with_(
        beyond=section.beyond.with_(savings_s=(LATE,)),
        manoeuvre=manoeuvre.with_(half=manoeuvre.half.with_(segments=3, segment_nodes=5)),
    )
    table, missing = savings(few, parameters)
    assert not missing and table["model"].tolist() == list(MODELS)
    np.testing.assert_allclose(table["saved_off_axis_pct"], 0.0, atol=1.0)
    assert np.ptp(table["cost_N_m_s"]) < 1e-3 * table["cost_N_m_s"].mean()
    assert np.abs(table["saved_by_gradient_pct"]).max() < 1.0
    apply_style()
    figure, _ = motions.savings(table)
    assert [len(panel.get_lines()) for panel in figure.axes] == [3, 3]


def test_a_turn_about_its_axis_costs_the_more_the_less_time_there_is(section, parameters, changed):
    """At its least time full torque all along; below it, and about no body axis, no cost."""
    angle, moment, torque = np.pi, parameters.inertia[2, 2], parameters.torque
    least = 2.0 * np.sqrt(angle * moment / torque)
    assert eigenaxis_cost(parameters, "half", least * (1.0 + 1e-9)) == pytest.approx(
        torque * least, rel=1e-3
    )
    assert np.isnan(eigenaxis_cost(parameters, "half", 0.99 * least))
    key = "manoeuvre.half.target_quaternion"
    aslant = Parameters.from_section(changed(section, key, (0.5, 0.5, 0.5, 0.5)))
    assert np.isnan(eigenaxis_cost(aslant, "half", LATE))


def test_outer_torques_go_as_they_are_told(section, parameters, air, changed):
    """A dipole twice as strong doubles its torque alone; drag by hand; none where the air ends."""
    table = outer_torques(section, parameters, air).set_index("source")["largest_torque_N_m"]
    twice = changed(section, "beyond.magnetic.residual_A_m2", 0.02)
    other = outer_torques(twice, parameters, air)["largest_torque_N_m"].to_numpy()
    np.testing.assert_allclose(other / table.to_numpy(), [1.0, 1.0, 2.0, 1.0])
    # The wind across the long axis, at an angle to two faces: half density, coefficient, speed
    # squared, area times root two, and the lever of Table 5.
    radius = parameters.orbit.semi_major_axis * (1.0 - parameters.orbit.eccentricity)
    speed2 = parameters.gravity.mu * (2.0 / radius - 1.0 / parameters.orbit.semi_major_axis)
    dense = air[air["solar_flux"] == air["solar_flux"].max()]
    height = (radius - parameters.gravity.radius) / 1e3
    rho = np.exp(np.interp(height, dense["altitude_km"], np.log(dense["msis_86_kg_m3"])))
    by_hand = 0.5 * rho * 2.2 * speed2 * 0.03 * np.sqrt(2.0) * 0.3 / 3000.0
    assert table.iloc[1] == pytest.approx(by_hand, rel=2e-3)
    high = Parameters.from_section(changed(section, "orbit.semi_major_axis_km", 9000.0))
    assert np.isnan(outer_torques(section, high, air)["largest_torque_N_m"][1])
