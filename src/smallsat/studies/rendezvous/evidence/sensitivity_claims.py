"""Predicates of what chapter 4 says in words, each a statistical test fixed before the run.

Cases are compared on the same initial states, over those that complete in both; changes are
relative to the first case. Every interval comes from resampling initial states, and the intervals
of one claim hold together with the configured confidence. A claim *holds* if all of its intervals
lie on the claimed side, *fails* if one lies on the other side, and is *undecided* else.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

import numpy as np
import pandas as pd
from scipy.stats import beta

from smallsat.config import Config
from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.effects import above, judgement, together, within
from smallsat.evidence.grounds import Grounds
from smallsat.results import read_table
from smallsat.statistics.bootstrap import Bootstrap, Effect, effect
from smallsat.studies.rendezvous.monte_carlo.cases import PHASES, sweep_case
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
DELTA_V, TIME, STEPS = "delta_v_m_s", "time_s", "steps"
WORDS = {DELTA_V: "delta-v", TIME: "time", STEPS: "actuations"}


def studies(config: Config) -> Config:
    """The section of the studies."""
    return config["rendezvous"]["studies"]


def bootstrap(config: Config) -> Bootstrap:
    """How intervals are drawn, from the configuration."""
    return Bootstrap(**studies(config)["bootstrap"])


class Sweep:
    """Results of one phase's sweep: a quantity of each case by initial state."""

    def __init__(self, config: Config, results: Path, phase: str):
        self.phase = phase
        self.horizons: list[int] = studies(config)[phase]["horizons"]
        self.sample_times: list[float] = studies(config)[phase]["sample_times_s"]
        self.table = read_table(results / f"studies/{phase}-sweep.parquet")
        self.bootstrap = bootstrap(config)

    def rows(self, horizon: int, sample_time: float) -> pd.DataFrame:
        """All manoeuvres of a case, by initial state."""
        name = sweep_case(horizon, sample_time)
        found = self.table[self.table["case"] == name].set_index("sample")
        if found.empty:
            raise LookupError(name)
        return found

    def values(self, quantity: str, *cases: tuple[int, float]) -> list[np.ndarray]:
        """A quantity in each case, over the initial states that complete in all of them."""
        tables = [self.rows(*case) for case in cases]
        done = pd.concat([table["completed"] for table in tables], axis=1).fillna(False)
        common = done.index[done.all(axis=1).astype(bool)]
        return [
            table.loc[common, column(self.phase, quantity)].to_numpy(dtype=float)
            for table in tables
        ]

    def change(
        self, quantity: str, first: tuple[int, float], second: tuple[int, float], count: int
    ) -> Effect:
        """Median relative change from one case to another."""
        a, b = self.values(quantity, first, second)
        return effect(self._name(quantity, first, second), median(b / a - 1.0), len(a),
                      self.bootstrap, count)  # fmt: skip

    def widening(
        self, quantity: str, first: tuple[int, float], second: tuple[int, float], count: int
    ) -> Effect:
        """Relative change of the spread, from the 5 % to the 95 % quantile."""
        a, b = self.values(quantity, first, second)

        def statistic(drawn: np.ndarray) -> np.ndarray:
            return _spread(b[drawn]) / _spread(a[drawn]) - 1.0

        return effect(f"spread of {self._name(quantity, first, second)}", statistic, len(a),
                      self.bootstrap, count)  # fmt: skip

    def shift(
        self,
        quantity: str,
        level: float,
        first: tuple[int, float],
        second: tuple[int, float],
        count: int,
    ) -> Effect:
        """Relative change of a quantile."""
        a, b = self.values(quantity, first, second)

        def statistic(drawn: np.ndarray) -> np.ndarray:
            return np.quantile(b[drawn], level, axis=1) / np.quantile(a[drawn], level, axis=1) - 1.0

        name = f"{100 * level:.0f} % quantile of {self._name(quantity, first, second)}"
        return effect(name, statistic, len(a), self.bootstrap, count)

    def _name(self, quantity: str, first: tuple[int, float], second: tuple[int, float]) -> str:
        (n, t), (m, s) = first, second
        if n == m:
            return f"{WORDS[quantity]}, N {n}, {t:g} to {s:g} s"
        return f"{WORDS[quantity]}, {t:g} s, N {n} to {m}"


def tested(values: Sequence[Number], least: int, most: int | None = None) -> Sequence[Number]:
    """Horizons or sample times that a claim names by their places in the document's list.

    Raises
    ------
    LookupError
        If the run has other numbers of them, so that the places mean something else.
    """
    if len(values) < least or (most is not None and len(values) > most):
        raise LookupError(f"{len(values)} values where the claim speaks of {least}")
    return values


def median(values: np.ndarray):
    """Statistic: the median of resampled values."""
    return lambda drawn: np.median(values[drawn], axis=1)


def negative(effects: Sequence[Effect]) -> list[Effect]:
    """The effects with their signs turned, for a claim of a decrease."""
    return [Effect(e.name, -e.value, -e.high, -e.low, e.units) for e in effects]


def _spread(values: np.ndarray) -> np.ndarray:
    low, high = np.quantile(values, [LOWEST, HIGHEST], axis=1)
    return high - low


def _falls(effects: list[Effect], reading: str) -> Judgement:
    return judgement(above(negative(effects)), reading, effects)


def _rises(effects: list[Effect], reading: str) -> Judgement:
    return judgement(above(effects), reading, effects)


# Section 4.1: where the manoeuvre begins.


class Domain:
    """The baseline from every initial state, with where it begins."""

    def __init__(self, config: Config, results: Path, case: str = "baseline"):
        table = read_table(results / "studies/domain.parquet")
        rows = table[(table["case"] == case) & table["completed"]].set_index("sample")
        states = read_table(results / "studies/initial-states.parquet").set_index("sample")
        states = states.loc[rows.index]
        self.delta_v = totals(rows, DELTA_V).to_numpy()
        self.time = totals(rows, TIME).to_numpy()
        self.distance = states["distance_m"].to_numpy()
        # Quadrants 3 and 4 lie behind the target, on the side without the port.
        self.behind = states["quadrant"].isin([3, 4]).to_numpy()
        self.quadrant = states["quadrant"].to_numpy()
        low, high = np.quantile(self.distance, [1 / 3, 2 / 3])
        self.near, self.far = self.distance <= low, self.distance >= high
        self.bootstrap = bootstrap(config)

    def difference(
        self, name: str, values: np.ndarray, second: np.ndarray, first: np.ndarray,
        level: float, count: int,
    ) -> Effect:  # fmt: skip
        """Difference of a quantile between two groups of initial states, each resampled."""
        return effect(name, _group_difference(values, second, first, level), len(values),
                      self.bootstrap, count)  # fmt: skip


def _group_difference(values: np.ndarray, second: np.ndarray, first: np.ndarray, level: float):
    def statistic(drawn: np.ndarray) -> np.ndarray:
        drawn_values = values[drawn]
        a = np.where(first[drawn], drawn_values, np.nan)
        b = np.where(second[drawn], drawn_values, np.nan)
        return np.nanquantile(b, level, axis=1) - np.nanquantile(a, level, axis=1)

    return statistic


def quadrants_behind_take_longer(grounds: Grounds) -> Judgement:
    """Section 4.1: median time, quadrants 3 and 4 less 1 and 2."""
    d = Domain(grounds.config, grounds.results)
    found = [d.difference("time, s", d.time, d.behind, ~d.behind, 0.5, 1)]
    return _rises(found, "median, quadrants 3 and 4 less 1 and 2")


def quadrants_behind_have_higher_minimum(grounds: Grounds) -> Judgement:
    """Section 4.1: lower bound of delta-v, quadrants 3 and 4 less 1 and 2."""
    d = Domain(grounds.config, grounds.results)
    found = [d.difference("delta-v, m/s", d.delta_v, d.behind, ~d.behind, LOWEST, 1)]
    return _rises(found, "5 % quantile, quadrants 3 and 4 less 1 and 2")


def quadrant_matters_less_for_maximum(grounds: Grounds) -> Judgement:
    """Section 4.1: the shift of the lower bound of delta-v less that of the upper one."""
    d = Domain(grounds.config, grounds.results)
    lower = _group_difference(d.delta_v, d.behind, ~d.behind, LOWEST)
    upper = _group_difference(d.delta_v, d.behind, ~d.behind, HIGHEST)
    found = effect(
        "delta-v, m/s", lambda i: np.abs(lower(i)) - np.abs(upper(i)), len(d.time), d.bootstrap
    )
    return _rises([found], "shift of the 5 % quantile by quadrant less that of the 95 % one")


def quadrant_alone_gives_no_range(grounds: Grounds) -> Judgement:
    """Section 4.1: share of the variance of delta-v and time that the quadrant explains."""
    d = Domain(grounds.config, grounds.results)
    found = [
        effect(name, _explained(values, d.quadrant), len(values), d.bootstrap, 2)
        for name, values in (("delta-v", d.delta_v), ("time", d.time))
    ]
    return judgement(
        together(*(_below(one, ALONE) for one in found)),
        "share of the variance that the quadrant explains, to be below one half",
        found,
    )


def _explained(values: np.ndarray, group: np.ndarray):
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


def _below(one: Effect, threshold: float) -> Outcome:
    shifted = Effect(one.name, threshold - one.value, threshold - one.high, threshold - one.low,
                     one.units)  # fmt: skip
    return above([shifted])


def distance_raises_minimum(grounds: Grounds) -> Judgement:
    """Section 4.1: lower bounds of delta-v and time, farthest third less nearest third."""
    d = Domain(grounds.config, grounds.results)
    found = [
        d.difference(name, values, d.far, d.near, LOWEST, 2)
        for name, values in (("delta-v, m/s", d.delta_v), ("time, s", d.time))
    ]
    return _rises(found, "5 % quantile, farthest third less nearest third")


def distance_matters_more_for_maximum(grounds: Grounds) -> Judgement:
    """Section 4.1: shift of the upper bound of delta-v by distance less that by quadrant."""
    d = Domain(grounds.config, grounds.results)
    by_distance = _group_difference(d.delta_v, d.far, d.near, HIGHEST)
    by_quadrant = _group_difference(d.delta_v, d.behind, ~d.behind, HIGHEST)
    found = effect(
        "delta-v, m/s",
        lambda i: np.abs(by_distance(i)) - np.abs(by_quadrant(i)),
        len(d.time),
        d.bootstrap,
    )
    return _rises([found], "shift of the 95 % quantile by distance less that by quadrant")


# Section 4.2: the rendezvous phase.


def _ends(sweep: Sweep) -> tuple[float, float]:
    return sweep.sample_times[0], sweep.sample_times[-1]


def _across(sweep: Sweep, quantity: str, first: float, last: float) -> list[Effect]:
    return [
        sweep.change(quantity, (n, first), (n, last), len(sweep.horizons)) for n in sweep.horizons
    ]


def longer_sampling_saves_rendezvous(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v from the shortest to the longest sample time, each horizon."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    return _falls(_across(sweep, DELTA_V, *_ends(sweep)), "median change")


def savings_diminish(grounds: Grounds) -> Judgement:
    """Section 4.2: the last interval of sample times saves less than every other one."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    *others, last = pairwise(sweep.sample_times)
    if not others:
        raise LookupError("sample times")
    found = []
    for n in sweep.horizons:
        for interval in others:
            a, b, c, d = sweep.values(DELTA_V, *[(n, t) for t in (*interval, *last)])
            first, second = (b - a) / a, (d - c) / c
            name = f"N {n}, {interval[0]:g} to {interval[1]:g} s"
            count = len(others) * len(sweep.horizons)
            found.append(
                effect(name, _medians_differ(first, second), len(a), sweep.bootstrap, count)
            )
    return _rises(found, "median change of delta-v in the last interval less that in")


def _medians_differ(first: np.ndarray, second: np.ndarray):
    return lambda drawn: np.median(second[drawn], axis=1) - np.median(first[drawn], axis=1)


def longer_sampling_needs_fewer_actuations(grounds: Grounds) -> Judgement:
    """Section 4.2: control actuations from the shortest to the longest sample time."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    return _falls(_across(sweep, STEPS, *_ends(sweep)), "median change")


def longer_sampling_takes_longer(grounds: Grounds) -> Judgement:
    """Section 4.2: time of the phase from the shortest to the longest sample time."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    return _rises(_across(sweep, TIME, *_ends(sweep)), "median change")


def faster_sampling_spreads(grounds: Grounds) -> Judgement:
    """Section 4.2: spread of delta-v from the shortest to the longest sample time."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    first, last = _ends(sweep)
    found = [
        sweep.widening(DELTA_V, (n, first), (n, last), len(sweep.horizons)) for n in sweep.horizons
    ]
    return _falls(found, "relative change")


def long_sampling_and_horizon_fail(grounds: Grounds) -> Judgement:
    """Section 4.2: failures, slowest two sample times and longer horizons less the other cases."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    slow, long = sweep.sample_times[-2:], sweep.horizons[1:]
    failed = {
        (n, t): ~sweep.rows(n, t)["completed"] for n in sweep.horizons for t in sweep.sample_times
    }
    there = pd.concat([failed[n, t] for n in long for t in slow], axis=1).mean(axis=1)
    others = pd.concat(
        [one for (n, t), one in failed.items() if not (n in long and t in slow)], axis=1
    ).mean(axis=1)
    difference = (there - others).to_numpy()
    found = effect("share of failures", lambda i: difference[i].mean(axis=1), len(difference),
                   sweep.bootstrap)  # fmt: skip
    return _rises([found], "slowest two sample times with the longer horizons less all other cases")


def limit_is_ample(grounds: Grounds) -> Judgement:
    """Section 4.2: mean time of a manoeuvre against the limit."""
    d = Domain(grounds.config, grounds.results)
    limit = 60.0 * studies(grounds.config)["time_limit_min"]
    found = effect("share", lambda i: d.time[i].mean(axis=1) / limit, len(d.time), d.bootstrap)
    return judgement(
        _below(found, 0.5), "mean time as a share of the limit, to be below half", [found]
    )


def failures_stall_on_boundary(grounds: Grounds) -> Judgement:
    """Section 4.2: share of the failures that end at rest on the keep-out sphere."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    failed = sweep.table[~sweep.table["completed"]]
    if failed.empty:
        return Judgement("undecided", "no manoeuvre of the sweep fails")
    radius = grounds.config["rendezvous"]["inferred"]["keep_out_m"]
    ends = failed[[f"rendezvous_end_{name}" for name in ("x_m", "y_m", "z_m")]].to_numpy()
    speed = failed[[f"rendezvous_end_{name}" for name in ("vx_m_s", "vy_m_s", "vz_m_s")]]
    near = np.abs(np.linalg.norm(ends, axis=1) / radius - 1.0) < ON_BOUNDARY
    stalled = near & (np.linalg.norm(speed.to_numpy(), axis=1) < AT_REST_M_S)
    low, high = proportion_interval(int(stalled.sum()), len(stalled), sweep.bootstrap.confidence)
    share = float(stalled.mean())
    found = Effect("share", share - 0.5, low - 0.5, high - 0.5, max(len(stalled), 0))
    outcome: Outcome = "holds" if low > 0.5 else "fails" if high < 0.5 else "undecided"
    return Judgement(
        outcome,
        f"{int(stalled.sum())} of {len(stalled)} failures end at rest on the keep-out sphere: "
        f"share {share:.3g} ({found.low + 0.5:.3g} to {found.high + 0.5:.3g})",
    )


def proportion_interval(successes: int, trials: int, confidence: float) -> tuple[float, float]:
    """Exact binomial interval of Clopper and Pearson."""
    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if successes == 0 else float(beta.ppf(tail, successes, trials - successes + 1))
    high = (
        1.0
        if successes == trials
        else float(beta.ppf(1.0 - tail, successes + 1, trials - successes))
    )
    return low, high


def _horizons(
    sweep: Sweep, first: int, second: int, quantities: Sequence[str], times: Sequence[float]
) -> list[Effect]:
    return [
        sweep.change(quantity, (first, t), (second, t), len(quantities) * len(times))
        for quantity in quantities
        for t in times
    ]


def longer_horizon_saves_rendezvous(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v and time from the first to the second horizon, each sample time."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    first, second = tested(sweep.horizons, 2)[:2]
    found = _horizons(sweep, first, second, (DELTA_V, TIME), sweep.sample_times)
    return _falls(found, "median change")


def longest_horizon_is_similar(grounds: Grounds) -> Judgement:
    """Section 4.2: delta-v and time from the second to the third horizon stay similar."""
    sweep = Sweep(grounds.config, grounds.results, "rendezvous")
    _, second, third = tested(sweep.horizons, 3, 3)
    found = _horizons(sweep, second, third, (DELTA_V, TIME), sweep.sample_times)
    return judgement(within(found, SIMILAR), "median change, to be within 5 %", found)


# Section 4.3: the approach phase.


def longer_sampling_lowers_minimum_approach(grounds: Grounds) -> Judgement:
    """Section 4.3: lower bound of delta-v from the second to the longest sample time."""
    return _falls(_approach_shift(grounds), "relative change")


def _approach_shift(grounds: Grounds) -> list[Effect]:
    # The shortest sample time is the one called infeasible at the shortest horizon.
    sweep = Sweep(grounds.config, grounds.results, "approach")
    _, first, *_, last = tested(sweep.sample_times, 3)
    return [
        sweep.shift(DELTA_V, LOWEST, (n, first), (n, last), len(sweep.horizons))
        for n in sweep.horizons
    ]


def _approach_spread(grounds: Grounds, quantity: str) -> list[Effect]:
    sweep = Sweep(grounds.config, grounds.results, "approach")
    _, first, *_, last = tested(sweep.sample_times, 3)
    return [
        sweep.widening(quantity, (n, first), (n, last), len(sweep.horizons)) for n in sweep.horizons
    ]


def longer_sampling_spreads_approach(grounds: Grounds) -> Judgement:
    """Section 4.3: spread of delta-v from the second to the longest sample time."""
    return _rises(_approach_spread(grounds, DELTA_V), "relative change")


def longer_sampling_spreads_approach_time(grounds: Grounds) -> Judgement:
    """Section 4.3: spread of the time from the second to the longest sample time."""
    return _rises(_approach_spread(grounds, TIME), "relative change")


def short_approach_horizon_is_infeasible(grounds: Grounds) -> Judgement:
    """Section 4.3: shortest horizon and sample time: approaches that meet an infeasible program."""
    sweep = Sweep(grounds.config, grounds.results, "approach")
    rows = sweep.rows(sweep.horizons[0], sweep.sample_times[0])
    infeasible = infeasible_share(rows, "approach")
    found = effect("share", lambda i: infeasible[i].mean(axis=1), len(infeasible), sweep.bootstrap)
    return judgement(
        above([found], 0.5),
        "share of approaches that meet an infeasible program or never end, to be above half",
        [found],
    )


def infeasible_share(rows: pd.DataFrame, phase: str) -> np.ndarray:
    """1 where a manoeuvre met an infeasible program in a phase or did not complete it, else 0."""
    met = ~rows["completed"]
    for kind in ("softened", "outside", "failed"):
        met = met | (rows[column(phase, kind)] > 0)
    return met.to_numpy(dtype=float)


def approach_delta_v_drops_with_horizon(grounds: Grounds) -> Judgement:
    """Section 4.3: delta-v from the first to the second horizon falls by a quarter or more."""
    sweep = Sweep(grounds.config, grounds.results, "approach")
    first, second = tested(sweep.horizons, 2)[:2]
    found = _horizons(sweep, first, second, (DELTA_V,), sweep.sample_times[1:])
    return judgement(
        above(negative(found), DRAMATIC), "median change, to be a drop by a quarter or more", found
    )


def longest_approach_horizon_is_similar(grounds: Grounds) -> Judgement:
    """Section 4.3: delta-v and time from the second to the third horizon stay similar."""
    sweep = Sweep(grounds.config, grounds.results, "approach")
    _, second, third = tested(sweep.horizons, 3, 3)
    found = _horizons(sweep, second, third, (DELTA_V, TIME), sweep.sample_times)
    return judgement(within(found, SIMILAR), "median change, to be within 5 %", found)


# Section 4.4: the docking phase.


def fastest_docking_doubles_actuations(grounds: Grounds) -> Judgement:
    """Section 4.4: actuations of the other sample times less half of those of the fastest one."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    first, *others = sweep.sample_times
    found = []
    for n in sweep.horizons:
        for t in others:
            a, b = sweep.values(STEPS, (n, first), (n, t))
            name = f"N {n}, {first:g} against {t:g} s"
            count = len(others) * len(sweep.horizons)
            found.append(effect(name, median(a / b), len(a), sweep.bootstrap, count))
    return judgement(above(found, 2.0), "median ratio of actuations, to be above two", found)


def longer_sampling_docks_later(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the shortest to the longest sample time."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    return _rises(_across(sweep, TIME, *_ends(sweep)), "median change")


def longer_sampling_lowers_docking_extremes(grounds: Grounds) -> Judgement:
    """Section 4.4: smallest and largest delta-v from the shortest to the longest sample time."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    first, last = _ends(sweep)
    found = [
        sweep.shift(DELTA_V, level, (n, first), (n, last), 2 * len(sweep.horizons))
        for n in sweep.horizons
        for level in (LOWEST, HIGHEST)
    ]
    return _falls(found, "relative change")


def docking_difference_is_tiny(grounds: Grounds) -> Judgement:
    """Section 4.4: that change against the range of delta-v of the two phases before."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    first, last = _ends(sweep)
    table = grounds.table("studies/domain.parquet")
    rows = table[(table["case"] == "baseline") & table["completed"]]
    before = totals(rows, DELTA_V, PHASES[:2]).to_numpy()
    unit = float(np.quantile(before, HIGHEST) - np.quantile(before, LOWEST))
    found = []
    for n in sweep.horizons:
        a, b = sweep.values(DELTA_V, (n, first), (n, last))
        found.append(
            effect(f"N {n}", median((b - a) / unit), len(a), sweep.bootstrap, len(sweep.horizons))
        )
    reading = "median change of delta-v as a share of the range before docking, to be within 5 %"
    return judgement(within(found, TINY), reading, found)


def docking_time_hardly_depends_on_horizon(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the first horizon to the others, each sample time."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    first, *others = sweep.horizons
    count = len(others) * len(sweep.sample_times)
    found = [
        sweep.change(TIME, (first, t), (n, t), count) for n in others for t in sweep.sample_times
    ]
    return judgement(within(found, NOT_MUCH), "median change, to be within 10 %", found)


def short_horizon_docks_faster(grounds: Grounds) -> Judgement:
    """Section 4.4: time to dock from the first to the second horizon, each sample time."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    first, second = tested(sweep.horizons, 2)[:2]
    found = _horizons(sweep, first, second, (TIME,), sweep.sample_times)
    return _rises(found, "median change")


def recommended_docking_sampling_saves(grounds: Grounds) -> Judgement:
    """Section 4.4: delta-v from the recommended sample times to the next one on either side."""
    sweep = Sweep(grounds.config, grounds.results, "docking")
    fast, low, high, slow = tested(sweep.sample_times, 4, 4)
    count = 2 * len(sweep.horizons)
    found = [
        sweep.change(DELTA_V, (n, inside), (n, outside), count)
        for n in sweep.horizons
        for inside, outside in ((low, fast), (high, slow))
    ]
    return _rises(found, "median change when leaving the recommended range")
