"""How far ahead linear models predict where the target's orbit is an ellipse (section 2.1.1).

Open loop: two bodies in the central field, without drag or control. What is predicted is the
relative state in the target's Hill frame, which turns with it, from a state that is known. The
perigee is as high as the circular orbit of the document, so that ever more eccentric orbits end at
a geostationary transfer orbit, the document's own example.
"""

from collections.abc import Callable

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits import clohessy_wiltshire, yamanaka_ankersen
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.model.environment import (
    central,
    elliptic_mean_motion,
    elliptic_target,
    environment,
)
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table

# State transition (6, 6) by mean motion, eccentricity, true anomaly and duration. Clohessy and
# Wiltshire's equations have one rate: the mean motion, or that of the frame at the start.
MODELS: dict[str, Callable[[float, float, float, float], np.ndarray]] = {
    "Clohessy-Wiltshire, mean rate": lambda n, e, f, t: clohessy_wiltshire.transition(n, t),
    "Clohessy-Wiltshire, rate at the start": lambda n, e, f, t: clohessy_wiltshire.transition(
        yamanaka_ankersen.frame_rate(n, e, f), t
    ),
    "Yamanaka-Ankersen": yamanaka_ankersen.transition,
}
QUANTILES = {"low": 0.05, "median": 0.5, "high": 0.95}


def look_aheads(section: Configuration) -> tuple[float, ...]:
    """Times ahead, s, that errors are given at: the configured ones and the phases' horizons."""
    return tuple(sorted({*section.elliptic.look_ahead_s, *_horizons(section).values()}))


def _horizons(section: Configuration) -> dict[str, float]:
    return {name: phase.horizon * phase.sample_time_s for name, phase in section.phases}


def at_horizons(section: Configuration, table: pd.DataFrame) -> pd.DataFrame:
    """Median errors of `errors` over each phase's horizon: ``far_m``, ``mid_m``, ``final_m``."""
    rows = table.set_index(["eccentricity", "model"], drop=True)
    columns = {
        f"{name}_m": rows.loc[rows["look_ahead_s"] == horizon, "median_m"]
        for name, horizon in _horizons(section).items()
    }
    return pd.DataFrame(columns).reset_index()


def errors(section: Configuration) -> pd.DataFrame:
    """Errors of the predicted position over initial states and places of the orbit.

    Returns
    -------
    pandas.DataFrame
        A row an ``eccentricity``, ``model`` and ``look_ahead_s``: ``low_m``, ``median_m`` and
        ``high_m``, the 5, 50 and 95 % quantiles of the distance between predicted and true
        position, m.
    """
    settings, times = section.elliptic, look_aheads(section)
    table = states_table(section, settings.states, section.studies.seed)
    states = table[STATE].to_numpy()
    anomalies = 2.0 * np.pi * np.arange(settings.anomalies) / settings.anomalies
    circular = base(section).mean_motion
    rows = []
    for e in settings.eccentricities:
        n = elliptic_mean_motion(circular, e)
        true = np.array([motions(section, e, f, states) for f in anomalies])
        for name, transition in MODELS.items():
            predicted = np.array(
                [[states @ transition(n, e, f, t).T for t in times] for f in anomalies]
            )
            off = np.linalg.norm((predicted - true)[..., :3], axis=-1)
            for k, time in enumerate(times):
                found = {
                    f"{label}_m": float(np.quantile(off[:, k], level))
                    for label, level in QUANTILES.items()
                }
                rows.append({"eccentricity": e, "model": name, "look_ahead_s": time} | found)
    return pd.DataFrame(rows)


def motions(section: Configuration, e: float, anomaly: float, states: np.ndarray) -> np.ndarray:
    """True relative states (T, M, 6), m and m/s, at the look-ahead times from M states (M, 6).

    The target begins at a true anomaly, rad, of an orbit with eccentricity ``e``.
    """
    circular = base(section).mean_motion
    field = environment(central(section.truth), circular, section.spacecraft.mass_kg)
    target = elliptic_target(section.truth, circular, e, anomaly)
    idle, found = np.zeros(3), []
    for state in states:
        pair, passed = pair_from_relative(target, state), []
        for duration in np.diff(look_aheads(section), prepend=0.0):
            advance(pair, 0.0, float(duration), idle, idle, field)
            passed.append(relative_state(pair))
        found.append(passed)
    return np.swapaxes(np.array(found), 0, 1)
