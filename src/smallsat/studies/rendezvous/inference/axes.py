"""The printed axes of Figures 4.7 and 4.10, against where a parameter set's own data end.

The axes of the two figures are the only ones that can be read from the document's text. An
automatic axis encloses its data, so that data beyond it are a miss; how much of it they fill is
left open, since a few starts find less than the document's 500.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.guidance.law import APPROACH, DOCKING, Law, in_phase
from smallsat.studies.rendezvous.inference.misfit import WORST_SHARE
from smallsat.studies.rendezvous.parameters import STUDY_PHASES, law
from smallsat.studies.rendezvous.simulation.closed_loop import SUMS, Manoeuvres, simulate
from smallsat.studies.rendezvous.simulation.delta_v import READINGS

# Phase, its horizon and sample times, s, and the printed axis of each quantity.
FIGURES = {
    "Figure 4.7": (
        APPROACH,
        5,
        (10.0, 15.0, 20.0, 25.0, 30.0),
        {
            "time_min": "figure-4-7-a/x-axis-tick-range-maneuver-time-min/n2-5",
            "delta_v_m_s": "figure-4-7-a/y-axis-tick-range-approach-delta-v/n2-5",
            "intervals": "figure-4-7-b/x-axis-tick-range-number-of-approach-control-intervals/n2-5",
        },
    ),
    "Figure 4.10": (
        DOCKING,
        5,
        (1.0, 3.0, 5.0, 10.0),
        {
            "time_min": "figure-4-10-a/x-axis-tick-range-maneuver-time-min/n3-5",
            "delta_v_m_s": "figure-4-10-a/y-axis-tick-range-docking-delta-v/n3-5",
            "intervals": "figure-4-10-b/x-axis-tick-range-number-of-control-intervals-label-"
            "printed-approach/n3-5",
        },
    ),
}


class PrintedAxes(NamedTuple):
    """A printed figure's sample times, s, and the ends of its axes, least and most."""

    sample_times: tuple[float, ...]
    time_min: tuple[float, float]
    delta_v_m_s: tuple[float, float]
    intervals: tuple[float, float]


def printed_axes(phase: str, horizon: int, ledger: Ledger) -> PrintedAxes | None:
    """The printed axes of a phase's sweep with a horizon, where they can be read."""
    for place, own, sample_times, printed in FIGURES.values():
        if (STUDY_PHASES[place], own) == (phase, horizon):
            ends = {
                quantity: (
                    ledger.value(f"{name}/min").value,
                    ledger.value(f"{name}/max").value,
                )
                for quantity, name in printed.items()
            }
            return PrintedAxes(sample_times, **ends)
    return None


def _ends(printed: dict[str, str], ledger: Ledger) -> Iterator[tuple[str, str, float]]:
    """Quantity, ``min`` or ``max``, and place of each end of a figure's axes that is no origin."""
    for quantity, name in printed.items():
        for extreme in ("min", "max"):
            end = ledger.value(f"{name}/{extreme}").value
            if end > 0.0:
                yield quantity, extreme, end


def missed_axes(ledger: Ledger) -> float:
    """The part of the misfit of a set that misses every end of the printed axes."""
    ends = sum(len(list(_ends(printed, ledger))) for *_, printed in FIGURES.values())
    return ends * WORST_SHARE**2


# A phase is given up at so many times its axis; what is beyond is no better there.
BEYOND = 3.0


def axes(section: Cases, starts: np.ndarray, ledger: Ledger) -> pd.DataFrame:
    """Where data of a set from a few starts, (n, 6), end on each printed axis.

    A row an axis and end, ``least`` or ``most``: ``cell``, ``printed``, and for each of `READINGS`
    ``computed <r>`` and ``residual <r>``, zero within the axis, else in assumed errors of its
    logarithm. A manoeuvre that does not end is at most as bad as `WORST_SHARE`. ``start <r>`` is
    the place among the starts of what ends there, or of what does not end; ``lost`` counts starts
    from which the phase did not begin.
    """
    base = law(section)
    begun, places, rows = starts, np.arange(len(starts)), []
    for figure, (phase, horizon, sample_times, printed) in FIGURES.items():
        # The phase before, by the printed horizons and sample times.
        before = simulate([base], begun, (phase - 1, phase - 1))
        begun, places = before.ends[before.docked, phase - 1], places[before.docked]
        limit = BEYOND * ledger.value(f"{printed['time_min']}/max").value * MINUTE
        flown = [
            simulate([_sampled(base, phase, horizon, time, limit)], begun, (phase, phase))
            for time in sample_times
            if len(begun)
        ]
        rows += _rows(section, figure, phase, flown, places, printed, ledger)
        lost = len(starts) - len(begun)
    return pd.DataFrame(rows).assign(lost=lost)


def _sampled(base: Law, phase: int, horizon: int, sample_time: float, limit: float) -> Law:
    return base.with_(
        horizons=in_phase(base.horizons, phase, horizon),
        sample_times=in_phase(base.sample_times, phase, sample_time),
        time_limit=limit,
    )


def _rows(
    section: Cases,
    figure: str,
    phase: int,
    flown: Sequence[Manoeuvres],
    places: np.ndarray,
    printed: dict[str, str],
    ledger: Ledger,
) -> list[dict]:
    rows = []
    docked = all(bool(one.docked.all()) for one in flown) and len(flown) > 0
    ended = np.concatenate([places[one.docked] for one in flown] or [places])
    stalled = np.concatenate([places[~one.docked] for one in flown] or [places])
    for quantity, extreme, axis in _ends(printed, ledger):
        end = {"min": "least", "max": "most"}[extreme]
        row = {"kind": "axes", "cell": f"{figure} {quantity} {end}", "printed": axis}
        for reading in READINGS:
            found = [_data(one, phase, quantity, reading) for one in flown]
            data = np.concatenate(found) if found else np.empty(0)
            value = float(getattr(data, extreme)()) if len(data) else np.nan
            beyond = value / axis if end == "most" else axis / value
            miss = max(np.log(beyond), 0.0) / section.inference.axis_error
            if np.isnan(value) or (end == "most" and not docked):
                miss = WORST_SHARE
            row[f"computed {reading}"] = value
            row[f"residual {reading}"] = float(min(miss, WORST_SHARE))
            if end == "most" and len(stalled):
                row[f"start {reading}"] = int(stalled[0])
            elif len(data):
                row[f"start {reading}"] = int(ended[getattr(data, f"arg{extreme}")()])
        rows.append(row)
    return rows


def _data(flown: Manoeuvres, phase: int, quantity: str, reading: str) -> np.ndarray:
    """What a figure has on an axis, of the manoeuvres that ended."""
    own = flown.docked
    if quantity == "time_min":
        return flown.end_times[own, phase] / MINUTE
    if quantity == "intervals":
        return flown.steps[own, phase].astype(float)
    return getattr(flown, SUMS[reading][1])[own, phase]
