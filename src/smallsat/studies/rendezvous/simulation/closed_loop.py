"""The guidance law in closed loop with the motion that it guides.

One loop for all motions (see `smallsat.studies.rendezvous.simulation.motion`): the linear one that
the law predicts, the nonlinear one, and that with the disturbances of chapter 5, of which the law
knows a measured or filtered state only. By Algorithm 1 that estimate also decides when a phase
ends.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.lanes import LANES
from smallsat.optimal_control.riccati_interior_point import SOLVED
from smallsat.studies.rendezvous.guidance.controller import (
    control_of_lane,
    phase_ended,
    port_distance,
    solve_lanes,
    together_for,
    write_lane,
)
from smallsat.studies.rendezvous.guidance.law import DOCKING, RENDEZVOUS, Law, settings
from smallsat.studies.rendezvous.guidance.phase_programs import shape
from smallsat.studies.rendezvous.guidance.tube import hold
from smallsat.studies.rendezvous.simulation.motion import (
    NUMBERS_A_STEP,
    NonlinearMotion,
    apply_transition,
    begin,
    coast,
    copy,
    first_error,
    first_estimate,
    next_error,
    next_estimate,
    push,
    relative,
)
from smallsat.studies.rendezvous.simulation.pool import (
    BEGINS,
    DRY,
    ENDED,
    IDLE,
    pool_for,
    serve,
)

# How the velocity changes of a manoeuvre are added up, by the names of `delta_v.READINGS`: for
# `Passages`, and the field of `Manoeuvres`.
NORM, AXES, RESULTANT, PLANES = 0, 1, 2, 3
SUMS = {
    "2-norm": (NORM, "delta_v"),
    "1-norm": (AXES, "delta_v_axes"),
    "resultant": (RESULTANT, "delta_v_resultant"),
    "plane and normal": (PLANES, "delta_v_planes"),
}


class Steps(NamedTuple):
    """What happened at each step: K steps of one manoeuvre, or (M, K) before `Manoeuvres.record`.

    Attributes
    ----------
    time, phase
        At the start of the step, s; 0, 1 or 2.
    state
        True relative state before the control, (K, 6), m and m/s.
    impulse
        Commanded velocity change, (K, 3), m/s.
    status, iterations
        How the solver ended, and the steps that it took.
    softened
        Number of hard rows that gave way.
    outside
        Whether the start of the horizon violated a constraint.
    """

    time: np.ndarray
    phase: np.ndarray
    state: np.ndarray
    impulse: np.ndarray
    status: np.ndarray
    iterations: np.ndarray
    softened: np.ndarray
    outside: np.ndarray


class Passages(NamedTuple):
    """Where a manoeuvre that ends at the smallest distance and the longest limit passed others.

    The control does not depend on either, so that one manoeuvre tells the outcome for all of them.

    Attributes
    ----------
    reading
        How delta-v is added up here: the number that `SUMS` have.
    distances, limits
        Docking distances, m, (D,), and time limits, s, (L,).
    times, delta_v
        When the docking phase first came within each distance, s, and the delta-v until then, m/s;
        (M, D), not a number where it never did.
    delta_v_at_limits
        Delta-v of the steps that end by each limit, m/s, (M, L); not a number where the manoeuvre
        ended before.
    """

    reading: int
    distances: np.ndarray
    limits: np.ndarray
    times: np.ndarray
    delta_v: np.ndarray
    delta_v_at_limits: np.ndarray


class Manoeuvres(NamedTuple):
    """Summary of M manoeuvres; arrays with a last axis of 3 are by phase.

    Attributes
    ----------
    docked
        Whether the last phase asked for ended within the time limit, (M,).
    steps
        Number of steps, (M, 3).
    delta_v, delta_v_axes, delta_v_resultant, delta_v_planes
        Sums of the velocity changes, (M, 3), m/s, see `delta_v.summed`: of their 2-norms, their
        1-norms, the resultant of equal thrusters, and their 2-norm in the orbit's plane plus what
        is normal to it.
    ends
        True relative state at the end of each phase, (M, 3, 6), m and m/s.
    end_times
        When each phase ended, or the manoeuvre in it, s, (M, 3).
    softened, outside, failed
        Programs in which a hard row gave way, whose start violated a constraint, and that were not
        solved (the last plan's next control was taken instead), (M, 3).
    iterations
        Steps of the solver, (M, 3).
    closest
        Least distance from the target at the start of a step of the far range, m, (M,).
    records, passages
        What was asked for of all steps, and of other docking distances and time limits.
    """

    docked: np.ndarray
    steps: np.ndarray
    delta_v: np.ndarray
    delta_v_axes: np.ndarray
    delta_v_resultant: np.ndarray
    delta_v_planes: np.ndarray
    ends: np.ndarray
    end_times: np.ndarray
    softened: np.ndarray
    outside: np.ndarray
    failed: np.ndarray
    iterations: np.ndarray
    closest: np.ndarray
    records: Steps
    passages: Passages

    def record(self, m: int) -> Steps:
        """The steps of manoeuvre number `m`."""
        return Steps(*(array[m, : self.steps[m].sum()] for array in self.records))


def simulate(
    laws: Sequence[Law],
    starts: np.ndarray,
    phases: tuple[int, int] = (RENDEZVOUS, DOCKING),
    motion: NonlinearMotion | None = None,
    generators: Sequence[np.random.Generator] | None = None,
    with_steps: bool = False,
    distances: Sequence[float] = (),
    limits: Sequence[float] = (),
    reading: int = NORM,
) -> Manoeuvres:
    """Simulate one manoeuvre a start, each with its law (or all with the only one).

    Parameters
    ----------
    laws
        One, or as many as there are starts.
    starts
        Relative states, (M, 6), m and m/s, in the Hill frame.
    phases
        First and last phase.
    motion
        What all of them are simulated with; ``None``: linear motion.
    generators
        Random stream of each manoeuvre; nonlinear motion needs them.
    with_steps
        Whether to keep records of all steps.
    distances, limits, reading
        Docking distances, m, time limits, s, and sum of delta-v to be noted as `Passages`.

    Returns
    -------
    Manoeuvres
    """
    settings_of = settings(laws)
    starts = np.ascontiguousarray(np.atleast_2d(starts), dtype=float)
    most = int((settings_of["time_limit"] / settings_of["sample_times"].min(axis=1)).max()) + 1
    found = _nothing_yet(len(starts), most if with_steps else 0, distances, limits, reading)
    keys = [[shape(law, phase) for phase in range(3)] for law in settings_of]
    numbers = {key: k for k, key in enumerate(dict.fromkeys(key for row in keys for key in row))}
    shapes = np.array([[numbers[key] for key in row] for row in keys])
    stages = int(settings_of["horizons"].max())
    together = together_for(stages)
    pool = pool_for(len(starts), len(numbers), stages, motion is not None)
    begun = serve(pool, 0, len(starts), len(laws), generators)
    while (pool.waits != IDLE).any():
        _fly(settings_of, shapes, starts, phases, motion, together, pool, found)
        begun = serve(pool, begun, len(starts), len(laws), generators)
    return found


def _nothing_yet(
    count: int, steps: int, distances: Sequence[float], limits: Sequence[float], reading: int
) -> Manoeuvres:
    """The result for so many manoeuvres, with room for that many steps of each, to be filled."""

    def number(*shape: int) -> np.ndarray:
        return np.zeros((count, *shape), np.int64)

    def value(*shape: int) -> np.ndarray:
        return np.zeros((count, *shape))

    def unknown(*shape: int) -> np.ndarray:
        return np.full((count, *shape), np.nan)

    return Manoeuvres(
        docked=np.zeros(count, bool),
        steps=number(3),
        delta_v=value(3),
        delta_v_axes=value(3),
        delta_v_resultant=value(3),
        delta_v_planes=value(3),
        ends=unknown(3, 6),
        end_times=value(3),
        softened=number(3),
        outside=number(3),
        failed=number(3),
        iterations=number(3),
        closest=np.full(count, np.inf),
        records=Steps(
            time=value(steps),
            phase=number(steps),
            state=value(steps, 6),
            impulse=value(steps, 3),
            status=number(steps),
            iterations=number(steps),
            softened=number(steps),
            outside=np.zeros((count, steps), bool),
        ),
        passages=Passages(
            reading,
            np.array(distances, dtype=float),
            np.array(limits, dtype=float),
            unknown(len(distances)),
            unknown(len(distances)),
            unknown(len(limits)),
        ),
    )


@compiled
def _fly(laws, shapes, starts, phases, motion, together, pool, found):
    """Fly the manoeuvres of a pool until one ends or its numbers do; fill their rows of `found`.

    Parameters
    ----------
    laws, shapes
        `SETTINGS` records, and the number of each law's shape of program in each phase.
    together
        Memory for the programs that are solved together.
    """
    for slot in range(len(pool.waits)):
        if pool.waits[slot] == BEGINS:
            _begin(laws[pool.law[slot]], starts, phases, motion, pool, slot)
        if pool.waits[slot] == BEGINS or pool.waits[slot] == DRY:
            _go_on(laws, shapes, motion, pool, slot, found)
    queue, command, kinds = np.empty(LANES, np.int64), np.zeros(3), shapes.max() + 1
    while not _wants(pool):
        length = _next_queue(pool, kinds, queue)
        if length == 0:
            return
        for k in range(length):
            _look_ahead(laws[pool.law[queue[k]]], pool, queue[k])
        rows = _solve(laws, together, pool, queue[:length])
        for k in range(length):
            slot = queue[k]
            law, phase = laws[pool.law[slot]], pool.phase[slot]
            control = control_of_lane(
                law, phase, together, k, rows, pool.outside[slot], pool.plans[slot],
                pool.remaining[slot], command,
            )  # fmt: skip
            _step(law, motion, control, command, pool, slot, found)
            if pool.phase[slot] > phases[1]:
                found.docked[pool.manoeuvre[slot]] = True
                pool.waits[slot] = ENDED
            else:
                _go_on(laws, shapes, motion, pool, slot, found)


@compiled
def _wants(pool):
    """Whether a slot waits for what `serve` gives."""
    for slot in range(len(pool.waits)):
        if pool.waits[slot] == ENDED or pool.waits[slot] == DRY:
            return True
    return False


@compiled
def _next_queue(pool, shapes, queue):
    """Fill in slots that wait for programs of the shape that most wait for; return how many."""
    slots = len(pool.waits)
    waiting = np.zeros(shapes, np.int64)
    for slot in range(slots):
        if pool.waits[slot] >= 0:
            waiting[pool.waits[slot]] += 1
    most, length, turn = np.argmax(waiting), 0, pool.turn[0]
    for k in range(slots):
        slot = (turn + k) % slots
        if pool.waits[slot] == most and length < len(queue):
            queue[length] = slot
            length += 1
            pool.turn[0] = slot + 1
    return length


@compiled
def _begin(law, starts, phases, motion, pool, slot):
    """Put a manoeuvre into a slot."""
    start = starts[pool.manoeuvre[slot]]
    numbers, drawn = pool.numbers[slot], pool.drawn[slot]
    pool.errors[slot, 0], pool.errors[slot, 1] = first_error(motion, numbers, drawn)
    pair = begin(motion, start)
    for k in range(2):
        copy(pair[k], pool.pairs[slot, k])
    first_estimate(
        motion, start, relative(motion, pair), numbers, drawn, pool.estimates[slot],
        pool.covariances[slot],
    )  # fmt: skip
    pool.time[slot], pool.step[slot], pool.spent[slot] = 0.0, 0, 0.0
    _enter(pool, slot, phases[0])


@compiled
def _enter(pool, slot, phase):
    """Begin a phase: without a plan, outside any tube."""
    pool.phase[slot], pool.remaining[slot, 0], pool.within[slot] = phase, 0, False


@compiled
def _go_on(laws, shapes, motion, pool, slot, found):
    """Let a slot wait for its next program, if there is time and it has numbers left."""
    law, phase = laws[pool.law[slot]], pool.phase[slot]
    if motion is not None and pool.drawn[slot, 0] + NUMBERS_A_STEP > pool.numbers.shape[1]:
        pool.waits[slot] = DRY
        return
    end = pool.time[slot] + law.sample_times[phase]
    _pass_limits(found.passages, pool.manoeuvre[slot], end, pool.spent[slot])
    pool.waits[slot] = ENDED if end > law.time_limit else shapes[pool.law[slot], phase]


@compiled
def _look_ahead(law, pool, slot):
    """Fill in the state that a slot's program is to be solved for."""
    expected = pool.expected[slot]
    copy(pool.estimates[slot], expected)
    apply_transition(law.predictions_before[pool.phase[slot]], expected)
    if not pool.within[slot]:
        copy(expected, pool.nominals[slot])


@compiled
def _solve(laws, together, pool, queue):
    """Solve the programs of slots, of one shape, in lanes; return the number of rows on states."""
    for lane in range(LANES):
        # lanes that are left over solve the last program once more
        slot = queue[min(lane, len(queue) - 1)]
        law, phase, state = laws[pool.law[slot]], pool.phase[slot], pool.nominals[slot]
        pool.outside[slot] = write_lane(law, phase, state, pool.time[slot], together, lane)
    # The last of them, whose shape all have.
    return solve_lanes(law, phase, together)


@compiled
def _step(law, motion, control, command, pool, slot, found):
    """Fly a step with a control and its velocity change (3,), m/s.

    With nonlinear motion each step draws eight normal numbers whatever is disturbed, so that
    variants have them in common.
    """
    m, phase, time = pool.manoeuvre[slot], pool.phase[slot], pool.time[slot]
    pair, estimate = pool.pairs[slot], pool.estimates[slot]
    numbers, drawn = pool.numbers[slot], pool.drawn[slot]
    applied = np.zeros(3)
    burn, on_times, idle = np.zeros(3), np.zeros(3), np.zeros(3)
    duration, delay = law.sample_times[phase], law.delays[phase]
    state = relative(motion, pair)
    if law.has_tube and phase == DOCKING:
        hold(law, pool.expected[slot], pool.nominals[slot], command)
        pool.within[slot] = True
    if phase == RENDEZVOUS:
        found.closest[m] = min(found.closest[m], np.linalg.norm(state[:3]))
    if found.records.time.shape[1] > 0:
        _record(found.records, m, pool.step[slot], time, phase, state, command, control)
    w, v = pool.errors[slot, 0], pool.errors[slot, 1]
    coast(motion, pair, law.drifts_before[phase], time, delay, burn, idle)
    push(law, motion, pair, command, w, duration - delay, burn, on_times, applied)
    coast(motion, pair, law.drifts_after[phase], time + delay, duration - delay, burn, on_times)
    time += duration
    pool.time[slot] = time
    pool.step[slot] += 1
    pool.errors[slot, 0], pool.errors[slot, 1] = next_error(motion, phase, w, v, numbers, drawn)
    state = relative(motion, pair)
    next_estimate(
        motion, phase, duration, command, state, numbers, drawn, estimate, pool.covariances[slot]
    )
    _add_up(found, m, phase, applied, control)
    pool.spent[slot] = _spent(found, m)
    found.end_times[m, phase] = time
    copy(state, found.ends[m, phase])
    if phase == DOCKING:
        distance = port_distance(law, estimate, time)
        _pass_distances(found.passages, m, distance, time, pool.spent[slot])
    if phase_ended(law, phase, estimate, time):
        _enter(pool, slot, phase + 1)


@compiled
def _record(records, m, step, time, phase, state, command, control):
    """Fill the entries of one step in `Steps`."""
    records.time[m, step] = time
    records.phase[m, step] = phase
    copy(state, records.state[m, step])
    copy(command, records.impulse[m, step])
    records.status[m, step] = control.status
    records.iterations[m, step] = control.iterations
    records.softened[m, step] = control.softened
    records.outside[m, step] = control.outside


@compiled
def _add_up(found, m, phase, impulse, control):
    """Count one step and add its velocity change (3,), m/s."""
    found.steps[m, phase] += 1
    found.softened[m, phase] += 1 if control.softened > 0 else 0
    found.outside[m, phase] += 1 if control.outside else 0
    found.failed[m, phase] += 1 if control.status != SOLVED else 0
    found.iterations[m, phase] += control.iterations
    level = np.sqrt(impulse[0] ** 2 + impulse[1] ** 2)
    found.delta_v[m, phase] += np.sqrt(level**2 + impulse[2] ** 2)
    total = abs(impulse[0]) + abs(impulse[1]) + abs(impulse[2])
    most = max(abs(impulse[0]), abs(impulse[1]), abs(impulse[2]))
    least = min(abs(impulse[0]), abs(impulse[1]), abs(impulse[2]))
    middle = total - most - least
    found.delta_v_axes[m, phase] += total
    found.delta_v_resultant[m, phase] += (
        np.sqrt(3.0) * least + np.sqrt(2.0) * (middle - least) + most - middle
    )
    found.delta_v_planes[m, phase] += level + abs(impulse[2])


@compiled
def _spent(found, m):
    """Return the delta-v so far, m/s, as `Passages` have it."""
    if found.passages.reading == NORM:
        return found.delta_v[m].sum()
    if found.passages.reading == AXES:
        return found.delta_v_axes[m].sum()
    if found.passages.reading == RESULTANT:
        return found.delta_v_resultant[m].sum()
    return found.delta_v_planes[m].sum()


@compiled
def _pass_limits(passages, m, end, spent):
    """Note the delta-v at each time limit, s, that the step to come would end after."""
    for i in range(len(passages.limits)):
        if np.isnan(passages.delta_v_at_limits[m, i]) and end > passages.limits[i]:
            passages.delta_v_at_limits[m, i] = spent


@compiled
def _pass_distances(passages, m, distance, time, spent):
    """Note time and delta-v at each docking distance, m, not less than that from the port."""
    for i in range(len(passages.distances)):
        if np.isnan(passages.times[m, i]) and distance <= passages.distances[i]:
            passages.times[m, i], passages.delta_v[m, i] = time, spent
