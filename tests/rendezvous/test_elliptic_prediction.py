"""Predictions near an elliptic orbit, compared: the two-body motion, and what follows from it."""

import numpy as np
import pytest

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.orbits.kepler_orbits import Elements, Gravity, propagate_orbit, state_of
from smallsat.studies.rendezvous.methods.elliptic_prediction import (
    MODELS,
    at_horizons,
    errors,
    look_aheads,
    motions,
)
from smallsat.studies.rendezvous.model.environment import orbit_radius
from smallsat.studies.rendezvous.model.truth import pair_from_relative, relative_state


@pytest.fixture
def small(section):
    """Few states and places, and times up to an hour."""
    elliptic = section.elliptic.with_(
        eccentricities=(0.0, 0.1, 0.73), states=3, anomalies=4, look_ahead_s=(30.0, 900.0, 3600.0)
    )
    return section.with_(elliptic=elliptic)


@pytest.mark.parametrize("e", [0.1, 0.73])
def test_motion_is_that_of_two_bodies(small, chaser, e):
    """From the perigee, against Dormand and Prince's method at 1e-12, to 0.1 mm after an hour.

    The step of integration is that of the study, and the perigee is where it is longest.
    """
    orbit, field = small.truth, Gravity(egm96.MU, egm96.RADIUS, 0.0)
    radius = orbit_radius(small.inferred.mean_motion_rad_s)
    tilt, node = np.radians([orbit.inclination_deg, orbit.raan_deg])
    target = np.concatenate(state_of(Elements(radius / (1 - e), e, tilt, node, 0.0, 0.0), egm96.MU))
    pair = pair_from_relative(target, chaser)
    times = np.array([0.0, *look_aheads(small)])
    alone = np.array([propagate_orbit(body[:3], body[3:], field, times) for body in pair])
    expected = [relative_state(np.ascontiguousarray(alone[:, k])) for k in range(1, len(times))]
    found = motions(small, e, 0.0, chaser[None])[:, 0]
    assert np.abs(found - expected)[:, :3].max() < 1e-4


def test_models_agree_on_a_circle_and_there_alone(small):
    """To 1e-9 of a metre at e = 0; at 0.1 the elliptic one is a hundred times as good at 900 s."""
    table = errors(small)
    assert len(table) == 3 * len(look_aheads(small)) * len(MODELS)
    assert (table["low_m"] <= table["median_m"]).all()
    assert (table["median_m"] <= table["high_m"]).all()
    median = table.pivot(index=["eccentricity", "look_ahead_s"], columns="model", values="median_m")
    *circular, elliptic = MODELS
    for model in circular:
        np.testing.assert_allclose(median.loc[0.0, model], median.loc[0.0, elliptic], atol=1e-9)
        assert median.loc[(0.1, 900.0), model] > 100.0 * median.loc[(0.1, 900.0), elliptic]
    horizons = at_horizons(small, table).set_index(["eccentricity", "model"])
    assert len(horizons) == 3 * len(MODELS)
    assert horizons.loc[(0.1, elliptic), "far_m"] == median.loc[(0.1, 900.0), elliptic]
