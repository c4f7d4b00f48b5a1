"""The inference: sums of delta-v by hand, crossings, residuals, a search that can be repeated."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.inference import axes_search, posterior
from smallsat.studies.rendezvous.inference.axes import axes, missed_axes
from smallsat.studies.rendezvous.inference.axes_held import CONFIGURED, FOUND, compared
from smallsat.studies.rendezvous.inference.misfit import (
    WORST_SHARE,
    misfits,
    printed_steps,
    residuals,
    simulate_sets,
)
from smallsat.studies.rendezvous.inference.parameter_set import (
    FITTED,
    OPTIONS,
    SEARCHES,
    ParameterSet,
    fixed_reading,
    member,
)
from smallsat.studies.rendezvous.inference.search import evaluate, search
from smallsat.studies.rendezvous.inference.summary import (
    acceptable,
    identified,
    kept,
    profiles,
    trade_offs,
)
from smallsat.studies.rendezvous.monte_carlo.initial_states import distribution, initial_states
from smallsat.studies.rendezvous.simulation.delta_v import READINGS, summed


@pytest.fixture(scope="module")
def starts(section):
    """Two initial states of chapter 4."""
    return initial_states(2, 4, distribution(section.studies), section.inferred.mean_motion_rad_s)


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
    table = residuals([section], flown, ledger("rendezvous"))
    for row in table[table["kind"] == "cell"].to_dict("records"):
        case, phase, kind = ["", *row["cell"].split(" ")][-3:]
        own = (perfect["case"] == case) & (perfect["phase"] == phase)
        if kind == "steps":
            perfect.loc[own, "crossing"] = row["printed"] - 0.5
        elif own.any():
            perfect.loc[own, list(READINGS)] = row["printed"]
    perfect = perfect[perfect["case"] != "no-set-point"]

    def missed(flight):
        found = residuals([section], flight, ledger("rendezvous"))
        return misfits(found[found["kind"] == "cell"])

    assert missed(perfect).to_numpy() == pytest.approx(0.0)
    late = perfect.assign(crossing=perfect["crossing"] + 1.5)
    # One step beyond the last printed one, in each of nine phases.
    assert missed(late)["2-norm"].iloc[0] == pytest.approx(9.0)


def test_steps_without_a_solution_are_missed_by_their_share(section, flown, ledger):
    """None: nothing; the assumed share: one error; all: the worst, whatever the phase."""
    assumed = section.inference.infeasible_share
    for share, miss in ((0.0, 0.0), (assumed, 1.0), (1.0, WORST_SHARE)):
        table = residuals(
            [section], flown.assign(infeasible=share * flown["steps"]), ledger("rendezvous")
        )
        own = table[table["kind"] == "feasibility"]
        assert len(own) == 12
        assert own["residual 2-norm"].to_numpy() == pytest.approx(miss)


def test_what_the_text_prefers_is_missed_by_its_distance(section, flown, ledger):
    """On the boundary, at the switch, within the nearest start: nothing; else in errors."""
    inference = section.inference

    def missed(**values):
        changed = section.with_(inferred=section.inferred.with_(**values))
        table = residuals([changed], flown, ledger("rendezvous"))
        return table[table["kind"] == "text"].set_index("cell")["residual 2-norm"]

    at = missed(set_point_1=1.0, set_point_2=1.02, switch_2=1.02, keep_out_m=150.0)
    assert at.to_numpy() == pytest.approx(0.0)
    off = missed(
        set_point_1=1.0 - inference.on_boundary,
        set_point_2=1.0 - 2 * inference.just_behind,
        switch_2=1.0,
        keep_out_m=150.0 + 2350.0 * inference.infeasible_share,
    )
    assert off["set point 1 / r1"] == pytest.approx(-1.0)
    assert off["set point 2 / switch 2"] == pytest.approx(2.0)
    assert off["starts inside the zone"] == pytest.approx(1.0)


def test_data_within_the_printed_axes_miss_nothing(section, starts, ledger):
    """A shorter axis is missed by the logarithm of what lies beyond it."""
    printed = ledger("rendezvous")
    found = axes(section, starts, printed).set_index("cell")
    assert len(found) == 9
    row = found.loc["Figure 4.10 intervals most"]
    assert 1 <= row["computed 2-norm"] < 1000
    expected = max(np.log(row["computed 2-norm"] / row["printed"]), 0.0)
    expected = min(expected / section.inference.axis_error, WORST_SHARE)
    assert row["residual 2-norm"] == pytest.approx(expected)
    # No start: no data, the worst everywhere.
    none = axes(section, starts[:0], printed)
    assert none["residual 2-norm"].to_numpy() == pytest.approx(WORST_SHARE)
    # A set whose axes are not looked at is no better than that.
    assert (none["residual 2-norm"] ** 2).sum() == pytest.approx(missed_axes(printed))


def test_a_manoeuvre_that_does_not_end_is_a_bounded_miss(section, flown, ledger):
    """It counts as the worst residual in both of its cells, and as nothing worse."""
    lost = flown.copy()
    lost.loc[(lost["case"] == "v-bar") & (lost["phase"] == "final"), "ended"] = False
    table = residuals([section], lost, ledger("rendezvous"))
    own = table[table["cell"].str.startswith("v-bar final") & (table["kind"] == "cell")]
    assert own[[f"residual {reading}" for reading in READINGS]].to_numpy() == pytest.approx(10.0)


def test_every_option_of_every_reading_has_a_search():
    """Names that a rule can have, each with its own option."""
    assert len(set(SEARCHES)) == sum(len(options) for options in OPTIONS.values())
    assert {fixed_reading(name) for name in SEARCHES} == {
        (reading, option) for reading, options in OPTIONS.items() for option in options
    }


def test_a_set_is_what_its_row_says(section):
    """To a row and back; put into the section it changes only what it names."""
    one = ParameterSet.configured(section)
    other = ParameterSet(
        {**one.values, "keep_out_m": 111.0},
        {**one.readings, "reference_moves": not one.readings["reference_moves"]},
    )
    assert ParameterSet.of_row(other.row) == other
    changed = other.put_into(section)
    assert changed.inferred.keep_out_m == 111.0
    assert changed.inferred.readings.reference_moves == other.readings["reference_moves"]
    assert one.put_into(changed) == section


def test_a_member_of_the_ensemble_is_flown_smaller(section):
    """The set with its own sum of delta-v, and the sizes of the ensemble."""
    row = ParameterSet.configured(section).row | {"delta_v": "1-norm"}
    found = member(section, row)
    assert found.inferred.readings.delta_v == "1-norm"
    assert found.studies.samples == section.inference.ensemble.samples
    assert found.studies.robustness.runs == section.inference.ensemble.runs


@pytest.fixture(scope="module")
def small(section):
    return section.with_(inference=section.inference.with_(population=8, generations=1))


def test_a_search_can_be_repeated_and_holds_its_reading(small, starts, ledger):
    """Seeded: the same table twice, within the bounds; the configured set is among them."""
    printed = ledger("rendezvous")
    one = ParameterSet.configured(small)
    begin = pd.DataFrame([one.row])
    name = SEARCHES[0]
    reading, option = fixed_reading(name)
    first, second = (search(small, name, begin, starts, printed) for _ in range(2))
    pd.testing.assert_frame_equal(first, second)
    assert (first[reading] == str(option)).all()
    for number in FITTED:
        low, high = small.inference.bounds[number]
        assert first[number].between(low - 1e-9, high + 1e-9).all()
    held = ParameterSet(one.values, {**one.readings, reading: option})
    own = evaluate(small, [held], starts, printed)["misfit"].iloc[0]
    assert first["misfit"].min() <= own * (1 + 1e-6)


def test_what_is_lost_before_an_axis_misses_all_of_them(section, starts, ledger):
    """The excess is the sum of squares; no start of which nothing is seen makes it less."""
    printed = ledger("rendezvous")
    found = axes(section, starts, printed)
    assert (found["lost"] == 0).all()
    squares = (found["residual 2-norm"] ** 2).sum()
    assert axes_search.excesses(found, printed)["2-norm"] == pytest.approx(squares)
    lost = axes_search.excesses(found.assign(lost=1), printed)
    assert lost.to_numpy() == pytest.approx(missed_axes(printed))


def test_the_ends_of_the_axes_name_their_starts(section, starts, ledger):
    """Flown alone, the start that is named gives the same end."""
    printed = ledger("rendezvous")
    found = axes(section, starts, printed).set_index("cell")
    for cell in ("Figure 4.7 delta_v_m_s most", "Figure 4.10 time_min least"):
        place = int(found.loc[cell, "start 2-norm"])
        alone = axes(section, starts[[place]], printed).set_index("cell")
        assert alone.loc[cell, "computed 2-norm"] == found.loc[cell, "computed 2-norm"]


@pytest.fixture(scope="module")
def searched(section, starts, ledger):
    """Two rounds, of which the first looks at one start; made twice."""
    size = section.inference.axes_search.with_(rounds=2, population=8, generations=0, starts=1)
    small = section.with_(inference=section.inference.with_(axes_search=size))
    kept_sets = pd.read_csv("data/accepted/rendezvous/sets.csv").tail(2)
    printed = ledger("rendezvous")
    return [axes_search.search_axes(small, kept_sets, starts, printed) for _ in range(2)]


def test_the_search_for_the_axes_can_be_repeated_and_takes_starts_on(searched, section):
    """Seeded; sets within the axes have a misfit and others none; states beyond are looked at."""
    first, second = searched
    pd.testing.assert_frame_equal(first, second)
    assert (first["axes_of_all"] >= first["axes"] - 1e-12).all()
    assert (first["misfit"].notna() == (first["axes"] == 0.0)).all()
    assert list(first["starts"]) == [1, 1 + (first["axes_of_all"].iloc[0] > 0.0)]
    low, high = section.inference.bounds.keep_out_m
    assert first["keep_out_m"].between(low, high).all()


def test_the_found_set_is_held_against_the_axes_and_the_rest(searched, section, starts, ledger):
    """The round with the least excess from all states; its misfit is that of its parts."""
    printed = ledger("rendezvous")
    tables = compared(section, searched[0], starts, printed)
    sets = tables["axes-sets"].set_index("set")
    assert sets.loc[FOUND, "axes"] == pytest.approx(searched[0]["axes_of_all"].min())
    parts = sets[["cell", "feasibility", "text"]].sum(axis=1)
    assert sets["misfit"].to_numpy() == pytest.approx(parts.to_numpy())
    own = axes(section, starts, printed)
    reading = section.inferred.readings.delta_v
    np.testing.assert_array_equal(tables["axes-ends"][CONFIGURED], own[f"computed {reading}"])


def made_up(section, count=3000):
    """Sets all over the bounds, of which only r1 and one reading decide the misfit."""
    random = np.random.default_rng(0)
    bounds = section.inference.bounds
    table = pd.DataFrame({name: random.uniform(*bounds[name], count) for name in FITTED})
    for name, options in OPTIONS.items():
        table[name] = random.choice([str(option) for option in options], count)
    low, high = bounds.keep_out_m
    table["misfit"] = 1.0 + (20.0 * (table["keep_out_m"] - (low + high) / 2) / (high - low)) ** 2
    table.loc[table["r_bar"] == "above", "misfit"] += 100.0
    table["delta_v"] = "2-norm"
    for kind in ("cell", "feasibility", "text", "axes"):
        table[kind] = table["misfit"] / 4
    return table


def test_what_is_identified_is_read_off_the_acceptable_sets(section):
    """A parameter that decides the misfit is identified, one that does not is free."""
    table = made_up(section)
    found = identified(section, table).set_index("parameter")["verdict"]
    assert found["keep_out_m"] == "identified"
    assert found["end_distance_m"] == "free"
    limit = section.inference.acceptable
    assert (acceptable(section, table)["misfit"] <= limit * table["misfit"].min()).all()
    envelope = profiles(section, table)
    own = envelope[envelope["parameter"] == "keep_out_m"]
    assert own["misfit"].idxmin() in own.index[4:8]


def test_trade_offs_are_the_best_within_each_bound(section):
    """Sets that hold the axes miss the cells; a bound below all has none."""
    axes = np.geomspace(1.5, 100.0, 50)
    parts = {"cell": 100.0 / axes, "feasibility": 5.0, "text": 1.0, "axes": axes}
    table = pd.DataFrame(parts).assign(misfit=sum(parts.values()))
    found = trade_offs(table).set_index(["held", "at_most"])
    assert found.loc[("axes", 1.0), "sets"] == 0 and np.isnan(found.loc[("axes", 1.0), "misfit"])
    assert found.loc[("axes", 2.0), "misfit"] > found.loc[("axes", 10.0), "misfit"]
    assert found.loc[("axes", 50.0), "misfit"] == table["misfit"].min()
    assert (found.loc["feasibility", "sets"].to_numpy() == [0, 0, 50, 50, 50, 50]).all()


def test_the_ensemble_spans_the_acceptable_readings(section):
    """The best set first, every option that is acceptable, none that is not; then the others."""
    found = kept(section, made_up(section))
    ensemble = found.head(section.inference.ensemble.sets)
    assert ensemble["acceptable"].all()
    assert found["misfit"].iloc[0] == found["misfit"].min()
    for reading, options in OPTIONS.items():
        expected = {"below"} if reading == "r_bar" else {str(option) for option in options}
        assert set(ensemble[reading]) == expected
    assert "above" in set(found[~found["acceptable"]]["r_bar"])


def test_the_kept_sets_span_every_option(section):
    """Those that the project keeps of its long search, with which its searches begin."""
    table = pd.read_csv("data/accepted/rendezvous/sets.csv")
    for reading, options in OPTIONS.items():
        assert set(table[reading].astype(str)) == {str(option) for option in options}
    assert table["acceptable"].head(section.inference.ensemble.sets).all()


def test_the_walk_finds_a_posterior_that_is_known(section, ledger, monkeypatch):
    """Misfits of a paraboloid: means to 0.2 deviations, deviations to 15 %, and steps go on.

    The misses add up to as many as there are beside the numbers, so that nothing is inflated.
    """
    bounds = section.inference.bounds
    low, high = np.array([bounds[name] for name in FITTED], dtype=float).T
    centre, width = 0.5 * (low + high), 0.02 * (high - low)

    def paraboloid(section, sets, starts, ledger):
        places = np.array([[one.values[name] for name in FITTED] for one in sets])
        return pd.DataFrame({"misfit": (((places - centre) / width) ** 2).sum(axis=1)})

    missed = pd.DataFrame({"residual": np.full(2 * len(FITTED), np.sqrt(0.5))})
    monkeypatch.setattr(posterior, "evaluate", paraboloid)
    monkeypatch.setattr(posterior, "configured_residuals", lambda *_: missed)
    walkers = section.inference.posterior.with_(walkers=60, steps=600)
    inference = section.inference.with_(posterior=walkers)
    at_centre = section.inferred.with_(**dict(zip(FITTED, centre.tolist(), strict=True)))
    given = section.with_(inference=inference, inferred=at_centre)
    nothing = pd.DataFrame(columns=["step", "walker", *FITTED, "misfit"])
    first = posterior.walk(given, nothing, np.zeros((1, 6)), ledger("rendezvous"))
    walked = posterior.walk(given, first, np.zeros((1, 6)), ledger("rendezvous"))
    assert list(walked["step"].unique()) == list(range(601, 1201))
    found = (walked[FITTED] - centre) / width
    assert np.abs(found.mean()).max() < 0.2
    assert np.abs(found.std() - 1.0).max() < 0.15
    table = posterior.marginals(walked).set_index("parameter")
    spread = (table["posterior_high"] - table["posterior_low"]) / (2 * 1.645 * width)
    assert np.abs(spread - 1.0).max() < 0.2
