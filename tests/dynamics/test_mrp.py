"""MRP algebra against scipy's rotations, to rounding."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from smallsat.dynamics.attitude.mrp import dcm_to_mrp, mrp_rate, mrp_to_dcm, shadow

component = st.floats(-0.577, 0.577)
mrp = st.tuples(component, component, component).map(np.array)
rate = st.tuples(*[st.floats(-2.0, 2.0)] * 3).map(np.array)


@given(mrp)
def test_dcm_is_scipys_active_matrix_transposed(sigma):
    """Every MRP set with a norm below 1; entries to 1e-14."""
    expected = Rotation.from_mrp(sigma).as_matrix().T
    np.testing.assert_allclose(mrp_to_dcm(sigma), expected, rtol=0, atol=1e-14)


@given(mrp)
def test_dcm_to_mrp_inverts(sigma):
    """Short sets come back, to 1e-13."""
    np.testing.assert_allclose(dcm_to_mrp(mrp_to_dcm(sigma)), sigma, rtol=0, atol=1e-13)


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_dcm_to_mrp_agrees_with_scipy_and_is_short(quaternion):
    """Any rotation; the attitude to 1e-7 rad (scipy's own loss near half turns), norm at most 1."""
    rotation = Rotation.from_quat(quaternion)
    rows = tuple(map(tuple, rotation.as_matrix().T))
    sigma = np.array(dcm_to_mrp(rows))
    assert np.linalg.norm(sigma) <= 1.0 + 1e-12
    assert (Rotation.from_mrp(sigma).inv() * rotation).magnitude() < 1e-7


@pytest.mark.parametrize("axis", np.vstack([np.eye(3), [[0.6, 0.8, 0.0], [0.0, -0.6, 0.8]]]))
def test_half_turns_are_accurate(axis):
    """Half turns, where the trace formula divides by zero: the matrix comes back to 1e-12."""
    dcm = 2.0 * np.outer(axis, axis) - np.eye(3)
    sigma = dcm_to_mrp(tuple(map(tuple, dcm)))
    np.testing.assert_allclose(mrp_to_dcm(sigma), dcm, rtol=0, atol=1e-12)
    assert max(sigma, key=abs) > 0.0


@given(mrp.filter(lambda sigma: np.linalg.norm(sigma) > 1e-2))
def test_shadow_is_the_same_attitude(sigma):
    """The matrix of the shadow set equals that of the set, to 1e-11; shadow is its own inverse."""
    other = np.array(shadow(sigma))
    np.testing.assert_allclose(mrp_to_dcm(other), mrp_to_dcm(sigma), rtol=0, atol=1e-11)
    np.testing.assert_allclose(shadow(other), sigma, rtol=1e-12, atol=1e-14)


@given(mrp, rate)
def test_mrp_rate_is_the_derivative_along_a_rotation(sigma, omega):
    """Against a central difference of scipy's composition with a body-fixed turn, to 1e-8."""
    start, h = Rotation.from_mrp(sigma), 1e-5

    def turned(time):
        quaternion = (start * Rotation.from_rotvec(omega * time)).as_quat()
        # Of the two signs the one near the start, so that the set does not switch.
        quaternion *= np.sign(quaternion @ start.as_quat())
        return quaternion[:3] / (1.0 + quaternion[3])

    sign = np.sign(start.as_quat()[3]) or 1.0
    if sign < 0:
        start = Rotation.from_quat(-start.as_quat())
    expected = (turned(h) - turned(-h)) / (2 * h)
    np.testing.assert_allclose(mrp_rate(sigma, omega), expected, rtol=0, atol=1e-8)
