"""Linear relative motion with the mean effect of the oblateness (Schweighart and Sedwick).

Journal of Guidance, Control, and Dynamics 25 (2002), 1073-1080: the gradient of the J2 term,
averaged over an orbit, changes the constants of Clohessy and Wiltshire's equations by

    s = 3 J2 R^2 / (8 r^2) (1 + 3 cos 2i),   c = sqrt(1 + s),

and the frame turns at n c instead of n. The drift between the two planes of motion, which the
authors add as a forcing in time, is left out, for the prediction has to be time-invariant.

How much this can gain: on an equatorial orbit the averaged field is the field, and the equations
are exact for small separations. On an inclined orbit the periodic part of the gradient, which is
averaged away, is as large; over an orbit it leaves more error than the mean part takes away, and
near i = 54.7 deg, where s vanishes, the equations are those of Clohessy and Wiltshire.
"""

import numpy as np

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.environment.spherical_harmonics import normalisation

J2 = -normalisation(2, 0) * egm96.COEFFICIENTS[0][2]


def oblateness(inclination: float, radius: float) -> float:
    """The parameter s, for an inclination, rad, and a radius of the orbit, m."""
    return (
        3.0 / 8.0 * J2 * (egm96.RADIUS / radius) ** 2 * (1.0 + 3.0 * float(np.cos(2 * inclination)))
    )


def schweighart_sedwick(mean_motion: float, inclination: float, radius: float) -> np.ndarray:
    """Matrix of the continuous equations, (6, 6), in place of that of Eq. 2.2.

    Parameters
    ----------
    mean_motion
        n, rad/s: of the circular orbit with this radius in the central field. The target's frame
        turns at n c, so that n is its mean rate over c.
    inclination, radius
        Inclination and radius of the target's orbit, rad and m.
    """
    n = mean_motion
    squared = 1.0 + oblateness(inclination, radius)
    turn = 2.0 * n * np.sqrt(squared)
    matrix = np.zeros((6, 6))
    matrix[:3, 3:] = np.eye(3)
    matrix[3, 0], matrix[3, 4] = (5.0 * squared - 2.0) * n**2, turn
    matrix[4, 3] = -turn
    matrix[5, 2] = -(3.0 * squared - 2.0) * n**2
    return matrix
