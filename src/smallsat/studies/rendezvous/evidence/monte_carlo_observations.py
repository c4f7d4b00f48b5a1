"""What chapters 4 and 5 print as numbers, computed, with the interval of another sample."""

from collections.abc import Iterator
from itertools import pairwise
from math import inf, nan

import numpy as np
from scipy.special import gammaln
from scipy.stats import betabinom

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.observation import Observation
from smallsat.statistics.bootstrap import effect
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.robustness_claims import mean_deviation
from smallsat.studies.rendezvous.evidence.sweeps import (
    DELTA_V,
    STEPS,
    TIME,
    Sweep,
    infeasible_share,
)
from smallsat.studies.rendezvous.model.actuation_noise import readings_table
from smallsat.studies.rendezvous.monte_carlo.cases import AS_DOCUMENTED
from smallsat.studies.rendezvous.monte_carlo.tables import column
from smallsat.studies.rendezvous.simulation.disturbances import thrust_noise

# Share of the document's sample from which our largest value bounds another sample's: failures
# leave a few out. It was all of it until a first run was seen; no verdict changed.
ENOUGH = 0.9
# Distance of the ticks of the axes whose ends the document prints.
APPROACH_TICKS = {TIME: 2.0, STEPS: 10.0, DELTA_V: 2.0}
DOCKING_TICKS = {TIME: 0.5, STEPS: 50.0, DELTA_V: 0.05}


def study_observations(grounds: Grounds) -> list[Observation]:
    """All observations of chapters 4, 5 and 7 that rest on many manoeuvres."""
    found: list[Observation] = []
    for one in (_failures, _smallest_saving, _infeasible, _axes, _thrust_error, _deviations):
        try:
            found += one(grounds)
        except LookupError:
            # A what-if run may leave out the case.
            continue
    return found


def predictive_count(
    failures: int, trials: int, confidence: float, samples: int
) -> tuple[float, float]:
    """Interval of the failures in another sample of ``samples`` manoeuvres.

    Beta-binomial, from Jeffreys' prior and ``failures`` of ``trials``.
    """
    tail = 0.5 * (1.0 - confidence)
    law = betabinom(samples, failures + 0.5, trials - failures + 0.5)
    return float(law.ppf(tail)), float(law.ppf(1.0 - tail))


def predictive_maximum(
    values: np.ndarray, tick: float, confidence: float, samples: int
) -> tuple[float, float]:
    """Interval of the end of an automatic axis that shows another sample of ``samples`` values.

    The low end is the largest of our values that the largest of another sample stays below with no
    more than half of the error. An axis ends at most one tick above what it shows; how far another
    sample goes beyond ours is not known without a law of the tail, and a sample smaller than the
    other one bounds nothing.
    """
    ordered = np.sort(values)[::-1]
    n, m, tail = len(ordered), samples, 0.5 * (1.0 - confidence)
    k = np.arange(n)
    # Probability that all m new values lie below the k-th largest of n (from 0), any law.
    below = np.exp(gammaln(n + 1) - gammaln(n - k) + gammaln(n + m - k) - gammaln(n + m + 1))
    unlikely = np.flatnonzero(below <= tail)
    low = ordered[unlikely[0]] if len(unlikely) else ordered[-1]
    return float(low), float(ordered[0] + tick) if n >= ENOUGH * m else inf


def _samples(grounds: Grounds) -> int:
    """Size of the document's sample of initial states."""
    return int(grounds.ledger.value("section-4-1/number-of-points-run/v-bar-maneuver").value)


def _failures(grounds: Grounds) -> Iterator[Observation]:
    """Failures of each case, with the interval of their sum.

    Cases count as independent although they share their states. Were the same states to fail in
    all of them, the sum could be up to three times as far from ours; but then the printed counts
    would be equal.
    """
    sweep, samples = Sweep(grounds, "rendezvous"), _samples(grounds)
    ended = {case: sweep.rows(*case)["completed"] for case in ((30, 60), (45, 50), (45, 60))}
    low, high = predictive_count(
        sum(int((~one).sum()) for one in ended.values()),
        sum(len(one) for one in ended.values()),
        sweep.bootstrap.confidence,
        samples * len(ended),
    )
    for (n, t), one in ended.items():
        failed, trials = int((~one).sum()), len(one)
        yield Observation(
            f"rendezvous/section-4-2/cases-failing-to-rendezvous-within-limit/n1-{n}-ts-1-{t}-s",
            samples * failed / trials,
            f"{failed} of {trials} failed",
            low=low,
            high=high,
        )


def _smallest_saving(grounds: Grounds) -> Iterator[Observation]:
    sweep = Sweep(grounds, "rendezvous")
    n = sweep.horizons[1]
    intervals = list(pairwise(sweep.sample_times))
    values = sweep.values(DELTA_V, *[(n, t) for t in sweep.sample_times])
    changes = [b / a - 1.0 for a, b in pairwise(values)]
    for end, name in enumerate(("first", "second")):
        times = np.array([interval[end] for interval in intervals])

        def smallest(drawn: np.ndarray, times=times) -> np.ndarray:
            savings = np.stack([-np.median(one[drawn], axis=1) for one in changes])
            return times[np.argmin(np.abs(savings), axis=0)]

        found = effect(name, smallest, len(values[0]), sweep.bootstrap)
        yield Observation(
            "rendezvous/section-4-2/interval-with-small-delta-v-difference/diminishing-returns/"
            + name,
            found.value,
            f"N {n}, interval with the smallest median change",
            low=found.low,
            high=found.high,
        )


def _infeasible(grounds: Grounds) -> Iterator[Observation]:
    sweep = Sweep(grounds, "approach")
    n = sweep.horizons[0]
    times = np.array(sweep.sample_times)
    met = np.stack([infeasible_share(sweep.rows(n, t), "approach") for t in times])

    def longest(drawn: np.ndarray) -> np.ndarray:
        share = np.stack([one[drawn].mean(axis=1) for one in met])
        return np.where(share > 0.5, times[:, None], -np.inf).max(axis=0)

    found = effect("longest", longest, met.shape[1], sweep.bootstrap)
    some = np.isfinite([found.value, found.low, found.high]).all()
    yield Observation(
        "rendezvous/section-4-3/infeasible-sample-time/n2-5",
        found.value if some else nan,
        f"N {n}, longest sample time at which more than half meet an infeasible program",
        low=found.low if some else nan,
        high=found.high if some else nan,
        note="" if some else "no sample time is infeasible for more than half",
    )


def _axes(grounds: Grounds) -> Iterator[Observation]:
    approach, docking = (Sweep(grounds, phase) for phase in ("approach", "docking"))
    # The legend of Figure 4.7 has no shortest sample time.
    shown = approach.sample_times[1:]
    for figure, x, sweep, ticks, times, name, axis in (
        ("4-7-a", TIME, approach, APPROACH_TICKS, shown, "n2-5", "maneuver-time-min"),
        ("4-7-b", STEPS, approach, APPROACH_TICKS, shown, "n2-5",
         "number-of-approach-control-intervals"),
        ("4-10-a", TIME, docking, DOCKING_TICKS, docking.sample_times, "n3-5",
         "maneuver-time-min"),
        ("4-10-b", STEPS, docking, DOCKING_TICKS, docking.sample_times, "n3-5",
         "number-of-control-intervals-label-printed-approach"),
    ):  # fmt: skip
        for quantity, letter, label in (
            (x, "x", axis),
            (DELTA_V, "y", f"{sweep.phase}-delta-v"),
        ):
            unit = MINUTE if quantity == TIME else 1.0
            yield from _axis(
                sweep, _samples(grounds), quantity, times, ticks[quantity], unit,
                f"rendezvous/figure-{figure}/{letter}-axis-tick-range-{label}/{name}",
            )  # fmt: skip


def _axis(
    sweep: Sweep,
    samples: int,
    quantity: str,
    times: tuple[float, ...],
    tick: float,
    unit: float,
    name: str,
) -> Iterator[Observation]:
    """Both ends of an axis; a figure shows several cases, and the outermost one decides."""
    ends = []
    for t in times:
        rows = sweep.rows(sweep.horizons[0], t)
        values = rows.loc[rows["completed"], column(sweep.phase, quantity)].to_numpy() / unit
        if len(values):
            low, high = predictive_maximum(values, tick, sweep.bootstrap.confidence, samples)
            least, most = predictive_maximum(-values, tick, sweep.bootstrap.confidence, samples)
            ends.append((values.max(), low, high, values.min(), -most, -least))
    if not ends:
        raise LookupError(name)
    table = np.array(ends)
    run = f"N {sweep.horizons[0]}, as an automatic axis over the data"
    yield Observation(f"{name}/min", table[:, 3].min(), run, low=table[:, 4].min(),
                      high=table[:, 5].min())  # fmt: skip
    yield Observation(f"{name}/max", table[:, 0].max(), run, low=table[:, 1].max(),
                      high=table[:, 2].max())  # fmt: skip


def _thrust_error(grounds: Grounds[Configuration]) -> Iterator[Observation]:
    """Steady deviation of Eq. 5.3; the reading that is flown comes last."""
    error = grounds.section.studies.robustness.thrust_error
    readings = readings_table(thrust_noise(error)).set_index("reading")["steady_state_percent"]
    flown = error.reading
    for reading in (*readings.index.drop(flown), flown):
        yield Observation(
            "rendezvous/section-5-1/1-sigma-thrust-amplitude-error-range",
            float(readings[reading]),
            f"eta_w and eta_v read as {reading.replace('-', ' and ')}",
        )


def _deviations(grounds: Grounds) -> Iterator[Observation]:
    delta_v = mean_deviation(grounds, AS_DOCUMENTED, DELTA_V)
    time = mean_deviation(grounds, AS_DOCUMENTED, TIME)
    for where, of_delta_v, of_time in (
        (
            "section-5-4",
            "average-standard-deviation-of-delta-v",
            "average-standard-deviation-of-tf",
        ),
        ("chapter-7", "average-deviation-in-delta-v", "average-deviation-in-tf"),
    ):
        for name, found, unit in ((of_delta_v, delta_v, 1.0), (of_time, time, MINUTE)):
            yield Observation(
                f"rendezvous/{where}/{name}/monte-carlo",
                found.value / unit,
                "runs that the limit ends count as they ended",
                low=found.low / unit,
                high=found.high / unit,
            )
