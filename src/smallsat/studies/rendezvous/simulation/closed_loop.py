"""The three-phase guidance law (Algorithm 1) in closed loop with the motion that it guides.

Errata of Algorithm 1: the far range ends where Hx <= 0 (not x <= Hx) and, since the keep-out
forbids |x| <= r1, within a margin of r1; the other phases end by a distance, not by x <= r.
"""

from dataclasses import dataclass

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.optimal_control.riccati_interior_point import SOLVED, solve, workspace
from smallsat.studies.rendezvous.guidance.law import Law, settings
from smallsat.studies.rendezvous.guidance.phase_programs import (
    BOUNDS,
    PLANES,
    program_room,
    write_program,
)
from smallsat.studies.rendezvous.model.geometry import in_cone, rotated

TOLERANCE = 1e-10  # of the solver, relative
ITERATION_LIMIT = 100
SOFTENED = 1e-5  # scaled excess of a hard row that counts as having given way


@dataclass(frozen=True)
class Steps:
    """What happened at each step of one manoeuvre, K steps.

    Attributes
    ----------
    time, phase
        At the start of the step, s; 0, 1 or 2.
    state
        Relative state before the control, (K, 6), m and m/s.
    impulse
        Velocity change, (K, 3), m/s.
    status, iterations
        Of the program.
    softened
        Hard rows that gave way.
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


@dataclass(frozen=True)
class Manoeuvres:
    """Summary of M manoeuvres; arrays with a last axis of 3 are by phase.

    Attributes
    ----------
    docked
        Whether the last phase asked for ended within the time limit, (M,).
    steps
        (M, 3).
    delta_v, delta_v_axes, delta_v_planes
        Sums of the velocity changes' 2-norms, of their 1-norms, and of their 2-norm in the orbit's
        plane plus what is normal to it, (M, 3), m/s.
    ends
        State at the end of each phase, (M, 3, 6).
    end_times
        s, (M, 3).
    softened, outside, failed
        Programs in which a hard row gave way, whose start violated a constraint, and that were not
        solved (the last plan's next control was taken instead), (M, 3).
    iterations
        Of the solver, (M, 3).
    records
        One `Steps` a manoeuvre, if asked for.
    """

    docked: np.ndarray
    steps: np.ndarray
    delta_v: np.ndarray
    delta_v_axes: np.ndarray
    delta_v_planes: np.ndarray
    ends: np.ndarray
    end_times: np.ndarray
    softened: np.ndarray
    outside: np.ndarray
    failed: np.ndarray
    iterations: np.ndarray
    records: list[Steps]


@compiled
def phase_ended(law, phase, state, time, axis, faces):
    """Whether a phase's end condition holds."""
    rotated(law.axis, law.rotation_rate * time, axis)
    tip = law.port if phase == 2 else 0.0
    kind = law.switch_kinds[phase]
    along, square = 0.0, 0.0
    for k in range(3):
        offset = state[k] - tip * axis[k]
        along += offset * axis[k]
        square += offset * offset
    if phase == 0 and not in_cone(state, axis, law.tangents[0], faces):
        return False
    if kind == 0:
        return True
    if kind == 1:
        return np.sqrt(square) <= law.switch_distances[phase]
    return along <= law.switch_distances[phase]


@compiled
def next_control(law, phase, state, time, room, work, plan, place, command):
    """The guidance law's control for a state.

    Where the program is not solved, the control that the last solved plan of the phase has for now
    is taken; where that plan is used up, none.

    Parameters
    ----------
    law, phase, state, time
        `SETTINGS` record; 0, 1 or 2; relative state, m and m/s; s.
    room, work
        Of `program_room` and `workspace`.
    plan, place
        Controls of the last solved plan, (N, 3), m/s, and its next one and their number, (2,); both
        kept here from call to call. A phase begins with ``place[:] = 0``.
    command
        Receives the velocity change, (3,), m/s.

    Returns
    -------
    int, int, int, bool
        Status and iterations of the solver, hard rows that gave way, whether the start violated a
        constraint.
    """
    stages = law.horizons[phase]
    bound = law.control_bounds[phase]
    program, outside = write_program(law, phase, state, time, room)
    scaled = np.empty(6)
    for k in range(6):
        scaled[k] = state[k] / law.scales[phase, k]
    status, iterations = solve(program, stages, scaled, work, TOLERANCE, ITERATION_LIMIT)
    softened = 0
    if status == SOLVED:
        rows = stages * len(program.components)
        for i in range(1, stages + 1):
            rows += program.plane_count[i]
        for r in range(rows):
            if work.rows[1, r] == law.hard_weights[phase] and work.rows[4, r] > SOFTENED:
                softened += 1
        for i in range(stages):
            for k in range(3):
                plan[i, k] = bound * work.controls[i, k]
        place[0], place[1] = 0, stages
    command[:] = 0.0
    if place[0] < place[1]:
        command[:] = plan[place[0]]
        place[0] += 1
    return status, iterations, softened, outside


@compiled
def advance(matrix, state, out):
    """State after a transition, into `out`."""
    for j in range(6):
        total = 0.0
        for k in range(6):
            total += matrix[j, k] * state[k]
        out[j] = total


@compiled
def fly(law, start, first_phase, last_phase, room, work, counts, sums, ends, records):
    """One manoeuvre with Clohessy-Wiltshire truth; fills `counts`, `sums`, `ends`, `records`.

    Returns whether the last phase ended in time, and the number of steps.
    """
    state, moved = start.copy(), np.empty(6)
    axis, faces = np.empty(3), np.empty((4, 3))
    plan, place = np.empty(work.controls.shape), np.zeros(2, np.int64)
    command = np.zeros(3)
    time, step = 0.0, 0
    for phase in range(first_phase, last_phase + 1):
        place[:] = 0
        while True:
            if time + law.sample_times[phase] > law.time_limit:
                return False, step
            advance(law.predictions_before[phase], state, moved)
            status, iterations, softened, outside = next_control(
                law, phase, moved, time, room, work, plan, place, command
            )
            if len(records) > 0:
                records[step, 0] = time
                records[step, 1] = phase
                records[step, 2:8] = state
                records[step, 8:11] = command
                records[step, 11] = status
                records[step, 12] = iterations
                records[step, 13] = softened
                records[step, 14] = 1.0 if outside else 0.0
            advance(law.drifts_before[phase], state, moved)
            for k in range(3):
                moved[3 + k] += command[k]
            advance(law.drifts_after[phase], moved, state)
            time += law.sample_times[phase]
            step += 1
            add_step(phase, command, status, iterations, softened, outside, counts, sums)
            sums[3, phase] = time
            ends[phase] = state
            if phase_ended(law, phase, state, time, axis, faces):
                break
    return True, step


@compiled
def add_step(phase, impulse, status, iterations, softened, outside, counts, sums):
    """Count one step in `counts` (5, 3) and add its velocity change, m/s, to `sums` (4, 3)."""
    counts[0, phase] += 1
    counts[1, phase] += 1 if softened > 0 else 0
    counts[2, phase] += 1 if outside else 0
    counts[3, phase] += 1 if status != SOLVED else 0
    counts[4, phase] += iterations
    level = np.sqrt(impulse[0] ** 2 + impulse[1] ** 2)
    sums[0, phase] += np.sqrt(level**2 + impulse[2] ** 2)
    sums[1, phase] += abs(impulse[0]) + abs(impulse[1]) + abs(impulse[2])
    sums[2, phase] += level + abs(impulse[2])


def manoeuvres(
    laws: list[Law],
    starts: np.ndarray,
    phases: tuple[int, int] = (0, 2),
    with_steps: bool = False,
) -> Manoeuvres:
    """Fly one manoeuvre a start, each with its law (or all with the only one).

    Parameters
    ----------
    laws
        One, or as many as there are starts.
    starts
        Relative states, (M, 6), m and m/s.
    phases
        First and last phase.
    with_steps
        Whether to keep records of all steps.
    """
    records = settings(laws)
    starts = np.ascontiguousarray(np.atleast_2d(starts), dtype=float)
    number = len(starts)
    longest = int(records["horizons"].max())
    room, work = program_room(longest), workspace(longest, PLANES, BOUNDS)
    counts = np.zeros((number, 5, 3), np.int64)
    sums, ends = np.zeros((number, 4, 3)), np.full((number, 3, 6), np.nan)
    docked = np.zeros(number, bool)
    kept = []
    for m in range(number):
        law = records[m % len(records)]
        most = int(law["time_limit"] / law["sample_times"].min()) + 1 if with_steps else 0
        steps = np.zeros((most, 15))
        docked[m], used = fly(
            law, starts[m], phases[0], phases[1], room, work, counts[m], sums[m], ends[m], steps
        )
        if with_steps:
            kept.append(_steps(steps[:used]))
    return Manoeuvres(
        docked, counts[:, 0], sums[:, 0], sums[:, 1], sums[:, 2], ends, sums[:, 3],
        counts[:, 1], counts[:, 2], counts[:, 3], counts[:, 4], kept,
    )  # fmt: skip


def _steps(table: np.ndarray) -> Steps:
    whole = table[:, [1, 11, 12, 13]].astype(int)
    return Steps(
        table[:, 0], whole[:, 0], table[:, 2:8], table[:, 8:11],
        whole[:, 1], whole[:, 2], whole[:, 3], table[:, 14] > 0,
    )  # fmt: skip
