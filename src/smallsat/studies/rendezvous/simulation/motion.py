"""What the guidance moves and what it is told of it: the motion that a closed loop is run with.

Linear motion, `None` in place of a `NonlinearMotion`, is that of Clohessy and Wiltshire's equations
with a state that is known and changes of velocity as commanded, at once or by burns. Every function
here takes either, and is compiled for each on its own. What moves is a pair of states (2, 6), of
the target and the chaser: inertial ones, or for linear motion those in the target's Hill frame, in
whose origin the target rests. Relative states are positions, m, and velocities, m/s, in that frame.
"""

from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.studies.rendezvous.model import actuation_noise, navigation_filter
from smallsat.studies.rendezvous.model.actuation_noise import Interval
from smallsat.studies.rendezvous.model.measurement_noise import error_share
from smallsat.studies.rendezvous.model.navigation_filter import FilterModel
from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import (
    Environment,
    advance,
    pair_from_relative,
    relative_state,
)

# How a velocity change comes about: as commanded and at once; as the thrusters' pulses give it, but
# at once; or as they give it, in the time that they take from the step's start.
COMMANDED, IMPULSES, BURNS = 0, 1, 2
# The thrust's amplitude error w stays in these bounds (5.2).
ERROR_RANGE = (-1.0, 1.0)
# Normal numbers that a step draws at most: for the thrust's error and for six measurements.
NUMBERS_A_STEP = 8


class NonlinearMotion(NamedTuple):
    """Two bodies in the Earth's field and air, with what the law does not know, in SI units.

    Attributes
    ----------
    environment, target
        The Earth and the bodies, see `smallsat.studies.rendezvous.model.truth`; the target's
        inertial state (6,) at time zero.
    mass, force, minimum_on_time, flown_from
        Mass of the chaser, force of a thruster, least time of a pulse, and the time from which on a
        shorter one is lengthened to it.
    actuation
        `COMMANDED`, `IMPULSES` or `BURNS`.
    error_start, error_transitions, error_factors
        The thrust's amplitude error: `actuation_noise.stationary_factor`, and the two arrays of
        `actuation_noise.Interval` for the sample time of each phase, (3, 2, 2). Zeros: no error.
    measured
        Whether the law knows measurements only; else it knows the state.
    position_deviation, velocity_deviation
        Standard deviations of a measurement's error along each axis (Eqs. 5.6 and 5.7).
    full_error_from, least_error_share
        Where they fall with the range, see `measurement_noise.error_share`; zero and one: nowhere.
    filtered
        Whether a Kalman filter stands between measurement and guidance.
    filter_model, filter_transitions
        What the filter takes its errors to be; each phase's prediction over its sample time,
        (3, 6, 6).
    """

    environment: Environment
    target: np.ndarray
    mass: float
    force: float
    minimum_on_time: float
    flown_from: float
    actuation: int
    error_start: np.ndarray
    error_transitions: np.ndarray
    error_factors: np.ndarray
    measured: bool
    position_deviation: float
    velocity_deviation: float
    full_error_from: float
    least_error_share: float
    filtered: bool
    filter_model: FilterModel
    filter_transitions: np.ndarray


@compiled
def copy(source, target):
    """Copy a row of numbers into another; in compiled code this is far smaller than a slice."""
    for k in range(len(source)):
        target[k] = source[k]


@compiled
def begin(motion, start):
    """Return the pair of states (2, 6) for a relative state (6,)."""
    if motion is None:
        pair = np.zeros((2, 6))
        copy(start, pair[1])
        return pair
    return pair_from_relative(motion.target, start)


@compiled
def relative(motion, pair):
    """Return the relative state (6,) of a pair of states."""
    if motion is None:
        return pair[1].copy()
    return relative_state(pair)


@compiled
def apply_transition(transition, state):
    """Multiply a state (6,) by a transition matrix (6, 6), in place."""
    before = state.copy()
    for j in range(6):
        total = 0.0
        for k in range(6):
            total += transition[j, k] * before[k]
        state[j] = total


@compiled
def coast(motion, pair, transition, time, duration, burn, on_times):
    """Move a pair of states on by a duration, s, in place.

    Parameters
    ----------
    transition
        Transition matrix of the linear equations over the duration, (6, 6), for linear motion.
    time, burn, on_times
        For nonlinear motion: s since time zero, and thrusters that burn, see `truth.advance`.
    """
    if motion is None:
        apply_transition(transition, pair[1])
    else:
        advance(pair, time, duration, burn, on_times, motion.environment)


@compiled
def push(law, motion, pair, command, error, longest, burn, on_times, applied):
    """Turn a command into an impulse on the chaser, in place, or into burns that are to come.

    Parameters
    ----------
    law
        For linear motion, its record's ``burn_time`` and ``mean_motion``.
    command
        Velocity change (3,), m/s.
    error, longest
        Amplitude error w of the thrust; the longest that a pulse may take, s.
    burn, on_times, applied
        Filled, (3,) each: acceleration while the thrusters burn, m/s^2; how long each burns from
        now, s; the velocity change that comes of it, m/s.
    """
    for k in range(3):
        on_times[k], applied[k] = 0.0, command[k]
    if motion is None:
        add_burns(law.burn_time, law.mean_motion, applied, pair[1])
    else:
        if motion.actuation != COMMANDED:
            pulse_on_times(
                command, motion.mass, motion.force, motion.minimum_on_time, motion.flown_from,
                on_times,
            )  # fmt: skip
            limited = min(max(error, ERROR_RANGE[0]), ERROR_RANGE[1])
            thrust_acceleration(command, motion.mass, (1.0 + limited) * motion.force, burn)
            for k in range(3):
                applied[k] = burn[k] * on_times[k]
        if motion.actuation == BURNS:
            for k in range(3):
                applied[k] = burn[k] * min(on_times[k], longest)
        else:
            state = relative_state(pair)
            for k in range(3):
                state[3 + k] += applied[k]
                on_times[k] = 0.0
            copy(pair_from_relative(pair[0], state)[1], pair[1])


@compiled
def add_burns(burn_time, mean_motion, change, state):
    """Add what burns of constant force that begin now come to, as if it had happened at once.

    A burn of T s that changes the velocity by u leaves the chaser behind by u T/2, and turned by
    Coriolis' acceleration meanwhile; terms of the square of mean motion and T are left out.
    """
    for k in range(3):
        lag = 0.5 * burn_time * abs(change[k]) * change[k]
        turned = 2.0 * mean_motion * lag
        state[k] -= lag
        state[3 + k] += change[k]
        if k < 2:
            sign = 1.0 - 2.0 * k
            state[3 + 1 - k] += sign * turned
            state[1 - k] -= sign * turned * burn_time * abs(change[k]) / 3.0


@compiled
def draw(numbers, drawn):
    """Return the next of some normal numbers (K,) of which so many (1,) are drawn already."""
    drawn[0] += 1
    return numbers[drawn[0] - 1]


@compiled
def first_error(motion, numbers, drawn):
    """Return the state (w, v) of the thrust's amplitude error at time zero."""
    if motion is None:
        return 0.0, 0.0
    return actuation_noise.start(motion.error_start, draw(numbers, drawn), draw(numbers, drawn))


@compiled
def next_error(motion, phase, w, v, numbers, drawn):
    """Return the state (w, v) of the thrust's amplitude error after a step of a phase."""
    if motion is None:
        return w, v
    step = Interval(motion.error_transitions[phase], motion.error_factors[phase])
    return actuation_noise.step(w, v, step, draw(numbers, drawn), draw(numbers, drawn))


@compiled
def first_estimate(motion, start, state, numbers, drawn, estimate, covariance):
    """Fill what the law knows at time zero: estimate (6,) and its covariance (6, 6).

    ``start`` is measured; ``state`` is the same but for the rounding of inertial positions.
    """
    if motion is None or not motion.measured:
        copy(state, estimate)
    else:
        copy(_measured(motion, start, numbers, drawn), estimate)
        navigation_filter.begin(motion.filter_model, covariance)


@compiled
def next_estimate(motion, phase, duration, command, state, numbers, drawn, estimate, covariance):
    """Bring estimate and covariance to the end of a step that began with a command (3,), m/s.

    ``state`` is the true relative state then, ``duration`` the step's length, s.
    """
    if motion is None or not motion.measured:
        copy(state, estimate)
    elif not motion.filtered:
        copy(_measured(motion, state, numbers, drawn), estimate)
    else:
        measured = _measured(motion, state, numbers, drawn)
        navigation_filter.predict(
            estimate, covariance, command, motion.filter_transitions[phase], duration,
            motion.filter_model,
        )  # fmt: skip
        navigation_filter.update(estimate, covariance, measured, motion.filter_model)


@compiled
def _measured(motion, state, numbers, drawn):
    """Return a relative state (6,) with independent normal errors."""
    measured = np.empty(6)
    share = error_share(state, motion.full_error_from, motion.least_error_share)
    for k in range(6):
        deviation = motion.position_deviation if k < 3 else motion.velocity_deviation
        measured[k] = state[k] + share * deviation * draw(numbers, drawn)
    return measured
