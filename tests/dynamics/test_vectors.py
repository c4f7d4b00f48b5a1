"""Tuple vectors against NumPy, to rounding."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from smallsat.dynamics.vectors import axpy, cross, dot, scaled, times, times_transposed, unit

number = st.floats(-1e3, 1e3)
vector = st.tuples(number, number, number)
matrix = st.tuples(vector, vector, vector)


@given(vector, vector, number)
def test_vector_operations(a, b, factor):
    """Sums and products to 1e-9 of values up to 1e6."""
    np.testing.assert_allclose(dot(a, b), np.dot(a, b), atol=1e-9)
    np.testing.assert_allclose(cross(a, b), np.cross(a, b), atol=1e-9)
    np.testing.assert_allclose(scaled(factor, a), factor * np.array(a), atol=1e-9)
    np.testing.assert_allclose(axpy(factor, b, a), a + factor * np.array(b), atol=1e-9)


@given(matrix, matrix, vector)
def test_matrix_operations(a, b, v):
    """Matrix times vector and matrix times transpose to 1e-8 of values up to 3e6."""
    np.testing.assert_allclose(times(a, v), np.array(a) @ v, atol=1e-8)
    np.testing.assert_allclose(times_transposed(a, b), np.array(a) @ np.array(b).T, atol=1e-8)


@given(vector.filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_unit(v):
    """Length one and the same direction, to 1e-12."""
    np.testing.assert_allclose(unit(v), np.array(v) / np.linalg.norm(v), atol=1e-12)
