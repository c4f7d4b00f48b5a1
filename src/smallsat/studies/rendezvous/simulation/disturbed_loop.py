"""The guidance law in closed loop with disturbances (chapter 5).

The motion is that of `smallsat.studies.rendezvous.model.truth`, thrusters burn for a time with a
wrong force, and the law knows only a measured or filtered state. By Algorithm 1 that estimate also
decides when a phase ends.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.optimal_control.riccati_interior_point import workspace
from smallsat.studies.rendezvous.guidance.law import Law, settings
from smallsat.studies.rendezvous.guidance.phase_programs import BOUNDS, PLANES, program_room
from smallsat.studies.rendezvous.model import actuation_noise, navigation_filter
from smallsat.studies.rendezvous.model.actuation_noise import Interval
from smallsat.studies.rendezvous.model.navigation_filter import FilterModel
from smallsat.studies.rendezvous.model.thrusters import pulse_on_times
from smallsat.studies.rendezvous.model.truth import (
    Environment,
    advance,
    pair_from_relative,
    relative_state,
)
from smallsat.studies.rendezvous.simulation.closed_loop import (
    Manoeuvres,
    add_step,
    next_control,
    phase_ended,
)
from smallsat.studies.rendezvous.simulation.closed_loop import advance as predicted

# Of the thrust's amplitude error w (5.2).
ERROR_RANGE = (-1.0, 1.0)


class Disturbances(NamedTuple):
    """What the law does not know, in SI units.

    Attributes
    ----------
    environment, target
        Of `smallsat.studies.rendezvous.model.truth`: the Earth and the bodies; the target's
        inertial state (6,).
    mass, force, minimum_on_time
        Of the chaser; of a thruster; of a pulse.
    burns
        Whether a pulse takes the time that its impulse needs, from its step's start; else the
        impulse acts at once, as the prediction has it.
    error_start, error_transitions, error_factors
        Of the thrust's amplitude error: `actuation_noise.stationary_factor`, and the two arrays of
        `actuation_noise.Interval` for the sample time of each phase, (3, 2, 2). Zeros: no error.
    position_deviation, velocity_deviation
        Standard deviations of a measurement's error along each axis (Eqs. 5.6 and 5.7).
    filtered
        Whether a Kalman filter stands between measurement and guidance.
    filter_model, filter_transitions
        Of `navigation_filter`; of each phase's prediction over its sample time, (3, 6, 6).
    """

    environment: Environment
    target: np.ndarray
    mass: float
    force: float
    minimum_on_time: float
    burns: bool
    error_start: np.ndarray
    error_transitions: np.ndarray
    error_factors: np.ndarray
    position_deviation: float
    velocity_deviation: float
    filtered: bool
    filter_model: FilterModel
    filter_transitions: np.ndarray


class Passages(NamedTuple):
    """Where a manoeuvre that ends at the smallest distance and the longest limit passed others.

    The control does not depend on either, so that one manoeuvre tells the outcome for all of them.

    Attributes
    ----------
    distances, limits
        Docking distances, m, (D,), and time limits, s, (L,).
    times, delta_v
        When the docking phase first came within each distance, s, and the delta-v until then, m/s;
        (M, D), not a number where it never did.
    delta_v_at_limits
        Delta-v of the steps that end by each limit, m/s, (M, L); not a number where the manoeuvre
        ended before.
    """

    distances: np.ndarray
    limits: np.ndarray
    times: np.ndarray
    delta_v: np.ndarray
    delta_v_at_limits: np.ndarray


@compiled
def _measure(truth, disturbances, generator, measured):
    """Fill `measured`, (6,), from the true relative state."""
    for k in range(6):
        deviation = disturbances.position_deviation if k < 3 else disturbances.velocity_deviation
        measured[k] = truth[k] + deviation * generator.standard_normal()


@compiled
def _port_distance(law, state, time):
    """Distance from the docking port, m."""
    c, s = np.cos(law.rotation_rate * time), np.sin(law.rotation_rate * time)
    x = state[0] - law.port * (c * law.axis[0] - s * law.axis[1])
    y = state[1] - law.port * (s * law.axis[0] + c * law.axis[1])
    z = state[2] - law.port * law.axis[2]
    return np.sqrt(x * x + y * y + z * z)


@compiled
def fly_disturbed(
    law, start, phases, disturbances, generator, room, work, counts, sums, ends,
    distances, limits, reading, passages, at_limits,
):  # fmt: skip
    """One manoeuvre; fills all arrays from `counts` on. Returns whether the last phase ended.

    Arrays are those of `closed_loop.fly`; `passages` is (2, D) and `at_limits` (L,), in which
    `reading`, a row of `sums`, says how velocity changes are added up. Each step draws eight normal
    numbers whatever is disturbed, so that variants have them in common.
    """
    pair = pair_from_relative(disturbances.target, start)
    measured, estimate, moved = np.empty(6), np.empty(6), np.empty(6)
    covariance = np.empty((6, 6))
    command, applied, burn, idle = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    on_times = np.zeros(3)
    plan, place = np.empty(work.controls.shape), np.zeros(2, np.int64)
    axis, faces = np.empty(3), np.empty((4, 3))
    w, v = actuation_noise.start(
        disturbances.error_start, generator.standard_normal(), generator.standard_normal()
    )
    _measure(start, disturbances, generator, measured)
    estimate[:] = measured
    if disturbances.filtered:
        navigation_filter.begin(measured, disturbances.filter_model, estimate, covariance)
    time, total = 0.0, 0.0
    for phase in range(phases[0], phases[1] + 1):
        duration, delay = law.sample_times[phase], law.delays[phase]
        between = Interval(disturbances.error_transitions[phase], disturbances.error_factors[phase])
        place[:] = 0
        while True:
            for i in range(len(limits)):
                if np.isnan(at_limits[i]) and time + duration > limits[i]:
                    at_limits[i] = total
            if time + duration > law.time_limit:
                return False
            predicted(law.predictions_before[phase], estimate, moved)
            status, iterations, softened, outside = next_control(
                law, phase, moved, time, room, work, plan, place, command
            )
            pulse_on_times(
                command, disturbances.mass, disturbances.force, disturbances.minimum_on_time,
                on_times,
            )  # fmt: skip
            size = (
                (1.0 + min(max(w, ERROR_RANGE[0]), ERROR_RANGE[1]))
                * disturbances.force
                / disturbances.mass
            )
            for k in range(3):
                burn[k] = size if command[k] >= 0.0 else -size
                applied[k] = burn[k] * on_times[k]
            if delay > 0.0:
                advance(pair, time, delay, burn, idle, disturbances.environment)
            if disturbances.burns:
                for k in range(3):
                    applied[k] = burn[k] * min(on_times[k], duration - delay)
            else:
                truth = relative_state(pair)
                for k in range(3):
                    truth[3 + k] += applied[k]
                    on_times[k] = 0.0
                pair = pair_from_relative(pair[0], truth)
            advance(pair, time + delay, duration - delay, burn, on_times, disturbances.environment)
            w, v = actuation_noise.step(
                w, v, between, generator.standard_normal(), generator.standard_normal()
            )
            time += duration
            truth = relative_state(pair)
            _measure(truth, disturbances, generator, measured)
            if disturbances.filtered:
                navigation_filter.predict(
                    estimate, covariance, command, disturbances.filter_transitions[phase],
                    duration, disturbances.filter_model,
                )  # fmt: skip
                navigation_filter.update(estimate, covariance, measured, disturbances.filter_model)
            else:
                estimate[:] = measured
            add_step(phase, applied, status, iterations, softened, outside, counts, sums)
            total = sums[reading].sum()
            sums[3, phase] = time
            ends[phase] = truth
            if phase == 2:
                distance = _port_distance(law, estimate, time)
                for i in range(len(distances)):
                    if np.isnan(passages[0, i]) and distance <= distances[i]:
                        passages[0, i], passages[1, i] = time, total
            if phase_ended(law, phase, estimate, time, axis, faces):
                break
    return True


def disturbed_manoeuvres(
    law: Law,
    starts: np.ndarray,
    disturbances: Disturbances,
    generators: Sequence[np.random.Generator],
    phases: tuple[int, int] = (0, 2),
    distances: Sequence[float] = (),
    limits: Sequence[float] = (),
    reading: int = 0,
) -> tuple[Manoeuvres, Passages]:
    """Fly one manoeuvre a start.

    Parameters
    ----------
    law
        Of all of them.
    starts
        Relative states, (M, 6), m and m/s.
    disturbances
        Of all of them.
    generators
        Random stream of each manoeuvre.
    phases
        First and last phase.
    distances, limits
        Of `Passages`.
    reading
        How delta-v is added up in them: by the 2-norm, the 1-norm, or that of the orbit's plane
        plus the component out of it (0, 1, 2).
    """
    record = settings([law])[0]
    starts = np.ascontiguousarray(np.atleast_2d(starts), dtype=float)
    number = len(starts)
    longest = max(law.horizons)
    room, work = program_room(longest), workspace(longest, PLANES, BOUNDS)
    counts = np.zeros((number, 5, 3), np.int64)
    sums, ends = np.zeros((number, 4, 3)), np.full((number, 3, 6), np.nan)
    passages = np.full((number, 2, len(distances)), np.nan)
    at_limits = np.full((number, len(limits)), np.nan)
    radii, times = np.array(distances, dtype=float), np.array(limits, dtype=float)
    docked = np.zeros(number, bool)
    for m in range(number):
        docked[m] = fly_disturbed(
            record, starts[m], phases, disturbances, generators[m], room, work,
            counts[m], sums[m], ends[m], radii, times, reading, passages[m], at_limits[m],
        )  # fmt: skip
    flown = Manoeuvres(
        docked, counts[:, 0], sums[:, 0], sums[:, 1], sums[:, 2], ends, sums[:, 3],
        counts[:, 1], counts[:, 2], counts[:, 3], counts[:, 4], [],
    )  # fmt: skip
    return flown, Passages(radii, times, passages[:, 0], passages[:, 1], at_limits)
