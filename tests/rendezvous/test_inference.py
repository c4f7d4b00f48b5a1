"""The inference: sums of delta-v by hand, crossings, residuals, a search that can be repeated."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.inference.search import (
    FITTED,
    misfits,
    printed_steps,
    residuals,
    search,
    simulate_sets,
    with_values,
)
from smallsat.studies.rendezvous.inference.summary import acceptable, identified, profiles
from smallsat.studies.rendezvous.simulation.delta_v import READINGS, summed


@pytest.fixture(scope="module")
def flown(section):
    return simulate_sets([section])


def test_sums_of_delta_v():
    """3-4-12: lengths 13, components 19, in plane and normal 5 + 12."""
    change = np.array([[3.0, -4.0, 12.0]])
    assert summed(change, "2-norm") == pytest.approx(13.0)
    assert summed(change, "1-norm") == pytest.approx(19.0)
    assert summed(change, "plane and normal") == pytest.approx(17.0)
    # 3 s of three thrusters, 1 s of two, 8 s of one.
    assert summed(change, "resultant") == pytest.approx(3 * np.sqrt(3) + np.sqrt(2) + 8)
    with pytest.raises(ValueError, match="no reading"):
        summed(change, "3-norm")


def in_turned_axes(changes: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Velocity changes, (K, 3), in axes turned about the orbit's normal by an angle each, rad."""
    c, s = np.cos(angles), np.sin(angles)
    x, y, z = np.asarray(changes, dtype=float).reshape(-1, 3).T
    return np.column_stack([c * x + s * y, c * y - s * x, z])


def test_sums_are_ordered_and_turned_axes_keep_lengths():
    """2-norm <= resultant, plane and normal <= 1-norm; a turn changes only the components."""
    random = np.random.default_rng(3)
    changes = random.standard_normal((50, 3))
    sums = {reading: summed(changes, reading) for reading in READINGS}
    assert sums["2-norm"] <= sums["resultant"] <= sums["1-norm"]
    assert sums["2-norm"] <= sums["plane and normal"] <= sums["1-norm"]
    turned = in_turned_axes(changes, random.uniform(0, 6, 50))
    for reading in ("2-norm", "plane and normal"):
        assert summed(turned, reading) == pytest.approx(sums[reading])
    quarter = in_turned_axes([[1.0, 1.0, 0.0]], np.array([np.pi / 4]))
    assert summed(quarter, "1-norm") == pytest.approx(np.sqrt(2.0))


def test_printed_steps(section, ledger):
    """Whole steps of the nine phases."""
    steps = printed_steps(section, ledger("rendezvous"))
    assert [steps[case, "far"] for case in ("v-bar", "r-bar", "rotating")] == [39, 33, 31]
    assert [steps[case, "mid"] for case in ("v-bar", "r-bar", "rotating")] == [13, 14, 18]
    assert [steps[case, "final"] for case in ("v-bar", "r-bar", "rotating")] == [63, 62, 56]


def test_a_crossing_lies_in_the_last_step(flown):
    """The interpolated end lies after the last sample that did not end the phase."""
    ended = flown[flown["ended"]]
    assert len(ended) >= 9
    assert (ended["crossing"] <= ended["steps"]).all()
    assert (ended["crossing"] > ended["steps"] - 1).all()


def test_residuals_are_zero_where_the_printed_values_are_put_in(section, flown, ledger):
    """A made-up flight with the printed steps and delta-v misses nothing."""
    perfect = flown.copy()
    for row in residuals(section, flown, ledger("rendezvous")).to_dict("records"):
        case, phase, kind = ["", *row["cell"].split(" ")][-3:]
        own = (perfect["case"] == case) & (perfect["phase"] == phase)
        if kind == "steps":
            perfect.loc[own, "crossing"] = row["printed"] - 0.5
        elif own.any():
            perfect.loc[own, list(READINGS)] = row["printed"]
    perfect = perfect[perfect["case"] != "no-set-point"]
    assert misfits(section, perfect, ledger("rendezvous")).to_numpy() == pytest.approx(0.0)
    late = perfect.assign(crossing=perfect["crossing"] + 1.5)
    # One step beyond the last printed one, in each of nine phases.
    assert misfits(section, late, ledger("rendezvous"))["2-norm"].iloc[0] == pytest.approx(9.0)


def test_a_manoeuvre_that_does_not_end_is_a_bounded_miss(section, flown, ledger):
    """It counts as the worst residual in both of its cells, and as nothing worse."""
    lost = flown.copy()
    lost.loc[(lost["case"] == "v-bar") & (lost["phase"] == "final"), "ended"] = False
    table = residuals(section, lost, ledger("rendezvous"))
    own = table[table["cell"].str.startswith("v-bar final")]
    assert own[[f"residual {reading}" for reading in READINGS]].to_numpy() == pytest.approx(10.0)


def test_the_configured_set_beats_the_first_look(section, flown, ledger):
    """Every cell of the far and mid ranges within two steps and a tenth of delta-v."""
    table = residuals(section, flown, ledger("rendezvous"))
    reading = section.inferred.readings.delta_v
    near = table[table["cell"].str.contains("far|mid")]
    steps = near["cell"].str.endswith("steps")
    miss = near[f"computed {reading}"] - near["printed"]
    assert len(near) == 12
    assert (miss[steps].abs() <= 2).all(), near.to_string()
    assert (miss[~steps].abs() <= 0.1 * near["printed"][~steps]).all(), near.to_string()


@pytest.fixture(scope="module")
def small(section):
    inference = section.inference.with_(population=8, generations=1, chain=1)
    return section.with_(inference=inference)


def test_a_search_can_be_repeated_and_stays_within_its_bounds(small, ledger):
    """Seeded: the same table twice; the configured set is among those evaluated."""
    side = small.inferred.readings.r_bar
    first, second = (search(small, side, ledger("rendezvous")) for _ in range(2))
    pd.testing.assert_frame_equal(first, second)
    for name in FITTED:
        low, high = small.inference.bounds[name]
        assert first[name].between(low - 1e-9, high + 1e-9).all()
    own = misfits(small, simulate_sets([small]), ledger("rendezvous"))[
        small.inferred.readings.delta_v
    ].iloc[0]
    assert first["misfit"].min() <= own * (1 + 1e-6)


def test_what_is_identified_is_read_off_the_acceptable_sets(section):
    """A parameter that decides the misfit is identified, one that does not is free."""
    random = np.random.default_rng(0)
    bounds = section.inference.bounds
    table = pd.DataFrame({name: random.uniform(*bounds[name], 3000) for name in FITTED})
    low, high = bounds.keep_out_m
    table["misfit"] = 1.0 + (20.0 * (table["keep_out_m"] - (low + high) / 2) / (high - low)) ** 2
    found = identified(section, table).set_index("parameter")["verdict"]
    assert found["keep_out_m"] == "identified"
    assert found["plane_rate"] == "free"
    limit = section.inference.acceptable
    assert (acceptable(section, table)["misfit"] <= limit * table["misfit"].min()).all()
    envelope = profiles(section, table)
    own = envelope[envelope["parameter"] == "keep_out_m"]
    assert own["misfit"].idxmin() in own.index[4:8]


def test_readings_replace_only_what_they_name(section):
    """The first switch is one of three; the rest of the section stays."""
    changed = with_values(section, {"plane_rate": 1.5}, {"first_switch": "distance"})
    before, after = section.inferred, changed["inferred"]
    assert after.readings.switches == ("distance", *before.readings.switches[1:])
    assert after.plane_rate == 1.5
    assert section.inferred.plane_rate == before.plane_rate != 1.5
