"""Statistical claims: intervals that cover, and outcomes that can be any of the three."""

import numpy as np
import pytest

from smallsat.evidence.effects import above, together, within
from smallsat.statistics.bootstrap import Bootstrap, Effect, effect

BOOTSTRAP = Bootstrap(resamples=1000, confidence=0.95, seed=7)


def mean_of(values):
    return lambda drawn: values[drawn].mean(axis=1)


def test_interval_of_a_mean_covers_the_truth_as_often_as_it_says():
    """200 samples of 100 from a normal law: coverage of the 95 % interval within 90 to 99 %."""
    random = np.random.default_rng(1)
    hits = 0
    for _ in range(200):
        found = effect("mean", mean_of(random.normal(3.0, 1.0, 100)), 100, BOOTSTRAP)
        hits += found.low < 3.0 < found.high
    assert 180 <= hits <= 198


def test_comparisons_widen_the_interval():
    """Twelve intervals that must hold together are wider than one alone."""
    values = np.random.default_rng(2).normal(size=80)
    one = effect("mean", mean_of(values), 80, BOOTSTRAP)
    twelve = effect("mean", mean_of(values), 80, BOOTSTRAP, comparisons=12)
    assert twelve.low < one.low and twelve.high > one.high


@pytest.mark.parametrize(
    ("shift", "outcome"), [(1.0, "holds"), (0.0, "undecided"), (-1.0, "fails")]
)
def test_a_claimed_rise_is_held_failed_or_left_open(shift, outcome):
    """The same scatter with a clear rise, none, and a clear fall."""
    values = np.random.default_rng(3).normal(size=100)
    values += shift - values.mean()
    assert above([effect("mean", mean_of(values), 100, BOOTSTRAP)]) == outcome


@pytest.mark.parametrize(
    ("value", "half_width", "outcome"),
    [(0.01, 0.02, "holds"), (0.04, 0.02, "undecided"), (-0.2, 0.02, "fails")],
)
def test_equality_needs_the_whole_interval_within_the_margin(value, half_width, outcome):
    """A margin of 0.05: inside, across, beyond."""
    found = Effect("change", value, value - half_width, value + half_width, 50)
    assert within([found], 0.05) == outcome


def test_few_units_decide_nothing():
    """Five units, all with the same value: no interval, and no outcome."""
    found = effect("mean", mean_of(np.ones(5)), 5, BOOTSTRAP)
    assert found.low == found.high == 1.0
    assert above([found]) == "undecided" and within([found], 2.0) == "undecided"
    assert above([effect("mean", mean_of(np.ones(0)), 0, BOOTSTRAP)]) == "undecided"


def test_parts_of_a_claim():
    """One failing part fails the whole; one open part leaves it open."""
    assert together("holds", "holds") == "holds"
    assert together("holds", "undecided") == "undecided"
    assert together("undecided", "fails") == "fails"
