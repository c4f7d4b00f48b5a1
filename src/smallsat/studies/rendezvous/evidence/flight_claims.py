"""Predicates of the claims of chapter 6, and of what chapter 7 repeats of them.

The thesis measures milliseconds of CVXGEN's code in an emulator; here instructions are counted, of
two solvers on two processors. A claim holds where it does for every solver and processor, fails
where it does for none, and is undecided else. What words are taken to mean stands below, set before
the runs were counted; the growth over the horizon of other solvers on another machine was known.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.flight_computer.printed_times import printed_averages
from smallsat.studies.rendezvous.flight_computer.sweeps import swept
from smallsat.studies.rendezvous.guidance.law import PHASES

FAR, MID, FINAL = PHASES
ALIKE_GROWTH = 1.25  # factor between a printed ratio of averages and ours
SIMILAR_MEAN = 1.25  # factor between averages
SIMILAR_SPREAD = 2.0  # factor between standard deviations
NEARLY_TWO = (1.5, 2.0)  # factor between averages
AMPLE = 0.1  # share of the sample time that the worst solve takes at most
SECOND_MS = 1000.0


@dataclass(frozen=True)
class Bench:
    """What one solver took on one processor.

    Attributes
    ----------
    name
        Solver and processor.
    runs, cycles
        Its rows of ``flight/runs.csv`` and ``flight/cycles.csv``.
    """

    name: str
    runs: pd.DataFrame
    cycles: pd.DataFrame

    def sweep(self, phase: str, varied: str) -> dict[Any, np.ndarray]:
        """Average instructions of a solve, of each run, by horizon or by sample time, s."""
        rows = swept(self.runs, phase, varied)
        return {
            value: own["instructions"].to_numpy(dtype=float) for value, own in rows.groupby(varied)
        }

    def averages(self, phase: str, horizon: int) -> np.ndarray:
        """Average instructions of a solve, of each run of a horizon."""
        return self.sweep(phase, "horizon")[horizon]

    def mean(self, phase: str, horizon: int) -> float:
        """Average over the runs of a horizon."""
        return float(self.averages(phase, horizon).mean())

    def worst(self, phase: str) -> pd.DataFrame:
        """Bounds of the worst solve of every case of a phase."""
        return self.cycles[(self.cycles["phase"] == phase) & (self.cycles["solve"] == "most")]


def benches(grounds: Grounds[Configuration]) -> Iterator[Bench]:
    """Every solver on every processor."""
    key = ["solver", "processor"]
    cycles = grounds.table("flight/cycles.csv").groupby(key)
    for names, runs in grounds.table("flight/runs.csv").groupby(key):
        yield Bench(", ".join(map(str, names)), runs, cycles.get_group(names))


def _judged(
    grounds: Grounds[Configuration], reading: str, judge: Callable[[Bench], tuple[Outcome, str]]
) -> Judgement:
    """One outcome of those of all solvers and processors, with what each found."""
    found = [(bench.name, *judge(bench)) for bench in benches(grounds)]
    outcomes = {outcome for _, outcome, _ in found}
    outcome: Outcome = outcomes.pop() if len(outcomes) == 1 else "undecided"
    return Judgement(outcome, f"{reading}. " + "; ".join(f"{n}: {text}" for n, _, text in found))


def _outcome(condition: bool | np.bool) -> Outcome:
    return "holds" if condition else "fails"


def _horizons(grounds: Grounds[Configuration], phase: str) -> list[int]:
    """The horizons whose averages are printed."""
    return list(printed_averages(grounds.ledger, phase))


def _ratios(values: list[float]) -> str:
    return " : ".join(f"{value / values[0]:.1f}" for value in values)


def _growth_is_alike(grounds: Grounds[Configuration], phase: str) -> Judgement:
    averages = printed_averages(grounds.ledger, phase)
    horizons, printed = list(averages), [one.value for one in averages.values()]

    def judge(bench: Bench) -> tuple[Outcome, str]:
        ours = [bench.mean(phase, n) for n in horizons]
        off = [(p / printed[0]) / (o / ours[0]) for p, o in zip(printed, ours, strict=True)]
        alike = all(1.0 / ALIKE_GROWTH <= factor <= ALIKE_GROWTH for factor in off)
        return _outcome(alike), _ratios(ours)

    return _judged(
        grounds,
        f"printed averages over N of {', '.join(map(str, horizons))} are {_ratios(printed)}; alike "
        f"is read as within a factor of {ALIKE_GROWTH:g}",
        judge,
    )


def far_growth_is_alike(grounds: Grounds[Configuration]) -> Judgement:
    """Ratios of the printed averages over N1 against those of instructions."""
    return _growth_is_alike(grounds, FAR)


def mid_growth_is_alike(grounds: Grounds[Configuration]) -> Judgement:
    """The same over N2."""
    return _growth_is_alike(grounds, MID)


def final_growth_is_alike(grounds: Grounds[Configuration]) -> Judgement:
    """The same over N3."""
    return _growth_is_alike(grounds, FINAL)


def longer_horizons_take_longer(grounds: Grounds[Configuration]) -> Judgement:
    """Averages over the runs must grow from every horizon of every phase to the next."""

    def judge(bench: Bench) -> tuple[Outcome, str]:
        grows, said = [], []
        for phase in PHASES:
            means = [float(one.mean()) for one in bench.sweep(phase, "horizon").values()]
            grows += [after > before for before, after in pairwise(means)]
            said.append(f"{phase} {_ratios(means)}")
        return _outcome(all(grows)), ", ".join(said)

    return _judged(grounds, "average instructions of a solve by horizon", judge)


def short_horizons_spread_more(grounds: Grounds[Configuration]) -> Judgement:
    """N1 = 30 must spread most and 45 least, by the deviation or its share of the average."""
    short, middle, longest = _horizons(grounds, FAR)

    def judge(bench: Bench) -> tuple[Outcome, str]:
        runs = [bench.averages(FAR, n) for n in (short, middle, longest)]
        deviations = np.array([one.std() for one in runs])
        shares = deviations / [one.mean() for one in runs]
        said = [d.argmax() == 1 and d.argmin() == 2 for d in (deviations, shares)]
        text = ", ".join(f"{d / 1e3:.0f} ({100 * s:.1f} %)"
                         for d, s in zip(deviations, shares, strict=True))  # fmt: skip
        return _outcome(any(said)), text

    return _judged(
        grounds,
        f"deviation of the runs' averages for N1 of {short}, {middle}, {longest}, in thousand "
        f"instructions (and of the average); {middle} must have the largest and {longest} the "
        f"least, by either",
        judge,
    )


def _sample_times_are_alike(grounds: Grounds[Configuration], phase: str) -> Judgement:
    def judge(bench: Bench) -> tuple[Outcome, str]:
        sweep = bench.sweep(phase, "sample_time_s")
        runs = list(sweep.values())
        means, spreads = (np.array([f(one) for one in runs]) for f in (np.mean, np.std))
        alike = means.max() <= SIMILAR_MEAN * means.min()
        alike &= spreads.max() <= SIMILAR_SPREAD * spreads.min()
        text = ", ".join(f"{m / 1e6:.2f} +- {s / 1e6:.2f} for Ts of {t:g} s"
                         for t, m, s in zip(sweep, means, spreads, strict=True))  # fmt: skip
        return _outcome(alike), text

    return _judged(
        grounds,
        f"million instructions, with the runs' deviation; similar is read as averages within a "
        f"factor of {SIMILAR_MEAN:g} and deviations within {SIMILAR_SPREAD:g}",
        judge,
    )


def far_sample_times_are_alike(grounds: Grounds[Configuration]) -> Judgement:
    """Averages and deviations of the rendezvous phase over its sample times."""
    return _sample_times_are_alike(grounds, FAR)


def mid_sample_times_are_alike(grounds: Grounds[Configuration]) -> Judgement:
    """Averages and deviations of the approach phase over its sample times."""
    return _sample_times_are_alike(grounds, MID)


def _spread_less(grounds: Grounds[Configuration], *phases: str) -> Judgement:
    def judge(bench: Bench) -> tuple[Outcome, str]:
        found = {}
        for phase in (FAR, *phases):
            runs = [bench.averages(phase, n) for n in _horizons(grounds, phase)]
            found[phase] = max(np.ptp(one) for one in runs), max(one.std() for one in runs)
        less = all(
            one < other for phase in phases
            for one, other in zip(found[phase], found[FAR], strict=True)
        )  # fmt: skip
        text = ", ".join(f"{p} {r / 1e6:.2f} and {s / 1e6:.2f}" for p, (r, s) in found.items())
        return _outcome(less), text

    return _judged(
        grounds,
        "largest range and deviation of the runs' averages over the printed horizons, in million "
        "instructions",
        judge,
    )


def approach_spreads_less(grounds: Grounds[Configuration]) -> Judgement:
    """Largest range and deviation of the approach against those of the rendezvous phase."""
    return _spread_less(grounds, MID)


def close_phases_spread_less(grounds: Grounds[Configuration]) -> Judgement:
    """The same for the approach and the docking phase."""
    return _spread_less(grounds, MID, FINAL)


def _worst_below(
    grounds: Grounds[Configuration], reading: str, limit_s: Callable[[pd.Series], pd.Series]
) -> Judgement:
    """The worst solve of every case against a limit, s, that its sample time, s, sets."""

    def judge(bench: Bench) -> tuple[Outcome, str]:
        rows = pd.concat([bench.worst(phase) for phase in PHASES])
        limit = SECOND_MS * limit_s(rows["sample_time_s"])
        low, high = ((rows[f"ms_{end}"] / limit).max() for end in ("low", "high"))
        outcome: Outcome = "holds" if high < 1.0 else "fails" if low > 1.0 else "undecided"
        worst = rows.sort_values("ms_high").iloc[-1]
        return outcome, (
            f"{100 * low:.1f} to {100 * high:.1f} % of the limit at worst; the longest solve is "
            f"{worst['ms_low']:.0f} to {worst['ms_high']:.0f} ms ({worst['phase']}, "
            f"N {worst['horizon']})"
        )

    clock = grounds.section.flight_computer.clock_MHz
    return _judged(grounds, f"{reading}, at {clock:g} MHz between the bounds of cycles", judge)


def solves_take_less_than_a_second(grounds: Grounds[Configuration]) -> Judgement:
    """The worst solve of every case of every phase, at the largest bound of its cycles."""
    return _worst_below(
        grounds,
        "the worst solve of every case against a second",
        lambda sample_time: sample_time**0,
    )


def solves_leave_ample_time(grounds: Grounds[Configuration]) -> Judgement:
    """The worst solve of every case, at the largest bound, against a share of its sample time."""
    return _worst_below(
        grounds,
        f"the worst solve of every case against {100 * AMPLE:g} % of its sample time, which is "
        f"what ample, and little delay, are read as",
        lambda sample_time: AMPLE * sample_time,
    )


def approach_nearly_doubles(grounds: Grounds[Configuration]) -> Judgement:
    """From the middle to the longest N2 the instructions must grow by a factor in `NEARLY_TWO`."""
    _, middle, longest = _horizons(grounds, MID)

    def judge(bench: Bench) -> tuple[Outcome, str]:
        factor = bench.mean(MID, longest) / bench.mean(MID, middle)
        return _outcome(NEARLY_TWO[0] <= factor <= NEARLY_TWO[1]), f"{factor:.2f}"

    return _judged(
        grounds,
        f"factor from N2 of {middle} to {longest}; almost double is read as "
        f"{' to '.join(map(str, NEARLY_TWO))}",
        judge,
    )


def longest_rendezvous_horizon_doubles(grounds: Grounds[Configuration]) -> Judgement:
    """From N1 = 30 to 45 the instructions must more than double."""
    averages = printed_averages(grounds.ledger, FAR)
    _, middle, longest = averages
    printed = averages[longest].value / averages[middle].value

    def judge(bench: Bench) -> tuple[Outcome, str]:
        factor = bench.mean(FAR, longest) / bench.mean(FAR, middle)
        return _outcome(factor > 2.0), f"{factor:.2f}"

    return _judged(
        grounds,
        f"factor from N1 of {middle} to {longest}; the printed averages give {printed:.2f}, which "
        f"is more than double, and of the document's own solves the sentence is true",
        judge,
    )


def docking_horizons_are_close(grounds: Grounds[Configuration]) -> Judgement:
    """N3 = 15 against 12: averages no further apart than each distribution is wide.

    The sentence speaks of the distributions of Figure 6.7. A factor near one would be no reading of
    it: a solve whose work grows with its horizon can not come nearer than 15/12.
    """
    chosen = grounds.section.phases.final.horizon
    other = int(grounds.ledger.value("section-6-2/alternative-horizon-not-used").value)
    printed = {n: one.value for n, one in printed_averages(grounds.ledger, FINAL).items()}
    longest = max(printed)
    share = np.log(other / chosen) / np.log(longest / chosen)
    factor = (printed[longest] / printed[chosen]) ** share

    def judge(bench: Bench) -> tuple[Outcome, str]:
        runs = [bench.averages(FINAL, n) / 1e6 for n in (chosen, other)]
        apart = abs(runs[1].mean() - runs[0].mean())
        text = " and ".join(f"{one.mean():.2f} +- {one.std():.2f}" for one in runs)
        return _outcome(apart <= min(one.std() for one in runs)), text

    return _judged(
        grounds,
        f"million instructions for N3 of {chosen} and {other}, with the runs' deviation; very "
        f"close is read as averages that differ by less than either deviation. The printed "
        f"averages for {chosen} and {longest}, of which the growth is a power, would themselves "
        f"give a factor of {factor:.2f}",
        judge,
    )


def docking_is_fastest(grounds: Grounds[Configuration]) -> Judgement:
    """The shortest, middle and longest horizon of docking against those of both other phases."""

    def judge(bench: Bench) -> tuple[Outcome, str]:
        means = {p: [bench.mean(p, n) for n in _horizons(grounds, p)] for p in PHASES}
        faster = [
            one < other
            for phase in (FAR, MID)
            for one, other in zip(means[FINAL], means[phase], strict=True)
        ]
        text = ", ".join(f"{p} {' / '.join(f'{m / 1e6:.1f}' for m in means[p])}" for p in PHASES)
        return _outcome(all(faster)), text

    return _judged(
        grounds,
        "million instructions of a solve at the shortest, middle and longest printed horizon",
        judge,
    )


def guidance_runs_on_target(grounds: Grounds[Configuration]) -> Judgement:
    """The rendezvous that the flight program guides over a socket must end as the native one."""
    row = grounds.table("flight/link.csv").to_dict("records")[0]
    equal = row["steps"] == row["native_steps"] and row["position_m"] <= row["tolerance_m"]
    outcome: Outcome = "holds" if row["docked"] and equal else "fails"
    return Judgement(
        outcome,
        f"guided from an emulated {row['processor']} over a socket the chaser docks after "
        f"{row['steps']} steps, the native guidance after {row['native_steps']}; positions differ "
        f"by {row['position_m']:.1e} m at most, {row['tolerance_m']:g} m are allowed",
    )
