"""Torques of the environment: gravity gradient, drag on panels, an exponential atmosphere."""

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import cross, dot, times

# Base altitude, km, density there, kg/m^3, and scale height, km: Vallado, Fundamentals of
# Astrodynamics and Applications, exponential model, mean solar activity.
ATMOSPHERE = np.array(
    [
        (100, 5.297e-7, 5.877),
        (110, 9.661e-8, 7.263),
        (120, 2.438e-8, 9.473),
        (130, 8.484e-9, 12.636),
        (140, 3.845e-9, 16.149),
        (150, 2.070e-9, 22.523),
        (180, 5.464e-10, 29.740),
        (200, 2.789e-10, 37.105),
        (250, 7.248e-11, 45.546),
        (300, 2.418e-11, 53.628),
        (350, 9.518e-12, 53.298),
        (400, 3.725e-12, 58.515),
        (450, 1.585e-12, 60.828),
        (500, 6.967e-13, 63.822),
        (600, 1.454e-13, 71.835),
        (700, 3.614e-14, 88.667),
        (800, 1.170e-14, 124.64),
        (900, 5.245e-15, 181.05),
        (1000, 3.019e-15, 268.00),
    ]
)


@compiled
def gravity_gradient(inertia, r, mu):
    """Gravity-gradient torque, N m, for any inertia tensor (3, 3) and position in body components.

    3 mu / r^5 times r x J r. With principal axes and r along the inertial first axis it is Eq. 27.
    """
    squared = dot(r, r)
    factor = 3.0 * mu / (squared * squared * squared**0.5)
    torque = cross(r, times(inertia, r))
    return (factor * torque[0], factor * torque[1], factor * torque[2])


@compiled
def density(altitude, table):
    """Density of the atmosphere, kg/m^3, at an altitude, m; ``table`` is `ATMOSPHERE`."""
    height = altitude / 1000.0
    k = 0
    while k + 1 < table.shape[0] and height >= table[k + 1, 0]:
        k += 1
    return table[k, 1] * np.exp((table[k, 0] - height) / table[k, 2])


@compiled
def panel_drag(panels, wind, rho, drag_coefficient):
    """Drag torque on flat panels, N m, in body components.

    Parameters
    ----------
    panels : shape (n, 7)
        Area, m^2, outward normal (3) and centre of pressure (3), m.
    wind : shape (3,)
        Velocity of the spacecraft relative to the air, m/s.
    rho : float
        Density, kg/m^3.
    drag_coefficient : float
        The force is half the density, the coefficient, the projected area and the squared speed,
        against the motion, on panels that face it.
    """
    x = y = z = 0.0
    for k in range(panels.shape[0]):
        facing = panels[k, 1] * wind[0] + panels[k, 2] * wind[1] + panels[k, 3] * wind[2]
        if facing > 0.0:
            f = -0.5 * rho * drag_coefficient * panels[k, 0] * facing
            torque = cross((panels[k, 4], panels[k, 5], panels[k, 6]), wind)
            x += f * torque[0]
            y += f * torque[1]
            z += f * torque[2]
    return (x, y, z)
