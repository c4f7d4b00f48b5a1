"""Approach cones and keep-out planes."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from smallsat.studies.rendezvous.model.geometry import (
    GREAT_CIRCLE,
    UPRIGHT,
    cone_faces,
    in_cone,
    keep_out_normals,
    rotated,
)

angles = st.floats(0.0, 2 * np.pi)
numbers = st.floats(-1.0, 1.0)


def axis_at(angle):
    return np.array([np.cos(angle), np.sin(angle), 0.0])


@given(angles, st.floats(np.radians(3), np.radians(60)), st.floats(0.01, 1000), numbers, numbers)
def test_cone_is_a_pyramid_of_its_half_angle(angle, half, distance, across, up):
    """A point at a distance along the axis is inside up to tan(half angle) of it to each side."""
    assume(min(abs(abs(across) - 0.5), abs(abs(up) - 0.5)) > 1e-6)
    axis = axis_at(angle)
    side = np.array([-axis[1], axis[0], 0.0])
    reach = 2.0 * distance * np.tan(half)
    point = distance * axis + across * reach * side + up * reach * np.array([0.0, 0.0, 1.0])
    inside = in_cone(point, axis, np.tan(half))
    assert inside == (abs(across) < 0.5 and abs(up) < 0.5)
    assert not in_cone(-point, axis, np.tan(half))


@given(angles, st.floats(np.radians(3), np.radians(60)))
def test_cone_rows_are_distances(angle, half):
    faces = np.empty((4, 3))
    cone_faces(axis_at(angle), np.tan(half), faces)
    assert np.allclose(np.linalg.norm(faces, axis=1), 1.0)
    assert np.allclose(faces @ axis_at(angle), -np.sin(half))


@given(angles, angles, st.floats(0.0, 3.0), st.floats(0.0, 6.0))
def test_cone_rotates_with_the_target(angle, half_turn, rate, time):
    """H_{i+1} = H_i R' about z, not about x as (3.15) prints: Section 3.6 rotates about z."""
    turned, faces, at_once = np.empty(3), np.empty((4, 3)), np.empty((4, 3))
    rotated(axis_at(angle), rate * time, turned)
    cone_faces(axis_at(angle), 0.3, faces)
    cone_faces(turned, 0.3, at_once)
    c, s = np.cos(rate * time), np.sin(rate * time)
    assert np.allclose(faces @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T, at_once)


def planes(position, axis, steps, largest, rule):
    normals = np.empty((steps + 1, 3))
    keep_out_normals(position, axis, steps, largest, rule, normals)
    return normals


def turns(normals):
    return np.arccos(np.clip(np.sum(normals[1:] * normals[:-1], axis=1), -1.0, 1.0))


@given(
    st.tuples(numbers, numbers, numbers),
    angles,
    st.integers(1, 45),
    st.floats(0.001, 0.2),
    st.sampled_from([GREAT_CIRCLE, UPRIGHT]),
)
def test_planes_turn_evenly_no_faster_than_allowed(position, angle, steps, largest, rule):
    """Unit normals from the chaser's direction on, equal turns; at the axis if it is in reach."""
    position, axis = 1e3 * np.array(position), axis_at(angle)
    first = position * [1.0, 1.0, 0.0 if rule == UPRIGHT else 1.0]
    assume(np.linalg.norm(first) > 1.0)
    first /= np.linalg.norm(first)
    apart = np.arctan2(np.linalg.norm(np.cross(first, axis)), first @ axis)
    assume(1e-3 < apart < np.pi - 1e-3 and abs(apart - steps * largest) > 1e-6)
    normals = planes(position, axis, steps, largest, rule)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert np.allclose(normals[0], first)
    step = min(largest, apart / steps)
    assert np.allclose(turns(normals), step, atol=1e-6)
    if apart < steps * largest:
        assert np.allclose(normals[-1], axis, atol=1e-9)
    if rule == UPRIGHT:
        assert np.allclose(normals[:, 2], 0.0)


@pytest.mark.parametrize("rule", [GREAT_CIRCLE, UPRIGHT])
@pytest.mark.parametrize("angle", np.radians([-170, -100, -20, 60, 150]))
def test_planes_turn_the_way_of_free_motion_until_the_axis_is_in_reach(angle, rule):
    """A chaser on a stable ellipse moves clockwise in the orbit's plane, and so do the planes."""
    position = 1000.0 * axis_at(angle)
    free = np.array([position[1] / 2, -2 * position[0], 0.0])
    normals = planes(position, axis_at(angle + 2.0), 10, 0.01, rule)
    assert (normals[1] - normals[0]) @ free > 0
    # In reach they turn the short way, which is the other one here.
    short = planes(position, axis_at(angle + 2.0), 10, 0.3, rule)
    assert (short[1] - short[0]) @ free < 0


@pytest.mark.parametrize("rule", [GREAT_CIRCLE, UPRIGHT])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_planes_are_defined_on_the_axis_and_opposite_to_it(sign, rule):
    axis = np.array([0.0, 1.0, 0.0])
    normals = planes(sign * 500.0 * axis, axis, 30, 0.03, rule)
    assert np.isfinite(normals).all() and np.allclose(np.linalg.norm(normals, axis=1), 1.0)


def test_upright_planes_are_defined_above_the_target():
    """On the orbit's normal no direction in its plane is the chaser's; the axis is taken."""
    normals = planes(np.array([0.0, 0.0, 300.0]), np.array([0.0, 1.0, 0.0]), 5, 0.03, UPRIGHT)
    assert np.allclose(normals, [0.0, 1.0, 0.0])
