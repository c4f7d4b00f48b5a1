"""Gravity of a rotating planet in spherical harmonics, without a singularity at the poles.

The expansion is that of Pines (AIAA Journal 11, 1973). With the direction (s, t, u) of a point in
body-fixed axes, q the reference radius over its distance r, and r_m + i i_m = (s + i t)^m,

    U = mu/r sum_n q^n sum_m A_nm(u) (C_nm r_m + S_nm i_m),

where A_nm is the m-th derivative of the Legendre polynomial P_n. Here A_nm is carried divided by
its leading coefficient (2n - 1)!!/(n - m)!, which leaves a recurrence with one constant; that
coefficient, the normalisation and the factors of the derivatives are folded into a table once.
Degrees up to about 20 are safe from overflow and loss of digits; larger ones were not considered.
"""

from collections.abc import Iterable
from math import factorial, prod, sqrt

import numpy as np

from smallsat.dynamics.compiled import compiled


def normalisation(n: int, m: int) -> float:
    """What a fully normalised coefficient is multiplied by to give the plain one."""
    twice = 1 if m == 0 else 2
    return sqrt(twice * (2 * n + 1) * factorial(n - m) / factorial(n + m))


def terms(
    coefficients: Iterable[tuple[int, int, float, float]], degree: int, order: int
) -> np.ndarray:
    """Table for `acceleration`, cut at a degree and an order.

    Parameters
    ----------
    coefficients
        Rows of n, m and the fully normalised C and S, from degree 2 on.
    degree, order
        Largest n and m; 0 and 0 leave the central field, 2 and 0 that and the oblateness.

    Returns
    -------
    numpy.ndarray, shape (columns, degree + 1, 7)
        For the column m and the degree n: the recurrence's constant, the factors of the two
        horizontal sums, of the two radial ones, and of the two along the axis.

    Raises
    ------
    ValueError
        The coefficients do not reach that far, or the order exceeds the degree.
    """
    known = {(n, m): (c, s) for n, m, c, s in coefficients}
    if order > degree:
        raise ValueError(f"order {order} exceeds the degree {degree}")
    c, s = np.zeros((degree + 1, degree + 2)), np.zeros((degree + 1, degree + 2))
    c[0, 0] = 1.0
    for n in range(2, degree + 1):
        for m in range(min(n, order) + 1):
            if (n, m) not in known:
                raise ValueError(f"no coefficient of degree {n} and order {m}")
            c[n, m], s[n, m] = normalisation(n, m) * np.array(known[n, m])
    columns = min(order + 1, degree) + 1
    table = np.zeros((columns, degree + 1, 7))
    for m in range(columns):
        for n in range(m, degree + 1):
            leading = prod(range(1, 2 * n, 2)) / factorial(n - m)
            if n > m:
                table[m, n, 0] = (n + m - 1) * (n - m - 1) / ((2 * n - 1) * (2 * n - 3))
            own = leading * np.array([c[n, m], s[n, m]])
            table[m, n, 1:3] = m * own
            table[m, n, 3:5] = (n + 1) * own
            if m:
                table[m, n, 5:7] = leading * np.array([c[n, m - 1], s[n, m - 1]])
    return table


@compiled
def acceleration(x, y, z, mu, radius, table):
    """Acceleration, m/s^2, shape (3,), at a point, m, in body-fixed axes.

    ``mu``, m^3/s^2, and ``radius``, m, are those that the coefficients belong to; ``table`` comes
    from `terms`.
    """
    inverse = 1.0 / sqrt(x * x + y * y + z * z)
    s, t, u = x * inverse, y * inverse, z * inverse
    q = radius * inverse
    squared, step = q * q, u * q
    # The derivatives by the direction, towards x, y and z, and the one along the radius.
    a1 = a2 = a3 = a4 = 0.0
    # (s + i t) to the powers m and m - 1, and q to the power m.
    real, imaginary, real_before, imaginary_before, power = 1.0, 0.0, 0.0, 0.0, 1.0
    for m in range(table.shape[0]):
        before, value = 0.0, power
        h1 = h2 = r1 = r2 = z1 = z2 = 0.0
        for n in range(m, table.shape[1]):
            row = table[m, n]
            if n > m:
                before, value = value, step * value - row[0] * squared * before
            h1 += row[1] * value
            h2 += row[2] * value
            r1 += row[3] * value
            r2 += row[4] * value
            z1 += row[5] * value
            z2 += row[6] * value
        a1 += h1 * real_before + h2 * imaginary_before
        a2 += h2 * real_before - h1 * imaginary_before
        a3 += z1 * real_before + z2 * imaginary_before
        a4 += r1 * real + r2 * imaginary
        real_before, imaginary_before = real, imaginary
        real, imaginary = s * real - t * imaginary, s * imaginary + t * real
        power *= q
    radial = a4 + s * a1 + t * a2 + u * a3
    factor = mu * inverse * inverse
    return (factor * (a1 - s * radial), factor * (a2 - t * radial), factor * (a3 - u * radial))
