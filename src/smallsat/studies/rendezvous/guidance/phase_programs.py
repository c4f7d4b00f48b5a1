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
from smallsat.dynamics.orbits.yamanaka_ankersen import transition as elliptic_transition
from smallsat.dynamics.orbits.yamanaka_ankersen import true_anomaly_after
from smallsat.optimal_control.riccati_interior_point import STATES, Program
from smallsat.studies.rendezvous.guidance.law import (
    APPROACH,
    AT_HORIZON,
    AT_STAGE,
    AT_START,
    DOCKING,
    RENDEZVOUS,
)
from smallsat.studies.rendezvous.model.geometry import cone_faces, keep_out_normals, rotated

PLANES = 5  # rows on the position at a stage, at most
BOUNDS = 6  # rows on single components of the state, at most
START_TOLERANCE = 1e-6  # scaled


@compiled
def empty_program(stages):
    """Return a `Program` with room for any of up to that many stages."""
    return Program(
        np.zeros((stages, 6, 6)),
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
def bound_count(law, phase):
    """Return the number of rows on components of the state that a phase's program has."""
    if phase == RENDEZVOUS:
        return STATES if law.norm_control_weights[0] > 0.0 else 0
    return BOUNDS if phase == DOCKING else 0


@compiled
def in_use(program, law, phase):
    """Return the program with only the models and rows on components that a phase's program has."""
    count = bound_count(law, phase)
    # On a circular orbit all stages have the same model.
    models = law.horizons[phase] if law.elliptic != 0 else 1
    return Program(
        program.transitions[:models],
        program.state_hessian,
        program.terminal_hessian,
        program.state_gradient,
        program.control_hessian,
        program.control_norm,
        program.plane_count,
        program.normals,
        program.offsets,
        program.plane_weights,
        program.components[:count],
        program.signs[:count],
        program.bounds,
        program.bound_weights,
    )


@compiled
def lane_of(programs, lane):
    """Return one of several programs whose arrays of floats have a last axis more, as a view."""
    return Program(
        programs.transitions[..., lane],
        programs.state_hessian[..., lane],
        programs.terminal_hessian[..., lane],
        programs.state_gradient[..., lane],
        programs.control_hessian[..., lane],
        programs.control_norm[..., lane],
        programs.plane_count,
        programs.normals[..., lane],
        programs.offsets[..., lane],
        programs.plane_weights[..., lane],
        programs.components,
        programs.signs,
        programs.bounds[..., lane],
        programs.bound_weights[..., lane],
    )


def shape(law, phase):
    """What programs of laws must have in common to be solved together: a key, from `SETTINGS`."""
    common = phase, int(law["horizons"][phase]), bool(law["elliptic"])
    if phase != RENDEZVOUS:
        return common
    one_norm, cone = law["norm_control_weights"][0] > 0.0, law["penalties"][0] > 0.0
    return *common, bool(one_norm), bool(cone)


@compiled
def reference(law, distance, angle, out):
    """Fill `out`, (6,): a point on the turned axis, m, and, if the law wants it, its velocity."""
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
    """Return the time, s, at which something that rotates is taken, by its rule."""
    if rule == AT_START:
        return time
    if rule == AT_HORIZON:
        return time + stages * sample_time
    return time + stage * sample_time


@compiled
def write_program(law, phase, state, time, program):
    """Write the program of a phase.

    Parameters
    ----------
    law
        A `SETTINGS` record.
    phase
        0, 1 or 2.
    state, time
        Relative state, m and m/s, and time, s, at the start of the horizon.
    program
        Arrays of `empty_program`, written.

    Returns
    -------
    Program, bool
        The program, and whether a constraint is violated at the start already.
    """
    one_norm = phase == RENDEZVOUS and law.norm_control_weights[0] > 0.0
    _write_transitions(law, phase, time, program.transitions)
    _write_cost(law, phase, time, one_norm, program)
    if phase == RENDEZVOUS:
        outside = _write_keep_out(law, state, time, program)
    else:
        outside = _write_corridor(law, phase, state, time, program)
    if phase == DOCKING:
        outside = _write_speed_bound(law, state, program) or outside
    return in_use(program, law, phase), outside


@compiled
def _write_transitions(law, phase, time, transitions):
    """Write the model: circular, once, or of each stage of an ellipse from where it is now."""
    if law.elliptic == 0:
        for j in range(6):
            for k in range(6):
                transitions[0, j, k] = law.transitions[phase, j, k]
        return
    n, e, ts = law.mean_motion, law.eccentricity, law.sample_times[phase]
    anomaly = true_anomaly_after(law.true_anomaly, e, n * time)
    for i in range(law.horizons[phase]):
        step = elliptic_transition(n, e, anomaly, ts)
        anomaly = true_anomaly_after(anomaly, e, n * ts)
        for j in range(6):
            for k in range(6):
                scale = law.scales[phase, k] / law.scales[phase, j]
                transitions[i, j, k] = step[j, k] * scale


@compiled
def _write_cost(law, phase, time, one_norm, program):
    """Write the cost, quadratic or the far range's 1-norm, about the reference."""
    stages = law.horizons[phase]
    for j in range(6):
        for k in range(6):
            program.terminal_hessian[j, k] = 0.0 if one_norm else law.terminal_hessians[phase, j, k]
        program.state_hessian[j] = 0.0 if one_norm else law.state_hessians[phase, j]
    for k in range(3):
        program.control_hessian[k] = 0.0 if one_norm else law.control_hessians[phase, k]
        program.control_norm[k] = law.norm_control_weights[k] if one_norm else 0.0
    point = np.empty(6)
    distance = law.port if phase == DOCKING else law.set_points[phase]
    rule = AT_STAGE if phase == DOCKING else law.set_point_time
    for i in range(1, stages + 1):
        if i == 1 or (rule == AT_STAGE and law.rotation_rate != 0.0):
            at = _time_of(rule, time, i, stages, law.sample_times[phase])
            reference(law, distance, law.rotation_rate * at, point)
            for k in range(6):
                point[k] /= law.scales[phase, k]
        if one_norm:
            for k in range(6):
                weight = law.norm_weights[k] if i < stages else law.norm_terminal_weights[k]
                program.components[k] = k
                program.signs[k] = 1.0
                program.bounds[i, k] = point[k]
                program.bound_weights[i, k] = 2.0 * weight
                program.state_gradient[i, k] = -weight
        elif i < stages:
            for k in range(6):
                program.state_gradient[i, k] = -law.state_hessians[phase, k] * point[k]
        else:
            for j in range(6):
                total = 0.0
                for k in range(6):
                    total -= law.terminal_hessians[phase, j, k] * point[k]
                program.state_gradient[i, j] = total


@compiled
def _set_plane(program, i, p, sign, normal, offset, weight):
    """Write row `p` on the position at a stage: sign times normal (3,), offset, weight."""
    for k in range(3):
        program.normals[i, p, k] = sign * normal[k]
    program.offsets[i, p] = offset
    program.plane_weights[i, p] = weight


@compiled
def _write_keep_out(law, state, time, program):
    """Write the far range's planes, and its cone at the end; return whether the start is inside."""
    stages, ts, length = law.horizons[0], law.sample_times[0], law.scales[0, 0]
    axis, faces, normals = np.empty(3), np.empty((4, 3)), np.empty((stages + 1, 3))
    at = _time_of(law.terminal_cone_time, time, stages, stages, ts)
    rotated(law.axis, law.rotation_rate * at, axis)
    keep_out_normals(state[:3], axis, stages, law.plane_rate * ts, law.plane_turn, normals)
    for i in range(1, stages + 1):
        program.plane_count[i] = 1
        _set_plane(program, i, 0, -1.0, normals[i], -law.keep_out / length, law.hard_weights[0])
    if law.penalties[0] > 0.0:
        program.plane_count[stages] = 5
        cone_faces(axis, law.tangents[0], faces)
        for face in range(4):
            _set_plane(program, stages, 1 + face, 1.0, faces[face], 0.0, law.penalties[0])
    gap = normals[0] @ state[:3] - law.keep_out
    return gap < -START_TOLERANCE * length


@compiled
def _write_corridor(law, phase, state, time, program):
    """Write the cone of each stage, and the mid range's plane; return whether the start is outside.

    Only hard rows count for that.
    """
    hard, length = law.hard_weights[phase], law.scales[phase, 0]
    tip = law.port if phase == DOCKING else 0.0
    margin = law.cone_margin if phase == DOCKING else 0.0
    weight = hard if phase == DOCKING else law.penalties[phase]
    axis, faces = np.empty(3), np.empty((4, 3))
    outside = False
    for i in range(law.horizons[phase] + 1):
        if i == 0 or law.rotation_rate != 0.0:
            rotated(law.axis, law.rotation_rate * (time + i * law.sample_times[phase]), axis)
            cone_faces(axis, law.tangents[phase], faces)
        for face in range(4):
            offset = 0.0
            for k in range(3):
                offset += faces[face, k] * axis[k]
            limit = (tip * offset - margin) / length
            _set_plane(program, i, face, 1.0, faces[face], limit, weight)
        program.plane_count[i] = 4
        if phase == APPROACH:
            program.plane_count[i] = 5
            _set_plane(program, i, 4, -1.0, axis, -law.overshoot / length, hard)
    for p in range(program.plane_count[0]):
        if program.plane_weights[0, p] == hard:
            excess = -program.offsets[0, p]
            for k in range(3):
                excess += program.normals[0, p, k] * state[k] / length
            outside = outside or excess > START_TOLERANCE
    return outside


@compiled
def _write_speed_bound(law, state, program):
    """Write the bounds on the velocity while docking; return whether the start violates one."""
    speed, outside = law.scales[DOCKING, 3], False
    bound = law.speed_bound - law.speed_margin
    for b in range(BOUNDS):
        program.components[b] = 3 + b // 2
        program.signs[b] = 1.0 - 2.0 * (b % 2)
        for i in range(1, law.horizons[DOCKING] + 1):
            program.bounds[i, b] = bound / speed
            program.bound_weights[i, b] = law.hard_weights[DOCKING]
        excess = program.signs[b] * state[3 + b // 2] - bound
        outside = outside or excess > START_TOLERANCE * speed
    return outside
