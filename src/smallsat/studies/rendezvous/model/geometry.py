"""Approach cones and keep-out planes in the target's Hill frame (section 3.1).

Positions are in metres, velocities in m/s, x radial, y along the orbit, z normal to it.
"""

import numpy as np

from smallsat.dynamics.compiled import compiled

# How the keep-out planes turn: from the chaser to the approach axis within the great circle through
# both, or upright on the orbit's plane, about its normal.
GREAT_CIRCLE, UPRIGHT = 0, 1
DEGENERATE = 1e-9  # sine of the angle between chaser and axis, below which they are one line


@compiled
def rotated(axis, angle, out):
    """Fill an axis (3,) turned about z by an angle, rad."""
    c, s = np.cos(angle), np.sin(angle)
    out[0] = c * axis[0] - s * axis[1]
    out[1] = s * axis[0] + c * axis[1]
    out[2] = axis[2]


@compiled
def cone_faces(axis, tangent, out):
    """Fill the outward normals (4, 3) of the faces of a cone about an axis in the orbit's plane.

    The cone is Hx <= 0 (3.3) with unit rows, so that Hx is a distance from a face in metres. Two
    faces stand on the orbit's plane, two are inclined to it. ``tangent`` is that of the half angle.
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
def in_cone(position, axis, tangent):
    """Whether a position (3,), m, lies in the cone with its tip at the target."""
    faces = np.empty((4, 3))
    cone_faces(axis, tangent, faces)
    for face in range(4):
        total = 0.0
        for k in range(3):
            total += faces[face, k] * position[k]
        if total > 0.0:
            return False
    return True


@compiled
def keep_out_normals(position, axis, steps, largest_angle, turn_rule, out):
    """Fill the outward normals of the rotating keep-out plane, (steps + 1, 3) (3.5, 3.6).

    The first normal points at the chaser, the last one along the axis if equal turns of at most
    `largest_angle`, rad, reach it; then the planes turn the short way. Otherwise they turn by the
    largest angle the way of the natural relative motion, clockwise as seen from the orbit's normal
    (section 3.1.3). By the rule they turn within the great circle from chaser to axis
    (`GREAT_CIRCLE`), or about the orbit's normal and stand upright on its plane (`UPRIGHT`).
    """
    first = position.copy()
    if turn_rule == UPRIGHT:
        first[2] = 0.0
    radius = np.sqrt(first[0] ** 2 + first[1] ** 2 + first[2] ** 2)
    if radius > DEGENERATE * abs(position[2]):
        first /= radius
    else:
        first[:] = axis
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
        if tangent[0] * first[1] < tangent[1] * first[0]:
            turn = -turn
    for i in range(steps + 1):
        c, s = np.cos(i * turn), np.sin(i * turn)
        for k in range(3):
            out[i, k] = c * first[k] + s * tangent[k]
