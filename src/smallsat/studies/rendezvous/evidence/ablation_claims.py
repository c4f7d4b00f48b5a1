"""Predicates of what parts of the algorithm are for, from manoeuvres without them.

The cases are `smallsat.studies.rendezvous.monte_carlo.cases`' group of ablations. As in chapter 4,
cases are compared state by state, and units that are resampled are initial states.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.effects import above, below, judgement, negative
from smallsat.evidence.grounds import Grounds
from smallsat.statistics.bootstrap import Effect, Statistic, effect
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.ensemble import over_ensemble
from smallsat.studies.rendezvous.evidence.sweeps import DELTA_V, TIME, WORDS, bootstrap, mean
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import (
    AS_DOCUMENTED,
    BASELINE,
    LP_DISTURBED,
    LP_UNDISTURBED,
    NO_PENALTY,
    NO_REFERENCE,
    NO_SET_POINT,
    NO_SET_POINT_NO_ZONE,
    NO_ZONE,
    PHASES,
    UNDISTURBED,
    corridor_case,
    delay_case,
    planes_case,
    sweep_case,
    weight_case,
)
from smallsat.studies.rendezvous.monte_carlo.tables import column, totals

RENDEZVOUS, APPROACH, DOCKING = PHASES
# What words are taken to mean.
NOT_NEEDED = 0.05  # share of the states whose phase ends with a part and does not without it
ACCEPTABLE = 0.05  # share of a far range's steps whose program has no solution
CAUSE = 0.5  # share of an effect that goes away with its cause


def _rows(grounds: Grounds, group: str, case: str) -> pd.DataFrame:
    """Manoeuvres of a case by initial state, runs of one state averaged."""
    rows = grounds.rows(f"studies/{group}.parquet", case=case).drop(columns="case")
    return rows.astype(float).groupby("sample").mean()


def _together(*tables: pd.DataFrame, completed: bool = True) -> list[pd.DataFrame]:
    """The tables' rows of the initial states that all of them have, and complete in all runs."""
    common = tables[0].index
    for table in tables:
        common = common.intersection(table.index[(table["completed"] == 1.0) | (not completed)])
    if common.empty:
        raise LookupError("no state completes in all cases")
    return [table.loc[common] for table in tables]


def _ended(table: pd.DataFrame) -> pd.DataFrame:
    """The rows with ``completed`` read as: the rendezvous phase has ended."""
    return table.assign(completed=((table["completed"] == 1.0) | (table["end_phase"] > 1)) * 1.0)


def _unsolved(table: pd.DataFrame) -> np.ndarray:
    """Share of the far range's steps whose program has no solution as it is stated."""
    bad = sum(table[column(RENDEZVOUS, kind)] for kind in ("softened", "outside", "failed"))
    return (bad / table[column(RENDEZVOUS, "steps")]).to_numpy(dtype=float)


def _means_change(values: np.ndarray, before: np.ndarray) -> Statistic:
    return lambda drawn: values[drawn].mean(axis=1) / before[drawn].mean(axis=1) - 1.0


@over_ensemble
def penalty_is_not_needed(grounds: Grounds) -> Judgement:
    """Section 3.1.2: far ranges that end with the terminal penalty and do not without it."""
    with_it = _ended(_rows(grounds, "domain", BASELINE))
    without = _rows(grounds, "ablations", NO_PENALTY)
    with_it, without = _together(with_it, without, completed=False)
    lost = (with_it["completed"] - without["completed"]).to_numpy()
    done = (with_it["completed"] * without["completed"]) == 1.0
    both = [table[done] for table in (with_it, without)]
    time = [float(table[column(RENDEZVOUS, TIME)].mean()) for table in both]
    found = [effect("share", mean(lost), len(lost), bootstrap(grounds))]
    judged = judgement(
        below(found, NOT_NEEDED), "share that the penalty brings to the end, to be below 5 %", found
    )
    return judged.remarked(
        f"it may help: far ranges take {time[0] / MINUTE:.1f} min with and "
        f"{time[1] / MINUTE:.1f} min without it",
    )


@over_ensemble
def faster_planes_are_infeasible(grounds: Grounds[Configuration]) -> Judgement:
    """Section 3.1.3: steps without solution with the fastest planes, less those at the limit."""
    fastest = planes_case(max(grounds.section.studies.ablations.plane_rates))
    faster, limited = _together(
        _rows(grounds, "ablations", fastest), _rows(grounds, "domain", BASELINE), completed=False
    )
    more = _unsolved(faster) - _unsolved(limited)
    found = [effect("share of steps", mean(more), len(more), bootstrap(grounds))]
    return judgement(above(found), f"steps without a solution, {fastest}, less at the limit", found)


@over_ensemble
def plane_limit_is_acceptable(grounds: Grounds) -> Judgement:
    """Section 3.1.3: share of the far range's steps without solution at the printed limit."""
    shares = _unsolved(_rows(grounds, "domain", BASELINE))
    found = [effect("share of steps", mean(shares), len(shares), bootstrap(grounds))]
    return judgement(below(found, ACCEPTABLE), "steps without a solution, to be below 5 %", found)


@over_ensemble
def chaser_passes_without_zone(grounds: Grounds[Configuration]) -> Judgement:
    """Section 3.1.3: far ranges that come inside r1 without the zone, less those with it.

    Of starts outside of it, and at samples.
    """
    states = grounds.table("studies/initial-states.parquet").set_index("sample")
    r1 = grounds.section.inferred.keep_out_m
    outside = states.index[np.linalg.norm(states[STATE[:3]], axis=1) > r1]
    without, with_it = _together(
        _rows(grounds, "ablations", NO_ZONE), _rows(grounds, "domain", BASELINE), completed=False
    )
    started = without.index.intersection(outside)
    # A sample on the boundary is not inside.
    inside = [
        (table.loc[started, "closest_m"] < 0.99 * r1).to_numpy(dtype=float)
        for table in (without, with_it)
    ]
    found = [effect("share", mean(inside[0] - inside[1]), len(inside[0]), bootstrap(grounds))]
    nearest = float(without["closest_m"].min())
    judged = judgement(above(found), "share inside r1 without the zone, less with it", found)
    return judged.remarked(f"the nearest comes to {nearest:.0f} m")


@over_ensemble
def reference_helps_approach(grounds: Grounds) -> Judgement:
    """Section 3.2.1: time and delta-v of the approach with its set point against without.

    It helps where one of them falls and the other does not rise.
    """
    with_it = _rows(grounds, "domain", BASELINE).query("end_phase > 2 or completed == 1")
    with_it, without = _together(
        with_it.assign(completed=1.0), _rows(grounds, "ablations", NO_REFERENCE)
    )
    found = [
        effect(
            WORDS[quantity],
            _means_change(*(t[column(APPROACH, quantity)].to_numpy() for t in (with_it, without))),
            len(with_it),
            bootstrap(grounds),
            2,
        )
        for quantity in (TIME, DELTA_V)
    ]
    return judgement(_gain(found), "change of the mean by the set point, one to fall", found)


def _gain(effects: Sequence[Effect]) -> Outcome:
    """Holds if one of them falls and none rises, fails if one rises and none falls."""
    falls = [above(negative([one])) == "holds" for one in effects]
    rises = [above([one]) == "holds" for one in effects]
    if any(falls) != any(rises):
        return "holds" if any(falls) else "fails"
    return "undecided"


@over_ensemble
def zone_and_target_conflict(grounds: Grounds) -> Judgement:
    """Section 3.6.4: what is left of the longer far range without set point, without the zone."""
    baseline, slow, free = _together(
        _ended(_rows(grounds, "domain", BASELINE)),
        _ended(_rows(grounds, "domain", NO_SET_POINT)),
        _rows(grounds, "ablations", NO_SET_POINT_NO_ZONE),
    )
    time = column(RENDEZVOUS, TIME)
    longer = (slow[time] - baseline[time]).to_numpy()
    saved = (slow[time] - free[time]).to_numpy()

    def share(drawn: np.ndarray) -> np.ndarray:
        return saved[drawn].sum(axis=1) / longer[drawn].sum(axis=1)

    found = [
        effect("longer by, s", mean(longer), len(longer), bootstrap(grounds), 2),
        effect("share", share, len(longer), bootstrap(grounds), 2),
    ]
    outcome = above(found[:1])
    if outcome == "holds":
        outcome = above(found[1:], CAUSE)
    return judgement(
        outcome,
        "what the far range takes longer without set point, and the share of it that goes away "
        "with the zone, to be above half",
        found,
    )


@over_ensemble
def corridor_makes_late(grounds: Grounds[Configuration]) -> Judgement:
    """Section 4.4: how much later the longest sample time docks, with the corridor less without."""
    section = grounds.section
    first, *_, last = section.studies.docking.sample_times_s
    horizon = section.phases.final.horizon
    tables = _together(
        *(_rows(grounds, "docking-sweep", sweep_case(horizon, t)) for t in (last, first)),
        *(_rows(grounds, "ablations", corridor_case(t)) for t in (last, first)),
    )
    late, early, wide_late, wide_early = (t[column(DOCKING, TIME)].to_numpy() for t in tables)
    found = [
        effect("later by, s", mean(late - early), len(late), bootstrap(grounds), 2),
        effect(
            "of it by the corridor, s",
            mean((late - early) - (wide_late - wide_early)),
            len(late),
            bootstrap(grounds),
            2,
        ),
    ]
    return judgement(
        above(found), f"mean time to dock at {last:g} s less {first:g} s, both to be above 0", found
    )


@over_ensemble
def one_norm_is_less_robust(grounds: Grounds) -> Judgement:
    """Section 2.2.1: what disturbances add to the far range's delta-v, by the LP less by the QP."""
    tables = [
        _rows(grounds, "ablations", LP_DISTURBED),
        _rows(grounds, "ablations", LP_UNDISTURBED),
        *(_ended(_rows(grounds, "robustness", case)) for case in (AS_DOCUMENTED, UNDISTURBED)),
    ]
    noisy, calm, noisy_quadratic, calm_quadratic = (
        table[column(RENDEZVOUS, DELTA_V)].to_numpy() for table in _together(*tables)
    )
    more = noisy / calm - noisy_quadratic / calm_quadratic
    found = [effect("share of delta-v", mean(more), len(more), bootstrap(grounds))]
    done = [float(table["completed"].mean()) for table in tables]
    judged = judgement(above(found), "relative increase with the LP less that with the QP", found)
    return judged.remarked(
        f"{100 * done[0]:.0f} % of the disturbed far ranges end with the LP, "
        f"{100 * done[2]:.0f} % with the QP. The weights of the LP are not printed",
    )


@over_ensemble
def sampling_costs_more_than_weights(grounds: Grounds[Configuration]) -> Judgement:
    """Chapter 4: factor that sample times and horizons change the work by, less that of weights.

    Work is the solver's steps times the horizon, of a rendezvous phase.
    """
    section = grounds.section
    sweep, factors = section.studies.rendezvous, section.studies.weights.factors
    horizon = section.phases.far.horizon
    cases = [(n, t) for n in sweep.horizons for t in sweep.sample_times_s]
    tables = _together(
        *(_rows(grounds, "rendezvous-sweep", sweep_case(n, t)) for n, t in cases),
        *(_ended(_rows(grounds, "weights", weight_case(f, RENDEZVOUS))) for f in factors),
    )
    iterations = [table[column(RENDEZVOUS, "iterations")].to_numpy() for table in tables]
    sampled = np.array([i * n for i, (n, _) in zip(iterations, cases, strict=False)])
    weighted = np.array([i * horizon for i in iterations[len(cases) :]])

    def spread(work: np.ndarray) -> np.ndarray:
        return np.log10(work.max(axis=0) / work.min(axis=0))

    more = spread(sampled) - spread(weighted)
    found = [effect("powers of ten", mean(more), len(more), bootstrap(grounds))]
    times = [10.0 ** float(spread(work).mean()) for work in (sampled, weighted)]
    judged = judgement(above(found), "factor by sampling and horizon less that by weights", found)
    return judged.remarked(
        f"the work of a far range changes by a factor of {times[0]:.1f} over "
        f"sample times and horizons, of {times[1]:.1f} over weights",
    )


def _delayed(grounds: Grounds[Configuration]) -> tuple[list[np.ndarray], float]:
    """Relative changes of delta-v by the longest delay, unknown and known to the law; the delay."""
    delay = max(grounds.section.studies.delay.delays_s)
    baseline, unknown, known = _together(
        _rows(grounds, "domain", BASELINE),
        *(_rows(grounds, "delay", delay_case(delay, known)) for known in (False, True)),
    )
    calm, late, shifted = (totals(t, DELTA_V).to_numpy() for t in (baseline, unknown, known))
    return [late / calm - 1.0, shifted / calm - 1.0], delay


@over_ensemble
def delay_has_an_effect(grounds: Grounds) -> Judgement:
    """Section 5.5: delta-v with the longest delay that the law does not know."""
    (late, _), delay = _delayed(grounds)
    found = [effect(f"delta-v, {delay:g} s", mean(late), len(late), bootstrap(grounds))]
    return judgement(above(found), "mean change by the delay, to be a rise", found)


@over_ensemble
def shifted_horizon_cures_delay(grounds: Grounds) -> Judgement:
    """Section 5.5: what the longest delay adds, unknown less known to the prediction."""
    (late, shifted), delay = _delayed(grounds)
    found = [effect(f"delta-v, {delay:g} s", mean(late - shifted), len(late), bootstrap(grounds))]
    return judgement(above(found), "change if not predicted less that if predicted", found)
