"""Predicates of what chapter 2 says of models near elliptic orbits."""

from collections.abc import Callable

import numpy as np

from smallsat.dynamics.orbits import clohessy_wiltshire, yamanaka_ankersen
from smallsat.evidence.claims import Judgement
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration

# Of the largest entry of a matrix whose entries are of one unit: a hundred roundings.
ROUNDING = 1e-14
PLACES = 24  # of the orbit, at which the prediction begins

Transition = Callable[[float, float, float, float], np.ndarray]


def largest_difference(
    transition: Transition, n: float, e: float, durations: tuple[float, ...]
) -> float:
    """Largest entry's difference from Clohessy and Wiltshire's matrix, as a share of its largest.

    ``transition`` is a function of mean motion, eccentricity, true anomaly and duration. Velocities
    are in units of the mean motion, so that all entries are lengths.
    """
    scale = np.array([1.0] * 3 + [n] * 3)
    worst = 0.0
    for duration in durations:
        circular = clohessy_wiltshire.transition(n, duration) * scale / scale[:, None]
        for anomaly in np.linspace(0.0, 2.0 * np.pi, PLACES, endpoint=False):
            found = transition(n, e, anomaly, duration) * scale / scale[:, None]
            worst = max(worst, float(np.abs(found - circular).max() / np.abs(circular).max()))
    return worst


def elliptic_prediction_reduces(grounds: Grounds[Configuration]) -> Judgement:
    """Section 2.1.1: Yamanaka and Ankersen's matrix with no eccentricity, at all sample times."""
    n = grounds.section.inferred.mean_motion_rad_s
    phases = [phase for _, phase in grounds.section.phases]
    durations = (
        *(phase.sample_time_s for phase in phases),
        *(phase.sample_time_s * phase.horizon for phase in phases),
        2.0 * np.pi / n,
    )
    found = largest_difference(yamanaka_ankersen.transition, n, 0.0, durations)
    return Judgement(
        "holds" if found < ROUNDING else "fails",
        f"over sample times, horizons and an orbit, from {PLACES} places, entries differ by "
        f"{found:.1e} of the largest at most, to be rounding, {ROUNDING:g}",
    )
