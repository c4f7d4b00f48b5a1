"""Approach cones and keep-out planes in the target's frame."""

import numpy as np

from smallsat.dynamics.compiled import compiled

DEGENERATE = 1e-9


@compiled
def rotated(axis, angle, out):
    """An axis turned about z by an angle, rad."""
    c, s = np.cos(angle), np.sin(angle)
    out[0] = c * axis[0] - s * axis[1]
    out[1] = s * axis[0] + c * axis[1]
    out[2] = axis[2]


@compiled
def cone_faces(axis, tangent, out):
    """Normals of the four faces of a cone about an axis in the orbit's plane, (4, 3).

    The cone is Hx <= 0 (3.3) with unit rows, so that Hx is a distance from a face in metres. Two
    faces stand on the orbit's plane, two are inclined to it.
    """
    norm = 1.0 / np.sqrt(1.0 + tangent * tangent)
    for face in range(4):
        sign = 1.0 - 2.0 * (face % 2)
        for k in range(3):
            out[face, k] = -tangent * norm * axis[k]
        if face < 2:
            out[face, 0] -= sign * norm * axis[1]
            out[face, 1] += sign * norm * axis[0]
        else:
            out[face, 2] += sign * norm


@compiled
def in_cone(position, axis, tangent, faces):
    """Whether a position lies in the cone with its tip at the target."""
    cone_faces(axis, tangent, faces)
    for face in range(4):
        total = 0.0
        for k in range(3):
            total += faces[face, k] * position[k]
        if total > 0.0:
            return False
    return True


@compiled
def keep_out_normals(position, velocity, axis, steps, largest_angle, rule, out):
    """Outward normals of the rotating keep-out plane, (steps + 1, 3) (3.5, 3.6).

    The first normal points at the chaser. The last lies on the axis if equal turns of at most
    `largest_angle` reach it; then the planes turn the short way. Otherwise they turn by the
    largest angle: the short way (rule 0), the way that the natural relative motion takes, which is
    clockwise in the orbit's plane as seen from its normal (1), or the chaser's own way (2).
    """
    radius = np.sqrt(position[0] ** 2 + position[1] ** 2 + position[2] ** 2)
    first = position / radius
    cosine = first[0] * axis[0] + first[1] * axis[1] + first[2] * axis[2]
    tangent = axis - cosine * first
    sine = np.sqrt(tangent[0] ** 2 + tangent[1] ** 2 + tangent[2] ** 2)
    if sine > DEGENERATE:
        tangent /= sine
    else:
        tangent[0], tangent[1], tangent[2] = first[1], -first[0], 0.0
    turn = np.arctan2(sine, cosine) / steps
    if turn > largest_angle:
        turn = largest_angle
        along = 0.0
        if rule == 1:
            along = tangent[0] * first[1] - tangent[1] * first[0]
        elif rule == 2:
            along = tangent[0] * velocity[0] + tangent[1] * velocity[1] + tangent[2] * velocity[2]
        if along < 0.0:
            turn = -turn
    for i in range(steps + 1):
        c, s = np.cos(i * turn), np.sin(i * turn)
        for k in range(3):
            out[i, k] = c * first[k] + s * tangent[k]
