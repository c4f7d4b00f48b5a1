"""Attitude quaternions, scalar last: kinematics, direction cosines, products, yaw-pitch-roll.

A quaternion (x, y, z, w) = (e sin(angle/2), cos(angle/2)) turns the inertial frame into the body
frame; its direction cosine matrix maps inertial to body components. The same attitude is
``Rotation.from_quat(q)`` of scipy, whose matrix is the transpose. Functions return tuples.
"""

from math import asin, atan2, sqrt

from smallsat.dynamics.compiled import compiled


@compiled
def quaternion_rate(q, rate):
    """Rate of change (4,) of a quaternion for a body rate (3,), rad/s (slew, Eq. 18)."""
    x, y, z, w = q[0], q[1], q[2], q[3]
    a, b, c = rate[0], rate[1], rate[2]
    return (
        0.5 * (c * y - b * z + a * w),
        0.5 * (a * z - c * x + b * w),
        0.5 * (b * x - a * y + c * w),
        -0.5 * (a * x + b * y + c * z),
    )


@compiled
def quaternion_to_dcm(q):
    """Direction cosine matrix, shape (3, 3), inertial to body."""
    x, y, z, w = q[0], q[1], q[2], q[3]
    return (
        (x * x - y * y - z * z + w * w, 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
        (2.0 * (x * y - z * w), -x * x + y * y - z * z + w * w, 2.0 * (y * z + x * w)),
        (2.0 * (x * z + y * w), 2.0 * (y * z - x * w), -x * x - y * y + z * z + w * w),
    )


@compiled
def product(p, q):
    """The attitude p followed by the turn q about the axes that p leads to."""
    return (
        p[3] * q[0] + q[3] * p[0] + p[1] * q[2] - p[2] * q[1],
        p[3] * q[1] + q[3] * p[1] + p[2] * q[0] - p[0] * q[2],
        p[3] * q[2] + q[3] * p[2] + p[0] * q[1] - p[1] * q[0],
        p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2],
    )


@compiled
def conjugate(q):
    """The reverse turn."""
    return (-q[0], -q[1], -q[2], q[3])


@compiled
def error_quaternion(q, target):
    """The turn from ``target`` to ``q``, in body components."""
    return product(conjugate(target), q)


@compiled
def turn_angle(q):
    """Angle of a turn, rad, between 0 and pi; accurate for small ones."""
    return 2.0 * atan2(sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]), abs(q[3]))


@compiled
def roll_pitch_yaw(q):
    """Angles about x, y and z, rad, of the sequence yaw, pitch, roll."""
    dcm = quaternion_to_dcm(q)
    sine = min(1.0, max(-1.0, dcm[0][2]))
    return atan2(dcm[1][2], dcm[2][2]), -asin(sine), atan2(dcm[0][1], dcm[0][0])
