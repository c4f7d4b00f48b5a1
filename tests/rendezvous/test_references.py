"""Both bodies' motion against Basilisk's (`tests/references`), over an orbit.

Tolerances were set before the comparison, from what Basilisk does in a step of 0.05 s: it turns
the Earth linearly, which shifts an orbit by some tenths of a millimetre and two alike, and holds
air and wind, a hundred thousandth of a drag that shifts them by metres.
"""

from itertools import pairwise

import numpy as np
import pytest

from smallsat.results import read_table
from smallsat.strict_yaml import read_yaml
from smallsat.studies.rendezvous.configuration import Truth
from smallsat.studies.rendezvous.model.environment import EARTH_RATE, environment, target_state
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state

NO_THRUST = np.zeros(3)


@pytest.fixture(scope="module")
def settings(root):
    return read_yaml(root / "tests/references/orbits.yaml")


@pytest.fixture(scope="module")
def truth(settings):
    return Truth(**settings["truth"])


@pytest.fixture(scope="module")
def reference(root):
    return read_table(root / "tests/references/basilisk-orbits.csv")


@pytest.fixture(scope="module")
def flown(settings, truth, reference):
    """Inertial states of both, (n, 2, 6), at the reference's times, with a factor of the air."""

    def fly(density_factor):
        surroundings = environment(
            truth.with_(density_factor=density_factor),
            settings["mean_motion_rad_s"],
            settings["mass_kg"],
        )
        pair = np.array([settings["states"][name] for name in ("target", "chaser")])
        times = np.sort(reference["time_s"].unique())
        states = [pair.copy()]
        for start, end in pairwise(times):
            advance(pair, start, end - start, NO_THRUST, NO_THRUST, surroundings)
            states.append(pair.copy())
        return np.array(states)

    return fly


def states_of(reference, run):
    rows = reference[reference["run"] == run].drop(columns=["run", "time_s"]).to_numpy()
    return rows.reshape(len(rows), 2, 6)


def relative(states):
    return np.array([relative_state(pair) for pair in states])


def test_settings_are_the_study_s_own(settings, truth):
    """What Basilisk was given as numbers is what the study's model makes of the same truth."""
    mean_motion = settings["mean_motion_rad_s"]
    made = environment(truth, mean_motion, settings["mass_kg"])
    air = settings["air"]
    given = [air["density_kg_m3"], air["radius_m"], air["scale_height_m"]]
    assert given == pytest.approx([made.density, made.density_radius, made.scale_height])
    assert settings["earth_rate_rad_s"] == EARTH_RATE
    pair = pair_from_relative(target_state(truth, mean_motion), np.array(settings["start"]))
    states = [settings["states"][name] for name in ("target", "chaser")]
    np.testing.assert_allclose(states, pair, rtol=1e-14)


@pytest.mark.parametrize(
    ("run", "factor", "orbit_m", "relative_m"),
    [("field", 0.0, 1e-3, 1e-4), ("field and drag", 1.0, 1e-2, 2e-3)],
)
def test_orbits(reference, flown, run, factor, orbit_m, relative_m):
    """8x8 field to 1 mm and 0.1 mm between the two, with drag on all facets to 10 mm and 2 mm."""
    expected, found = states_of(reference, run), flown(factor)
    assert abs(found - expected)[:, :, :3].max() < orbit_m
    difference = relative(found) - relative(expected)
    assert abs(difference[:, :3]).max() < relative_m
    # Over an orbit a velocity that is off by so much moves a body by that far.
    assert abs(difference[:, 3:]).max() < 2e-3 * relative_m


def test_drag_is_seen(reference, flown):
    """Without air the study misses the orbits with drag by 1 m or more, their distance by 0.1 m."""
    expected, found = states_of(reference, "field and drag"), flown(0.0)
    assert abs(found - expected)[:, :, :3].max() > 1.0
    assert abs(relative(found) - relative(expected))[:, :3].max() > 0.1
