"""Modified Rodrigues parameters (MRPs): direction cosines, shadow set, kinematics.

An MRP set sigma = e tan(angle/4) describes frame B relative to frame N; [BN] maps N to B
components. scipy's ``Rotation.from_mrp(sigma)`` is the active rotation, so that
``Rotation.from_mrp(sigma).as_matrix()`` is [BN] transposed. The functions here are compiled for
use inside integration loops and return tuples; tests compare them with scipy.
"""

from math import sqrt

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, cross, dot, scaled


@compiled
def mrp_to_dcm(sigma):
    """Direction cosine matrix [BN], shape (3, 3), of an MRP set, shape (3,).

    [BN] = I + (8 [~s]^2 - 4 (1 - s^2) [~s]) / (1 + s^2)^2, with the cross-product matrix [~s].
    """
    x, y, z = sigma[0], sigma[1], sigma[2]
    squared = dot(sigma, sigma)
    a = 8.0 / (1.0 + squared) ** 2
    b = 4.0 * (1.0 - squared) / (1.0 + squared) ** 2
    return (
        (1.0 - a * (y * y + z * z), a * x * y + b * z, a * x * z - b * y),
        (a * x * y - b * z, 1.0 - a * (x * x + z * z), a * y * z + b * x),
        (a * x * z + b * y, a * y * z - b * x, 1.0 - a * (x * x + y * y)),
    )


@compiled
def dcm_to_mrp(dcm):
    """MRP set with a norm of at most 1, shape (3,), of a direction cosine matrix [BN].

    Goes by the quaternion whose largest component is the divisor (Sheppard), so that it is accurate
    for half turns too. There, of the two equal sets, the one with a positive largest component.
    """
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = dcm
    trace = xx + yy + zz
    # Each branch is the quaternion up to a factor.
    if trace >= xx and trace >= yy and trace >= zz:
        w, x, y, z = 1.0 + trace, yz - zy, zx - xz, xy - yx
    elif xx >= yy and xx >= zz:
        w, x, y, z = yz - zy, 1.0 + 2.0 * xx - trace, xy + yx, zx + xz
    elif yy >= zz:
        w, x, y, z = zx - xz, xy + yx, 1.0 + 2.0 * yy - trace, yz + zy
    else:
        w, x, y, z = xy - yx, zx + xz, yz + zy, 1.0 + 2.0 * zz - trace
    norm = sqrt(w * w + x * x + y * y + z * z)
    factor = 1.0 / (w + norm) if w >= 0.0 else 1.0 / (w - norm)
    return (factor * x, factor * y, factor * z)


@compiled
def shadow(sigma):
    """The other MRP set of the same attitude, shape (3,)."""
    return scaled(-1.0 / dot(sigma, sigma), sigma)


@compiled
def mrp_rate(sigma, rate):
    """Rate of change of an MRP set (mars, Section IX.A).

    Parameters
    ----------
    sigma : shape (3,)
        Attitude of B relative to N.
    rate : shape (3,)
        Angular velocity of B relative to N, in B components, rad/s.

    Returns
    -------
    tuple, shape (3,)
        1/s.
    """
    turned = axpy(2.0, cross(sigma, rate), scaled(1.0 - dot(sigma, sigma), rate))
    return scaled(0.25, axpy(2.0 * dot(sigma, rate), sigma, turned))
