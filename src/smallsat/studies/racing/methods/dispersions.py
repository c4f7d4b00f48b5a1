"""The optimal plans flown open loop, where not all is as it was planned.

A flight begins off its place and velocity, its thrust is stronger or weaker than planned by a
share, and its thrusters are turned by a small constant angle. All is linear in these ten numbers,
but for the turn, which is to first order. A miss is the part of the offset at the planned time
across the ring's normal, along which the CubeSat moves.
"""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import held_input_rows, transition
from smallsat.studies.racing.configuration import Configuration, Dispersions
from smallsat.studies.racing.methods.course_program import Plan
from smallsat.studies.racing.methods.weighted_misses import centred_plan, racers
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.parameters import Parameters

# Places of each kind of error among the ten.
SOURCES = {
    "position": slice(0, 3),
    "velocity": slice(3, 6),
    "thrust": slice(6, 7),
    "pointing": slice(7, 10),
}
TOGETHER = "all together"
OPEN_LOOP, EACH_RING = "open loop", "put back at each ring"
# What is flown, with which errors: each by itself in open loop alone.
ALL = slice(0, 10)
FLOWN = [(OPEN_LOOP, source, chosen) for source, chosen in SOURCES.items()]
FLOWN += [(kind, TOGETHER, ALL) for kind in (OPEN_LOOP, EACH_RING)]
# Of all flights, these may miss before something has to be done.
FAILING = 0.05
# A miss below this counts as this, m.
TINY = 1e-9
KEYS = ["scenario", "cubesat", "flown", "source"]
RINGS = [*KEYS, "ring", "arrival_s", "size_m", "median_m", "most_m", "passed_share"]
FLIGHTS = [*KEYS, "passed_share", "first_ring", "first_s", "factor"]


def sensitivities(plan: Plan, mean_motion: float, put_back: bool) -> np.ndarray:
    """The state's errors at the ends of the segments by the ten of a flight, (m, 6, 10).

    ``put_back`` says that the state is the planned one again at each ring, so that only thrust and
    turn of the segment itself count.
    """
    segments, intervals = plan.controls.shape[:2]
    found = np.empty((segments, 6, 10))
    at_start = np.zeros((6, 10))
    at_start[:, :6] = np.eye(6)
    state = at_start
    for k in range(segments):
        h = plan.durations[k] / intervals
        free, forced = transition(mean_motion, h), np.array(held_input_rows(mean_motion, h))
        state = np.zeros((6, 10)) if put_back and k else state
        for u in plan.controls[k]:
            push = np.column_stack([np.zeros((3, 6)), u, np.cross(np.eye(3), u).T])
            state = free @ state + forced @ push
        found[k] = state
    return found


def errors(numbers: Dispersions) -> np.ndarray:
    """The ten errors of each flight (f, 10): m, m/s, a share and radians, normally distributed."""
    deviations = np.r_[
        np.full(3, numbers.position_m),
        np.full(3, numbers.velocity_m_s),
        0.01 * numbers.thrust_pct,
        np.full(3, np.radians(numbers.pointing_deg)),
    ]
    draws = np.random.default_rng(numbers.seed).standard_normal((numbers.flights, 10))
    return draws * deviations


def flown_misses(sensitivity: np.ndarray, course: Course, flights: np.ndarray) -> np.ndarray:
    """Misses (f, l), m, of flights with errors (f, 10), by sensitivities (m, 6, 10)."""
    offsets = np.einsum("kij,fj->fki", sensitivity[: course.rings, :3], flights)
    along = np.sum(offsets * course.normals, axis=2, keepdims=True)
    return np.linalg.norm(offsets - along * course.normals, axis=2)


def dispersion_tables(
    parameters: Parameters, section: Configuration
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """What open-loop flights miss, by ring, and in short by CubeSat; solved races alone.

    Returns
    -------
    rings, flights
        By scenario, CubeSat, kind of flight, source of errors and ring: planned arrival, s, size,
        m, the median of the misses and what all but `FAILING` stay below, m, and the share of
        flights that have passed all rings so far. And by the first four: the share that pass all
        rings, the first ring by which more than `FAILING` have missed one, with its planned
        arrival, s, where it comes to that, and the factor on the standard deviations up to which
        it would not.
    """
    rings, flights = [], []
    drawn = errors(section.dispersions)
    for scenario, cubesat in racers(parameters):
        course = parameters.races[scenario].course
        plan = centred_plan(parameters, section, scenario, cubesat)
        if not plan.converged:
            continue
        arrivals = np.cumsum(plan.durations)[: course.rings]
        for kind, source, chosen in FLOWN:
            own = np.zeros_like(drawn)
            own[:, chosen] = drawn[:, chosen]
            sensitivity = sensitivities(plan, parameters.mean_motion, kind == EACH_RING)
            missed = flown_misses(sensitivity, course, own)
            key = dict(zip(KEYS, (scenario, cubesat.name, kind, source), strict=True))
            by_ring, short = _statistics(missed, course.sizes, arrivals)
            rings += [key | row for row in by_ring]
            flights.append(key | short)
    return pd.DataFrame(rings, columns=RINGS), pd.DataFrame(flights, columns=FLIGHTS)


def _statistics(
    missed: np.ndarray, sizes: np.ndarray, arrivals: np.ndarray
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Rows of the rings, and the row of the flights, from misses (f, l)."""
    passed = np.cumprod(missed <= sizes, axis=1).mean(axis=0)
    rows = [
        {
            "ring": k + 1,
            "arrival_s": float(arrivals[k]),
            "size_m": float(sizes[k]),
            "median_m": float(np.median(missed[:, k])),
            "most_m": float(np.quantile(missed[:, k], 1.0 - FAILING)),
            "passed_share": float(passed[k]),
        }
        for k in range(len(sizes))
    ]
    late = np.flatnonzero(passed < 1.0 - FAILING)
    # By linearity a flight passes all rings with its errors times at most this.
    room = np.min(sizes / np.maximum(missed, TINY), axis=1)
    return rows, {
        "passed_share": float(passed[-1]),
        "first_ring": late[0] + 1 if len(late) else np.nan,
        "first_s": float(arrivals[late[0]]) if len(late) else np.nan,
        "factor": float(np.quantile(room, FAILING)),
    }
