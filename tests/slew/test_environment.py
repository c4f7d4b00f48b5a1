"""Drag in air of other models: its scaling, and that it changes no printed digit."""

import numpy as np
import pandas as pd
import pytest

from smallsat.dynamics.environment.torques import ATMOSPHERE, density
from smallsat.studies.slew.methods.environment_study import (
    AIR,
    printed_lever_mm,
    torque_table,
    with_density,
)
from smallsat.studies.slew.methods.flights import controller
from smallsat.studies.slew.model.simulation import angles_deg, plant, run
from smallsat.studies.slew.parameters import Parameters

TWICE, FIFTH = 2.0, 0.2


@pytest.fixture(scope="module")
def short(section):
    """Two altitudes, and a tenth of a day."""
    environment = section.environment.with_(altitudes_km=(300.0, 500.0), duration_days=0.1)
    return section.with_(environment=environment)


def profile(factor):
    """Our own exponential air times a factor, as a table of densities."""
    heights = np.array([300.0, 500.0])
    rho = [factor * density(1e3 * height, ATMOSPHERE) for height in heights]
    columns = {"msis_86_kg_m3": rho, "nrlmsise_00_kg_m3": rho}
    return pd.DataFrame({"altitude_km": heights, "solar_flux": 140.0} | columns)


def test_drag_goes_with_the_density(short):
    """The exponential air itself gives our own torques, and twice as dense air twice as much."""
    table = torque_table(short, Parameters.from_section(short))
    ours = table[np.isclose(table["offset_mm"], printed_lever_mm(short))]
    ours = ours[ours["density_factor"] == 1.0]
    for factor in (1.0, TWICE):
        found = with_density(short, table, profile(factor))
        assert set(found["atmosphere"]) == set(AIR)
        rows = found[found["atmosphere"] == AIR[0]]
        np.testing.assert_allclose(rows["drag_N_m"], factor * ours["drag_N_m"], rtol=1e-12)


def test_the_lever_of_equal_torques_makes_them_equal(short):
    """Computed anew with that lever: to 1e-9, since the panels are symmetric but for it."""
    table = torque_table(short, Parameters.from_section(short))
    row = with_density(short, table, profile(1.0)).iloc[0]
    longer = short.environment.with_(
        offsets_mm=(row["equal_lever_mm"],), altitudes_km=(row["altitude_km"],)
    )
    other = short.with_(environment=longer)
    again = torque_table(other, Parameters.from_section(other))
    again = again[again["density_factor"] == 1.0].iloc[0]
    assert again["drag_N_m"] == pytest.approx(again["gravity_gradient_N_m"], rel=1e-9)


def test_the_committed_densities_are_near_each_other_and_near_ours(root):
    """MSIS-86 and its successor agree to a fifth; our air lies within solar activity."""
    table = pd.read_csv(root / "data/accepted/slew/density.csv")
    ratio = table["msis_86_kg_m3"] / table["nrlmsise_00_kg_m3"]
    assert np.abs(ratio - 1.0).max() < FIFTH
    for altitude, rows in table.groupby("altitude_km"):
        ours = density(1e3 * float(str(altitude)), ATMOSPHERE)
        assert rows["msis_86_kg_m3"].min() < ours < rows["msis_86_kg_m3"].max()
        assert rows.sort_values("solar_flux")["msis_86_kg_m3"].is_monotonic_increasing


@pytest.mark.parametrize(("case", "turn"), [("quarter", "90-deg"), ("half", "180-deg")])
def test_drag_moves_no_printed_digit_of_the_eigenaxis_turns(
    section, parameters, ledger, case, turn
):
    """Final yaw, as printed, without air and in air five times as dense."""
    printed = ledger("slew").value(f"section-vi-a/final-yaw-angle/{turn}-eigenaxis")
    for factor in (0.0, 5.0):
        body = plant(parameters, drag=factor)
        command = controller(section.controller, parameters, case)
        flown = run(parameters, body, command, parameters.duration, section.numerics.step_s)
        yaw = angles_deg(flown.tail(1))[0, 2]
        assert abs(yaw - printed.value) <= printed.half_unit
