"""Vectors of three and matrices of three rows as tuples, for compiled loops.

Tuples stay in registers where small arrays would be allocated; in the attitude loop that is a
factor of ten. Arguments may be tuples or arrays; results are tuples of floats.
"""

from math import sqrt

from smallsat.dynamics.compiled import compiled


@compiled
def dot(a, b):
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a, b):
    """Vector product a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@compiled
def scaled(factor, a):
    """Factor times vector."""
    return (factor * a[0], factor * a[1], factor * a[2])


@compiled
def axpy(a, x, y):
    """Sum a x + y of a number and two vectors, as BLAS calls it."""
    return (y[0] + a * x[0], y[1] + a * x[1], y[2] + a * x[2])


@compiled
def unit(a):
    """Vector of length one along a."""
    return scaled(1.0 / sqrt(dot(a, a)), a)


@compiled
def times(matrix, a):
    """Matrix times vector."""
    return (dot(matrix[0], a), dot(matrix[1], a), dot(matrix[2], a))


@compiled
def times_transposed(a, b):
    """Matrix a times the transpose of matrix b."""
    return (times(b, a[0]), times(b, a[1]), times(b, a[2]))
