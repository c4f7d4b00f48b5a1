"""The guidance law and its closed loop once more, in plain NumPy, for tests of the compiled loop.

Nothing is shared with the compiled loop but the description of the law. Every program is written
down in metres and metres per second as the document prints it, with its constraints as penalties
of the same weight, and handed to a library; one manoeuvre at a time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sparse

from smallsat.studies.rendezvous.guidance.law import (
    ALONG_AXIS,
    AT_HORIZON,
    AT_STAGE,
    Law,
    settings,
)
from smallsat.studies.rendezvous.methods.qp_solvers import Answer, SparseProgram
from smallsat.studies.rendezvous.model.geometry import UPRIGHT

Array = np.ndarray


@dataclass(frozen=True)
class Row:
    """A penalty w (g'x - b)+ on the state of a stage; metres, m/s."""

    stage: int
    normal: Array
    limit: float
    weight: float


def cost_to_go(law: Law, phase: int) -> tuple[Array, Array]:
    """Transition A over a sample time and terminal weight Qf."""
    n = law.mean_motion
    matrix = np.array(
        [
            [0, 0, 0, 1, 0, 0],
            [0, 0, 0, 0, 1, 0],
            [0, 0, 0, 0, 0, 1],
            [3 * n * n, 0, 0, 0, 2 * n, 0],
            [0, 0, 0, -2 * n, 0, 0],
            [0, 0, -n * n, 0, 0, 0],
        ]
    )
    a = scipy.linalg.expm(matrix * law.sample_times[phase])
    q, r = np.diag(law.state_weights[phase]), np.diag(law.control_weights[phase])
    if law.terminal_weights[phase] > 0:
        return a, law.terminal_weights[phase] * q
    return a, scipy.linalg.solve_discrete_are(a, a[:, 3:], q, r)


def axis_at(law: Law, time: float) -> Array:
    """The approach axis at a time."""
    angle = law.rotation_rate * time
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    return turn @ np.array(law.axis)


def cone(axis: Array, half_angle: float) -> Array:
    """H of the cone, four unit rows (3.3)."""
    normal = np.array([0.0, 0.0, 1.0])
    side = np.cross(normal, axis)
    sides = np.array([side, -side, normal, -normal])
    return np.cos(half_angle) * sides - np.sin(half_angle) * axis


def keep_out_planes(law: Law, state: Array, end: Array) -> Array:
    """Normals of the rotating plane, (N + 1, 3) (3.5, 3.6)."""
    steps = law.horizons[0]
    upright = np.array([1.0, 1.0, 0.0 if law.plane_turn == UPRIGHT else 1.0])
    first = upright * state[:3] / np.linalg.norm(upright * state[:3])
    about = np.cross(first, end)
    angle = np.arctan2(np.linalg.norm(about), first @ end)
    about = about / np.linalg.norm(about)
    turn = angle / steps
    largest = law.plane_rate * law.mean_motion * law.sample_times[0]
    if turn > largest:
        turn = largest
        towards = np.cross(about, first)
        if towards @ np.array([first[1], -first[0], 0.0]) < 0:
            turn = -turn
    rotations = [scipy.linalg.expm(i * turn * _cross(about)) for i in range(steps + 1)]
    return np.array([rotation @ first for rotation in rotations])


def _cross(v: Array) -> Array:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def references(law: Law, phase: int, time: float) -> Array:
    """States that the cost pulls to, (N + 1, 6): set point or docking port."""
    steps, ts = law.horizons[phase], law.sample_times[phase]
    distance = law.port if phase == 2 else law.set_points[phase]
    rule = AT_STAGE if phase == 2 else law.set_point_time
    found = []
    for i in range(steps + 1):
        ahead = {AT_STAGE: i * ts, AT_HORIZON: steps * ts}.get(rule, 0.0)
        point = distance * axis_at(law, time + ahead)
        moving = law.rotation_rate * law.reference_moves
        found.append(np.concatenate([point, np.cross([0, 0, moving], point)]))
    return np.array(found)


def rows(law: Law, phase: int, state: Array, time: float, hard: tuple[float, float]) -> list[Row]:
    """All penalties of a program; weights of constraints per metre and per m/s."""
    steps, ts = law.horizons[phase], law.sample_times[phase]
    found = []
    if phase == 0:
        at = time + (steps * ts if law.terminal_cone_time == AT_HORIZON else 0.0)
        for i, normal in enumerate(keep_out_planes(law, state, axis_at(law, at))):
            found.append(Row(i, _position(-normal), -law.keep_out, hard[0]))
        for face in cone(axis_at(law, at), law.cone_angles[0]):
            found.append(Row(steps, _position(face), 0.0, law.penalties[0]))
    for i in range(steps + 1):
        axis = axis_at(law, time + i * ts)
        if phase == 1:
            found.append(Row(i, _position(-axis), -law.overshoot, hard[0]))
        if phase > 0:
            tip = law.port * axis if phase == 2 else np.zeros(3)
            weight = hard[0] if phase == 2 else law.penalties[1]
            for face in cone(axis, law.cone_angles[phase]):
                found.append(Row(i, _position(face), face @ tip, weight))
        if phase == 2:
            for k in range(3, 6):
                for sign in (1.0, -1.0):
                    found.append(Row(i, sign * np.eye(6)[k], law.speed_bound, hard[1]))
    return [row for row in found if row.stage > 0]


def _position(normal: Array) -> Array:
    return np.concatenate([normal, np.zeros(3)])


def quadratic_program(law: Law, phase: int, state: Array, time: float) -> SparseProgram:
    """The program of a phase; unknowns in units of the control's bound and the law's scales."""
    steps, bound = law.horizons[phase], law.control_bounds[phase]
    record = settings([law])[0]
    scale = record["scales"][phase]
    a, terminal = cost_to_go(law, phase)
    unit = 1.0 / (2.0 * np.abs(terminal * np.outer(scale, scale)).max())
    hard = tuple(record["hard_weights"][phase] / (unit * s) for s in (scale[0], scale[3]))
    penalties = rows(law, phase, state, time, (hard[0], hard[1]))
    towards = references(law, phase, time)
    stage_weights = [np.diag(law.state_weights[phase])] * (steps - 1) + [terminal]
    quadratic = [2 * unit * np.diag(law.control_weights[phase]) * bound**2] * steps
    quadratic += [2 * unit * w * np.outer(scale, scale) for w in stage_weights]
    linear = [-2 * unit * scale * (w @ x) for w, x in zip(stage_weights, towards[1:], strict=True)]
    count = len(penalties)
    below = sparse.kron(sparse.eye(steps, k=-1), a * scale / scale[:, None])
    control = a[:, 3:] * bound / scale[:, None]
    equal_to = np.zeros(6 * steps)
    equal_to[:6] = a @ state / scale
    inequalities = sparse.lil_matrix((count, 9 * steps))
    for r, row in enumerate(penalties):
        at = 3 * steps + 6 * (row.stage - 1)
        inequalities[r, at : at + 6] = row.normal * scale / _unit(row, scale)
    free = np.full(6 * steps, np.inf)
    return SparseProgram(
        sparse.csc_matrix(sparse.block_diag([*quadratic, sparse.csc_matrix((count, count))])),
        np.concatenate(
            [np.zeros(3 * steps), *linear, [unit * p.weight * _unit(p, scale) for p in penalties]]
        ),
        sparse.hstack(
            [
                -sparse.kron(sparse.eye(steps), control),
                sparse.eye(6 * steps) - below,
                sparse.csc_matrix((6 * steps, count)),
            ],
            "csc",
        ),
        equal_to,
        sparse.hstack([inequalities, -sparse.eye(count)], "csc"),
        np.array([p.limit / _unit(p, scale) for p in penalties]),
        np.concatenate([-np.ones(3 * steps), -free, np.zeros(count)]),
        np.concatenate([np.ones(3 * steps), free, np.full(count, np.inf)]),
        steps,
    )


def _unit(row: Row, scale: Array) -> float:
    """Unit of a row's excess: that of length, or that of velocity."""
    return float(scale[0] if np.any(row.normal[:3]) else scale[3])


def phase_ended(law: Law, phase: int, state: Array, time: float) -> bool:
    """End condition of a phase."""
    axis = axis_at(law, time)
    offset = state[:3] - (law.port * axis if phase == 2 else 0.0)
    if phase == 0 and np.any(cone(axis, law.cone_angles[0]) @ offset > 0):
        return False
    kind, distance = law.switches[phase], law.switch_distances[phase]
    return bool((offset @ axis if kind == ALONG_AXIS else np.linalg.norm(offset)) <= distance)


@dataclass(frozen=True)
class Flight:
    """One manoeuvre, K steps.

    Attributes
    ----------
    steps
        Number of steps of each phase that was begun.
    states
        Before each step and at the end, (K + 1, 6), m and m/s.
    impulses
        Velocity changes, (K, 3), m/s.
    unsolved
        Programs that the library did not solve; the last plan's next control was taken.
    """

    steps: list[int]
    states: Array
    impulses: Array
    unsolved: int


def simulate(law: Law, start: Array, solve: Callable[[SparseProgram], Answer]) -> Flight:
    """One manoeuvre with a quadratic cost and Clohessy-Wiltshire truth."""
    if law.norm_weights is not None or law.prediction is not None or law.delay > 0.0:
        raise ValueError("the reference loop knows the document's own quadratic programs only")
    state, time, unsolved = np.array(start, dtype=float), 0.0, 0
    states, counts = [state], list[int]()
    impulses: list[Array] = []
    for phase in range(3):
        a, _ = cost_to_go(law, phase)
        plan: list[Array] = []
        counts.append(0)
        while True:
            if time + law.sample_times[phase] > law.time_limit:
                return Flight(counts, np.array(states), np.array(impulses), unsolved)
            answer = solve(quadratic_program(law, phase, state, time))
            if answer.solved:
                plan = list(law.control_bounds[phase] * np.clip(answer.controls, -1.0, 1.0))
            else:
                unsolved += 1
            impulse = plan.pop(0) if plan else np.zeros(3)
            state = a @ (state + np.concatenate([np.zeros(3), impulse]))
            time += law.sample_times[phase]
            counts[-1] += 1
            states.append(state)
            impulses.append(impulse)
            if phase_ended(law, phase, state, time):
                break
    return Flight(counts, np.array(states), np.array(impulses), unsolved)
