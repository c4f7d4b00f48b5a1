"""Shadow, sight and link over the day, against closed forms and by hand."""

import numpy as np
import pytest

from smallsat.dynamics.orbits.circular_orbits import orbit_frame
from smallsat.studies.mars.methods import light
from smallsat.studies.mars.model.light import conditions, in_shadow, in_sight


@pytest.fixture(scope="module")
def intervals(section, parameters):
    return light.day_conditions(section, parameters)


@pytest.fixture(scope="module")
def summary(section, intervals):
    return light.summary(section, intervals).set_index("condition")


def test_shadow_of_an_orbit_in_closed_form(parameters, summary):
    """Of a revolution in a plane that leans by b to the Sun, 2 acos(c) / 2 pi lies in the cylinder.

    With c = sqrt(1 - (R / r)^2) / cos b; to the 0.2 % that the day's part of a revolution makes.
    """
    lmo = parameters.lmo
    sine = abs(np.array(orbit_frame(lmo, 0.0)[2])[1])
    c = np.sqrt(1.0 - (parameters.mars_radius / lmo.radius) ** 2) / np.sqrt(1.0 - sine**2)
    assert summary["share_percent"]["shadow of Mars"] == pytest.approx(
        100.0 * np.arccos(c) / np.pi, abs=0.3
    )
    assert summary["share_percent"]["night side"] == pytest.approx(50.0, abs=0.3)


def test_sight_is_as_wide_as_both_horizons(parameters):
    """The planet leaves the line free up to the sum of both horizons' angles, and not beyond."""
    times = np.arange(0.0, 20000.0, 7.0)
    found = conditions(parameters, times)
    lmo, gmo = (
        np.array([orbit_frame(orbit, t)[0] for t in times])
        for orbit in (parameters.lmo, parameters.gmo)
    )
    angles = np.arccos(np.sum(lmo * gmo, axis=1))
    edge = sum(
        np.arccos(parameters.mars_radius / orbit.radius)
        for orbit in (parameters.lmo, parameters.gmo)
    )
    np.testing.assert_array_equal(found["sight"], angles <= edge)
    np.testing.assert_array_equal(found["visible"], angles <= parameters.visibility)


def test_by_hand():
    """Behind the planet and beside it, before it and between."""
    assert in_shadow((0.5, -3.0, 0.0), 1.0)
    assert not in_shadow((0.5, 3.0, 0.0), 1.0)
    assert not in_shadow((1.5, -3.0, 0.0), 1.0)
    assert in_sight((2.0, 0.0, 0.0), (5.0, 0.0, 0.0), 1.0)
    assert not in_sight((2.0, 0.0, 0.0), (-5.0, 0.0, 0.0), 1.0)
    assert in_sight((2.0, 1.1, 0.0), (-5.0, 1.1, 0.0), 1.0)


def test_intervals_are_the_modes_of_the_mission(section, intervals, summary):
    """Night and link by the document's rule are what its state machine goes by, to a step."""
    for name in ("night side", "link by Table 1"):
        chosen = intervals[intervals["condition"] == name]
        lengths = chosen["end_s"] - chosen["start_s"]
        assert summary["share_percent"][name] == pytest.approx(
            100.0 * lengths.sum() / section.durations_s.day
        )
        assert (chosen["start_s"].to_numpy()[1:] > chosen["end_s"].to_numpy()[:-1]).all()
    night = intervals[intervals["condition"] == "night side"].iloc[0]
    # Fig. 10's first two switches.
    assert night["start_s"] == 1918.0


def test_what_never_holds(section, parameters, changed):
    """No interval, no share, and the whole day without."""
    blind = changed(section, "visibility_deg", 0.0)
    found = light.day_conditions(blind, type(parameters).from_section(blind))
    row = light.summary(blind, found).set_index("condition").loc["link by Table 1"]
    assert row["intervals"] == 0
    assert row["longest_without_s"] == section.durations_s.day
