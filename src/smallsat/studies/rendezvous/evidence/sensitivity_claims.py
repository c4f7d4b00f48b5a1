"""Predicates of what chapter 4 says in words, each a statistical test fixed before the run.

Cases are compared on the same initial states, over those that complete in both; changes are
relative to the first case. Every interval comes from resampling initial states, and the intervals
of one claim hold together with the configured confidence. A claim *holds* if all of its intervals
lie on the claimed side, *fails* if one lies on the other side, and is *undecided* else.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeVar

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.effects import above, below, judgement, negative, together, within
from smallsat.evidence.grounds import Grounds
from smallsat.statistics.bootstrap import Effect, Statistic
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.ensemble import over_ensemble
from smallsat.studies.rendezvous.evidence.sweeps import (
    DELTA_V,
    STEPS,
    TIME,
    Domain,
    Sweep,
    group_difference,
    infeasible_share,
    mean,
    median,
)
from smallsat.studies.rendezvous.inference.axes import printed_axes
from smallsat.studies.rendezvous.monte_carlo.cases import PHASES
from smallsat.studies.rendezvous.monte_carlo.tables import column, totals

# What words are taken to mean. Extremes are quantiles, for the extreme of a sample grows with it.
LOWEST, HIGHEST = 0.05, 0.95  # "minimum" and "maximum"
SIMILAR = 0.05  # "similar", "no appreciable difference": relative change of the median
NOT_MUCH = 0.10  # "not much difference"
DRAMATIC = 0.25  # "dropped dramatically"
TINY = 0.05  # "relatively tiny", of the range of the other phases
ALONE = 0.5  # share of the variance from which one could speak of a range by quadrant
ON_BOUNDARY = 0.05  # relative distance from the keep-out sphere
AT_REST_M_S = 0.05  # "converging to a point"

Number = TypeVar("Number", int, float)


def _tested(values: Sequence[Number], least: int, most: int | None = None) -> Sequence[Number]:
    """Horizons or sample times that a claim names by their places in the document's list.

    Raises
    ------
    LookupError
        If the run has other numbers of them, so that the places mean something else.
    """
    if len(values) < least or (most is not None and len(values) > most):
        raise LookupError(f"{len(values)} values where the claim speaks of {least}")
    return values


def _falls(effects: list[Effect], reading: str) -> Judgement:
    return judgement(above(negative(effects)), reading, effects)


def _rises(effects: list[Effect], reading: str) -> Judgement:
    return judgement(above(effects), reading, effects)


# Section 4.1: where the manoeuvre begins.


@over_ensemble
def quadrants_behind_take_longer(grounds: Grounds) -> Judgement:
    """Section 4.1: median time, quadrants 3 and 4 less 1 and 2."""
    d = Domain(grounds)
    found = [d.effect("time, s", group_difference(d.time, d.behind, ~d.behind, 0.5))]
    return _rises(found, "median, quadrants 3 and 4 less 1 and 2")


@over_ensemble
def quadrants_behind_have_higher_minimum(grounds: Grounds) -> Judgement:
    """Section 4.1: lower bound of delta-v, quadrants 3 and 4 less 1 and 2."""
    d = Domain(grounds)
    found = [d.effect("delta-v, m/s", group_difference(d.delta_v, d.behind, ~d.behind, LOWEST))]
    return _rises(found, "5 % quantile, quadrants 3 and 4 less 1 and 2")


@over_ensemble
def quadrant_matters_less_for_maximum(grounds: Grounds) -> Judgement:
    """Section 4.1: the shift of the lower bound of delta-v less that of the upper one."""
    d = Domain(grounds)
    lower = group_difference(d.delta_v, d.behind, ~d.behind, LOWEST)
    upper = group_difference(d.delta_v, d.behind, ~d.behind, HIGHEST)
    found = d.effect("delta-v, m/s", _sizes_differ(lower, upper))
    return _rises([found], "shift of the 5 % quantile by quadrant less that of the 95 % one")


def _sizes_differ(one: Statistic, other: Statistic) -> Statistic:
    return lambda drawn: np.abs(one(drawn)) - np.abs(other(drawn))


@over_ensemble
def quadrant_alone_gives_no_range(grounds: Grounds) -> Judgement:
    """Section 4.1: share of the variance of delta-v and time that the quadrant explains."""
    d = Domain(grounds)
    found = [
        d.effect(name, _explained(values, d.quadrant), 2)
        for name, values in (("delta-v", d.delta_v), ("time", d.time))
    ]
    return judgement(
        together(*(below([one], ALONE) for one in found)),
        "share of the variance that the quadrant explains, to be below one half",
        found,
    )


def _explained(values: np.ndarray, group: np.ndarray) -> Statistic:
    """Statistic: the variance between groups as a share of the whole."""

    def statistic(drawn: np.ndarray) -> np.ndarray:
        drawn_values, drawn_group = values[drawn], group[drawn]
        mean = drawn_values.mean(axis=1, keepdims=True)
        between = np.zeros(len(drawn))
        for one in np.unique(group):
            inside = drawn_group == one
            size = np.maximum(inside.sum(axis=1), 1)
            of_group = np.where(inside, drawn_values, 0.0).sum(axis=1) / size
            between += inside.sum(axis=1) * (of_group - mean[:, 0]) ** 2
        return between / ((drawn_values - mean) ** 2).sum(axis=1)

    return statistic


@over_ensemble
def distance_raises_minimum(grounds: Grounds) -> Judgement:
    """Section 4.1: lower bounds of delta-v and time, farthest third less nearest third."""
    d = Domain(grounds)
    found = [
        d.effect(name, group_difference(values, d.far, d.near, LOWEST), 2)
        for name, values in (("delta-v, m/s", d.delta_v), ("time, s", d.time))
    ]
    return _rises(found, "5 % quantile, farthest third less nearest third")


@over_ensemble
def distance_matters_more_for_maximum(grounds: Grounds) -> Judgement:
    """Section 4.1: shift of the upper bound of delta-v by distance less that by quadrant."""
    d = Domain(grounds)
    by_distance = group_difference(d.delta_v, d.far, d.near, HIGHEST)
    by_quadrant = group_difference(d.delta_v, d.behind, ~d.behind, HIGHEST)
    found = d.effect("delta-v, m/s", _sizes_differ(by_distance, by_quadrant))
    return _rises([found], "shift of the 95 % quantile by distance less that by quadrant")


# Section 4.2: the rendezvous phase.


def _across(grounds: Grounds, phase: str, quantity: str) -> list[Effect]:
    """Changes from the shortest to the longest sample time, one a horizon."""
    sweep = Sweep(grounds, phase)
    first, *_, last = sweep.sample_times
    count = len(sweep.horizons)
    return [sweep.change(quantity, (n, first), (n, last), count) for n in sweep.horizons]


@over_ensemble
def longer_sampling_saves_rendezvous(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v from the shortest to the longest sample time, each horizon."""
    return _falls(_across(grounds, "rendezvous", DELTA_V), "median change")


@over_ensemble
def savings_diminish(grounds: Grounds) -> Judgement:
    """Section 4.2: the last interval of sample times saves less than every other one."""
    sweep = Sweep(grounds, "rendezvous")
    *others, last = pairwise(sweep.sample_times)
    if not others:
        raise LookupError("sample times")
    count = len(others) * len(sweep.horizons)
    found = []
    for n in sweep.horizons:
        for interval in others:
            a, b, c, d = sweep.values(DELTA_V, *[(n, t) for t in (*interval, *last)])
            first, second = median((b - a) / a), median((d - c) / c)
            name = f"N {n}, {interval[0]:g} to {interval[1]:g} s"
            found.append(sweep.effect(name, _difference(second, first), len(a), count))
    return _rises(found, "median change of delta-v in the last interval less that in")


def _difference(one: Statistic, other: Statistic) -> Statistic:
    return lambda drawn: one(drawn) - other(drawn)


@over_ensemble
def longer_sampling_needs_fewer_actuations(grounds: Grounds) -> Judgement:
    """Section 4.2: control actuations from the shortest to the longest sample time."""
    return _falls(_across(grounds, "rendezvous", STEPS), "median change")


@over_ensemble
def longer_sampling_takes_longer(grounds: Grounds) -> Judgement:
    """Section 4.2: time of the phase from the shortest to the longest sample time."""
    return _rises(_across(grounds, "rendezvous", TIME), "median change")


@over_ensemble
def faster_sampling_spreads(grounds: Grounds) -> Judgement:
    """Section 4.2: spread of delta-v from the shortest to the longest sample time."""
    sweep = Sweep(grounds, "rendezvous")
    first, *_, last = sweep.sample_times
    return _falls(_widenings(sweep, DELTA_V, first, last), "relative change")


def _widenings(sweep: Sweep, quantity: str, first: float, last: float) -> list[Effect]:
    count = len(sweep.horizons)
    return [sweep.widening(quantity, (n, first), (n, last), count) for n in sweep.horizons]


NO_WITNESS = "no manoeuvre fails in the cases whose failures are printed, so that ours are others"


def _failing_cases(sweep: Sweep) -> tuple[tuple[float, ...], tuple[int, ...]]:
    """Sample times and horizons of the failures that Section 4.2 prints."""
    return sweep.sample_times[-2:], sweep.horizons[1:]


def _fails_as_printed(sweep: Sweep) -> bool:
    """Whether any manoeuvre fails in the cases of which the document says so."""
    slow, long = _failing_cases(sweep)
    return any((~sweep.rows(n, t)["completed"]).any() for n in long for t in slow)


@over_ensemble
def long_sampling_and_horizon_fail(grounds: Grounds) -> Judgement:
    """Section 4.2: failures, slowest two sample times and longer horizons less the other cases.

    A set with which none of the printed failures' cases fails has failures of another kind, and is
    no witness.
    """
    sweep = Sweep(grounds, "rendezvous")
    if not _fails_as_printed(sweep):
        return Judgement("undecided", NO_WITNESS)
    failed = {
        (n, t): ~sweep.rows(n, t)["completed"] for n in sweep.horizons for t in sweep.sample_times
    }
    slow, long = _failing_cases(sweep)
    there = pd.concat([failed[n, t] for n in long for t in slow], axis=1).mean(axis=1)
    others = pd.concat(
        [one for (n, t), one in failed.items() if not (n in long and t in slow)], axis=1
    ).mean(axis=1)
    found = sweep.effect("share of failures", mean((there - others).to_numpy()), len(there))
    return _rises([found], "slowest two sample times with the longer horizons less all other cases")


@over_ensemble
def limit_is_ample(grounds: Grounds[Configuration]) -> Judgement:
    """Section 4.2: mean time of a manoeuvre against the limit."""
    d = Domain(grounds)
    limit = 60.0 * grounds.section.studies.time_limit_min
    found = [d.effect("share", mean(d.time / limit))]
    return judgement(
        below(found, 0.5), "mean time as a share of the limit, to be below half", found
    )


@over_ensemble
def failures_stall_on_boundary(grounds: Grounds[Configuration]) -> Judgement:
    """Section 4.2: share of the failures that end at rest on the keep-out sphere.

    A set with which none of the printed failures' cases fails is no witness.
    """
    sweep = Sweep(grounds, "rendezvous")
    if not _fails_as_printed(sweep):
        return Judgement("undecided", NO_WITNESS)
    failed = sweep.table[~sweep.table["completed"]]
    radius = grounds.section.inferred.keep_out_m
    distance, speed = (
        np.linalg.norm(failed[[f"rendezvous_end_{name}" for name in names]].to_numpy(), axis=1)
        for names in (("x_m", "y_m", "z_m"), ("vx_m_s", "vy_m_s", "vz_m_s"))
    )
    stalled = (np.abs(distance / radius - 1.0) < ON_BOUNDARY) & (speed < AT_REST_M_S)
    count, trials = int(stalled.sum()), len(stalled)
    low, high = proportion_interval(count, trials, sweep.bootstrap.confidence)
    outcome: Outcome = "holds" if low > 0.5 else "fails" if high < 0.5 else "undecided"
    return Judgement(
        outcome,
        f"{count} of {trials} failures end at rest on the keep-out sphere: share "
        f"{count / trials:.3g} ({low:.3g} to {high:.3g})",
    )


def proportion_interval(successes: int, trials: int, confidence: float) -> tuple[float, float]:
    """Exact binomial interval of Clopper and Pearson."""
    found = binomtest(successes, trials).proportion_ci(confidence, method="exact")
    return float(found.low), float(found.high)


def _horizons(sweep: Sweep, first: int, second: int, *quantities: str) -> list[Effect]:
    """Changes from one horizon to another, one a quantity and sample time."""
    count = len(quantities) * len(sweep.sample_times)
    return [
        sweep.change(quantity, (first, t), (second, t), count)
        for quantity in quantities
        for t in sweep.sample_times
    ]


@over_ensemble
def longer_horizon_saves_rendezvous(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v and time from the first to the second horizon, each sample time.

    In general is read as on average, over the states that complete in both: the median of paired
    changes ties at zero where a longer horizon helps only some of them.
    """
    sweep = Sweep(grounds, "rendezvous")
    first, second = _tested(sweep.horizons, 2)[:2]
    count = 2 * len(sweep.sample_times)
    found = [
        sweep.mean_change(quantity, (first, t), (second, t), count)
        for quantity in (DELTA_V, TIME)
        for t in sweep.sample_times
    ]
    return _falls(found, "change of the mean")


@over_ensemble
def longest_horizon_is_similar(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v and time from the second to the third horizon stay similar."""
    return _third_horizon_is_similar(grounds, "rendezvous")


def _third_horizon_is_similar(grounds: Grounds, phase: str) -> Judgement:
    sweep = Sweep(grounds, phase)
    _, second, third = _tested(sweep.horizons, 3, 3)
    found = _horizons(sweep, second, third, DELTA_V, TIME)
    return judgement(within(found, SIMILAR), "median change, to be within 5 %", found)


# Section 4.3: the approach phase. The shortest sample time is the one called infeasible at the
# shortest horizon.


@over_ensemble
def longer_sampling_lowers_minimum_approach(grounds: Grounds) -> Judgement:
    """Section 4.3: lower bound of delta-v from the second to the longest sample time."""
    sweep = Sweep(grounds, "approach")
    _, first, *_, last = _tested(sweep.sample_times, 3)
    count = len(sweep.horizons)
    found = [sweep.shift(DELTA_V, LOWEST, (n, first), (n, last), count) for n in sweep.horizons]
    return _falls(found, "relative change")


def _approach_spread(grounds: Grounds, quantity: str) -> list[Effect]:
    sweep = Sweep(grounds, "approach")
    _, first, *_, last = _tested(sweep.sample_times, 3)
    return _widenings(sweep, quantity, first, last)


@over_ensemble
def longer_sampling_spreads_approach(grounds: Grounds[Configuration]) -> Judgement:
    """Section 4.3: spread of delta-v from the second to the longest sample time, each horizon.

    A horizon at which our data leave the axis of the printed figure is no witness: there the
    document's own data were others. Without it the sentence cannot hold, but it can fail. This came
    after a run in which that horizon alone spoke against it.
    """
    sweep = Sweep(grounds, "approach")
    witnesses, notes = [], []
    for horizon, found in zip(sweep.horizons, _approach_spread(grounds, DELTA_V), strict=True):
        printed = printed_axes("approach", horizon, grounds.ledger)
        if printed is not None:
            flown = [t for t in printed.sample_times if t in sweep.sample_times]
            reached = max(
                float(rows.loc[rows["completed"], column("approach", DELTA_V)].max())
                for rows in (sweep.rows(horizon, t) for t in flown)
            )
            end = printed.delta_v_m_s[1]
            if reached > end:
                notes.append(
                    f"; with N {horizon} delta-v reaches {reached:.1f} m/s where the printed axis "
                    f"ends at {end:g}, which makes it no witness ({found})"
                )
                continue
        witnesses.append(found)
    judged = _rises(witnesses, "relative change")
    outcome: Outcome = "undecided" if notes and judged.outcome == "holds" else judged.outcome
    return Judgement(outcome, judged.evidence + "".join(notes))


@over_ensemble
def longer_sampling_spreads_approach_time(grounds: Grounds) -> Judgement:
    """Section 4.3: spread of the time from the second to the longest sample time."""
    return _rises(_approach_spread(grounds, TIME), "relative change")


@over_ensemble
def short_approach_horizon_is_infeasible(grounds: Grounds) -> Judgement:
    """Section 4.3: shares of approaches that meet an infeasible program, at the shortest horizon.

    At the shortest sample time they must be most, and more than at every other one: the sentence
    says what sets that sample time apart.
    """
    sweep = Sweep(grounds, "approach")
    first, *others = sweep.sample_times
    rows = {t: sweep.rows(sweep.horizons[0], t) for t in sweep.sample_times}
    shares = pd.DataFrame(
        {t: pd.Series(infeasible_share(own, "approach"), own.index) for t, own in rows.items()}
    ).dropna()
    count, size = 1 + len(others), len(shares)
    most = [sweep.effect(f"share at {first:g} s", mean(shares[first].to_numpy()), size, count)]
    apart = [
        sweep.effect(
            f"{first:g} s less {t:g} s", mean((shares[first] - shares[t]).to_numpy()), size, count
        )
        for t in others
    ]
    return judgement(
        together(above(most, 0.5), above(apart)),
        "share of approaches that meet an infeasible program or never end, to be above half at the "
        "shortest sample time and larger than at the others",
        [*most, *apart],
    )


@over_ensemble
def approach_delta_v_drops_with_horizon(grounds: Grounds) -> Judgement:
    """Section 4.3: delta-v over all sample times falls by a quarter or more, from N2 5 to 15."""
    sweep = Sweep(grounds, "approach")
    first, second = _tested(sweep.horizons, 2)[:2]
    cases = [(n, t) for n in (first, second) for t in sweep.sample_times[1:]]
    values = np.array(sweep.values(DELTA_V, *cases))
    short, long = (part.sum(axis=0) for part in np.split(values, 2))
    name = f"delta-v over the sample times, N {first} to {second}"
    found = [sweep.effect(name, median(long / short - 1.0), len(short))]
    return judgement(
        above(negative(found), DRAMATIC), "median change, to be a drop by a quarter or more", found
    )


@over_ensemble
def longest_approach_horizon_is_similar(grounds: Grounds) -> Judgement:
    """Section 4.3: delta-v and time from the second to the third horizon stay similar."""
    return _third_horizon_is_similar(grounds, "approach")


# Section 4.4: the docking phase.


@over_ensemble
def fastest_docking_doubles_actuations(grounds: Grounds) -> Judgement:
    """Section 4.4: actuations of the other sample times less half of those of the fastest one."""
    sweep = Sweep(grounds, "docking")
    first, *others = sweep.sample_times
    count = len(others) * len(sweep.horizons)
    found = []
    for n in sweep.horizons:
        for t in others:
            a, b = sweep.values(STEPS, (n, first), (n, t))
            name = f"N {n}, {first:g} against {t:g} s"
            found.append(sweep.effect(name, median(a / b), len(a), count))
    return judgement(above(found, 2.0), "median ratio of actuations, to be above two", found)


@over_ensemble
def longer_sampling_docks_later(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the shortest to the longest sample time."""
    return _rises(_across(grounds, "docking", TIME), "median change")


@over_ensemble
def longer_sampling_lowers_docking_extremes(grounds: Grounds) -> Judgement:
    """Section 4.4: smallest and largest delta-v from the shortest to the longest sample time."""
    sweep = Sweep(grounds, "docking")
    first, *_, last = sweep.sample_times
    found = [
        sweep.shift(DELTA_V, level, (n, first), (n, last), 2 * len(sweep.horizons))
        for n in sweep.horizons
        for level in (LOWEST, HIGHEST)
    ]
    return _falls(found, "relative change")


@over_ensemble
def docking_difference_is_tiny(grounds: Grounds) -> Judgement:
    """Section 4.4: that change against the range of delta-v of the two phases before."""
    sweep = Sweep(grounds, "docking")
    first, *_, last = sweep.sample_times
    rows = grounds.rows("studies/domain.parquet", case="baseline", completed=True)
    before = totals(rows, DELTA_V, PHASES[:2]).to_numpy()
    unit = float(np.quantile(before, HIGHEST) - np.quantile(before, LOWEST))
    found = []
    for n in sweep.horizons:
        a, b = sweep.values(DELTA_V, (n, first), (n, last))
        found.append(sweep.effect(f"N {n}", median((b - a) / unit), len(a), len(sweep.horizons)))
    reading = "median change of delta-v as a share of the range before docking, to be within 5 %"
    return judgement(within(found, TINY), reading, found)


@over_ensemble
def docking_time_hardly_depends_on_horizon(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the first horizon to the others, each sample time."""
    sweep = Sweep(grounds, "docking")
    first, *others = sweep.horizons
    count = len(others) * len(sweep.sample_times)
    found = [
        sweep.change(TIME, (first, t), (n, t), count) for n in others for t in sweep.sample_times
    ]
    return judgement(within(found, NOT_MUCH), "median change, to be within 10 %", found)


@over_ensemble
def short_horizon_docks_faster(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the first to the second horizon, each sample time."""
    sweep = Sweep(grounds, "docking")
    first, second = _tested(sweep.horizons, 2)[:2]
    return _rises(_horizons(sweep, first, second, TIME), "median change")


@over_ensemble
def recommended_docking_sampling_saves(grounds: Grounds) -> Judgement:
    """Section 4.4: delta-v from the recommended sample times to the next one on either side."""
    sweep = Sweep(grounds, "docking")
    fast, low, high, slow = _tested(sweep.sample_times, 4, 4)
    count = 2 * len(sweep.horizons)
    found = [
        sweep.change(DELTA_V, (n, inside), (n, outside), count)
        for n in sweep.horizons
        for inside, outside in ((low, fast), (high, slow))
    ]
    return _rises(found, "median change when leaving the recommended range")
