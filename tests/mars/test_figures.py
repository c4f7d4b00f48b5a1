"""What the figures draw."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.mars.figures.responses import response_data
from smallsat.studies.mars.figures.scenes import scene_data, scene_in
from smallsat.studies.mars.methods.independent_check import attitude_angle
from smallsat.studies.mars.methods.simulation import as_table
from smallsat.studies.mars.model.modes import NADIR


@pytest.fixture(scope="module")
def trajectories(runs):
    return pd.concat(
        [as_table(record).assign(run=name) for name, record in runs.items()], ignore_index=True
    )


def test_second_rate_panel_draws_the_second_rate(trajectories, runs):
    """Figs. 4 and 5: the column omega_2 is the run's second rate, not the first."""
    data = response_data(trajectories, "fixed torque")
    np.testing.assert_array_equal(data["omega_2"], runs["fixed torque"][:, 5])
    assert np.max(np.abs(data["omega_2"] - data["omega_1"])) > 1.0


def test_reference_attitude_is_the_nearer_set_of_the_same_attitude(trajectories, runs):
    """Fig. 6: same attitude as the reference, to 1e-7 rad, and never farther than its shadow."""
    data = response_data(trajectories, "sun")
    drawn = data[["sigma_ref_1", "sigma_ref_2", "sigma_ref_3"]].to_numpy()
    body = data[["sigma_1", "sigma_2", "sigma_3"]].to_numpy()
    assert attitude_angle(drawn, runs["sun"][:, 10:13]).max() < 1e-7
    other = -drawn / np.sum(drawn**2, axis=1, keepdims=True)
    distance = np.linalg.norm(body - drawn, axis=1)
    assert np.all(distance <= np.linalg.norm(body - other, axis=1) + 1e-12)


# Two of the document's times lie 131 and 182 s after a mode switch: the body is still turning then.
WITHIN = np.cos(np.radians(30.0))


@pytest.mark.parametrize("time", [300.0, 5600.0])
def test_scenes_show_the_panel_at_the_sun(trajectories, parameters, time):
    """Figs. 11 and 15: the solar panel's axis is within 30 deg of the Sun's direction."""
    mission = trajectories[trajectories["run"] == "mission"]
    data = scene_data(scene_in(parameters, mission, time)).set_index("item")
    assert data.loc["b3", "y"] > WITHIN


@pytest.mark.parametrize("time", [2100.0, 3400.0, 4400.0])
def test_scenes_point_the_sensor_or_the_antenna(trajectories, parameters, time):
    """Figs. 12 to 14: b1 towards Mars's centre, or -b1 to the mothercraft, within 30 deg."""
    mission = trajectories[trajectories["run"] == "mission"]
    scene = scene_in(parameters, mission, time)
    target = -scene.lmo if scene.mode == NADIR else scene.lmo - scene.gmo
    assert scene.body_axes[0] @ target / np.linalg.norm(target) > WITHIN
