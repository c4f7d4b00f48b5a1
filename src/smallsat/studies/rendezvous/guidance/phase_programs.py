"""The three phases' quadratic programs (3.7), (3.10) and (3.14), written into one problem form.

Where the document's formulas disagree with each other or with its text, the text is followed:

- (3.8), (3.10): the penalty is on the positive part of Hx, as in (3.3).
- (3.12), (3.14): the docking cone has its tip at the docking port of each stage, as the reference
  in (3.11) has, rather than at that of the last stage; both are one for a target at rest.
- (3.15): the cone rotates about z with the target, as section 3.6 says, not about x.
- Constraints at i = 0 bind nothing that can still be chosen. They are left out of the program, and
  a start that violates them is counted.
"""

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.optimal_control.riccati_interior_point import Program
from smallsat.studies.rendezvous.model.geometry import cone_faces, keep_out_normals, rotated

PLANES = 5  # rows on the position at a stage, at most
BOUNDS = 6  # rows on single components of the state, at most
START_TOLERANCE = 1e-6  # scaled


@compiled
def program_room(stages):
    """Arrays for any program of up to that many stages."""
    return Program(
        np.zeros((6, 6)),
        np.zeros(6),
        np.zeros((6, 6)),
        np.zeros((stages + 1, 6)),
        np.zeros(3),
        np.zeros(3),
        np.zeros(stages + 1, np.int64),
        np.zeros((stages + 1, PLANES, 3)),
        np.zeros((stages + 1, PLANES)),
        np.zeros((stages + 1, PLANES)),
        np.zeros(BOUNDS, np.int64),
        np.zeros(BOUNDS),
        np.zeros((stages + 1, BOUNDS)),
        np.zeros((stages + 1, BOUNDS)),
    )


@compiled
def with_bounds(room, count):
    """The program with only its first rows on components."""
    return Program(
        room.transition,
        room.state_hessian,
        room.terminal_hessian,
        room.state_gradient,
        room.control_hessian,
        room.control_norm,
        room.plane_count,
        room.normals,
        room.offsets,
        room.plane_weights,
        room.components[:count],
        room.signs[:count],
        room.bounds,
        room.bound_weights,
    )


@compiled
def reference(law, distance, angle, out):
    """Fill a point on the rotated axis, m, and, if asked for, the velocity of its turning, m/s."""
    axis = np.empty(3)
    rotated(law.axis, angle, axis)
    for k in range(3):
        out[k] = distance * axis[k]
        out[3 + k] = 0.0
    if law.reference_moves != 0:
        out[3] = -law.rotation_rate * out[1]
        out[4] = law.rotation_rate * out[0]


@compiled
def _time_of(rule, time, stage, stages, sample_time):
    """Time at which something that rotates is taken: now, at the horizon's end, at each stage."""
    if rule == 0:
        return time
    if rule == 1:
        return time + stages * sample_time
    return time + stage * sample_time


@compiled
def write_program(law, phase, state, time, room):
    """Write the program of a phase.

    Parameters
    ----------
    law
        A `SETTINGS` record.
    phase
        0, 1 or 2.
    state, time
        Relative state, m and m/s, and time, s, at the start of the horizon.
    room
        Arrays of `program_room`, written.

    Returns
    -------
    Program, bool
        The program, and whether a constraint is violated at the start already.
    """
    stages = law.horizons[phase]
    ts = law.sample_times[phase]
    scale = law.scales[phase]
    length, speed = scale[0], scale[3]
    hard = law.hard_weights[phase]
    penalty = law.penalties[phase]
    rate = law.rotation_rate
    one_norm = phase == 0 and law.norm_control_weights[0] > 0.0
    for j in range(6):
        for k in range(6):
            room.transition[j, k] = law.transitions[phase, j, k]
            room.terminal_hessian[j, k] = 0.0 if one_norm else law.terminal_hessians[phase, j, k]
        room.state_hessian[j] = 0.0 if one_norm else law.state_hessians[phase, j]
    for k in range(3):
        room.control_hessian[k] = 0.0 if one_norm else law.control_hessians[phase, k]
        room.control_norm[k] = law.norm_control_weights[k] if one_norm else 0.0

    # cost
    point = np.empty(6)
    distance = law.port if phase == 2 else law.set_points[phase]
    rule = 2 if phase == 2 else law.set_point_time
    for i in range(1, stages + 1):
        if i == 1 or (rule == 2 and rate != 0.0):
            reference(law, distance, rate * _time_of(rule, time, i, stages, ts), point)
            for k in range(6):
                point[k] /= scale[k]
        if one_norm:
            for k in range(6):
                weight = law.norm_weights[k] if i < stages else law.norm_terminal_weights[k]
                room.components[k] = k
                room.signs[k] = 1.0
                room.bounds[i, k] = point[k]
                room.bound_weights[i, k] = 2.0 * weight
                room.state_gradient[i, k] = -weight
        elif i < stages:
            for k in range(6):
                room.state_gradient[i, k] = -law.state_hessians[phase, k] * point[k]
        else:
            for j in range(6):
                total = 0.0
                for k in range(6):
                    total -= law.terminal_hessians[phase, j, k] * point[k]
                room.state_gradient[i, j] = total

    # constraints
    axis = np.empty(3)
    faces = np.empty((4, 3))
    outside = False
    if phase == 0:
        angle = rate * _time_of(law.terminal_cone_time, time, stages, stages, ts)
        rotated(law.axis, angle, axis)
        normals = np.empty((stages + 1, 3))
        keep_out_normals(
            state[:3], state[3:], axis, stages, law.plane_rate * ts, law.plane_rule, normals
        )
        for i in range(1, stages + 1):
            room.plane_count[i] = 1
            for k in range(3):
                room.normals[i, 0, k] = -normals[i, k]
            room.offsets[i, 0] = -law.keep_out / length
            room.plane_weights[i, 0] = hard
        if penalty > 0.0:
            cone_faces(axis, law.tangents[0], faces)
            room.plane_count[stages] = 5
            for face in range(4):
                for k in range(3):
                    room.normals[stages, 1 + face, k] = faces[face, k]
                room.offsets[stages, 1 + face] = 0.0
                room.plane_weights[stages, 1 + face] = penalty
        gap = np.sqrt(state[0] ** 2 + state[1] ** 2 + state[2] ** 2) - law.keep_out
        outside = gap < -START_TOLERANCE * length
        return with_bounds(room, 6 if one_norm else 0), outside
    for i in range(stages + 1):
        if i == 0 or rate != 0.0:
            rotated(law.axis, rate * (time + i * ts), axis)
            cone_faces(axis, law.tangents[phase], faces)
        tip = law.port if phase == 2 else 0.0
        weight = hard if phase == 2 else penalty
        for face in range(4):
            offset = 0.0
            for k in range(3):
                room.normals[i, face, k] = faces[face, k]
                offset += faces[face, k] * axis[k]
            room.offsets[i, face] = tip * offset / length
            room.plane_weights[i, face] = weight
        room.plane_count[i] = 4
        if phase == 1:
            room.plane_count[i] = 5
            for k in range(3):
                room.normals[i, 4, k] = -axis[k]
            room.offsets[i, 4] = -law.overshoot / length
            room.plane_weights[i, 4] = hard
        if i == 0:
            for p in range(room.plane_count[0]):
                if room.plane_weights[0, p] == hard:
                    excess = -room.offsets[0, p]
                    for k in range(3):
                        excess += room.normals[0, p, k] * state[k] / length
                    outside = outside or excess > START_TOLERANCE
    if phase == 1:
        return with_bounds(room, 0), outside
    for b in range(6):
        room.components[b] = 3 + b // 2
        room.signs[b] = 1.0 - 2.0 * (b % 2)
        for i in range(1, stages + 1):
            room.bounds[i, b] = law.speed_bound / speed
            room.bound_weights[i, b] = hard
        outside = outside or (
            room.signs[b] * state[3 + b // 2] - law.speed_bound > START_TOLERANCE * speed
        )
    return with_bounds(room, 6), outside
