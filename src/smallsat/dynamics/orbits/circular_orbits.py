"""Circular orbits in closed form: position, velocity and the Hill frame.

Vectors are in the inertial frame; direction cosine matrices map inertial to frame components, so
that their rows are the axes of the frame. Both are tuples (see `smallsat.dynamics.vectors`).
"""

from math import cos, sin
from typing import NamedTuple

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, cross, scaled, unit


class CircularOrbit(NamedTuple):
    """A circular orbit, in SI units and radians.

    Attributes
    ----------
    radius
        Distance from the planet's centre, m.
    raan
        Right ascension of the ascending node, rad.
    inclination
        Inclination, rad.
    argument_of_latitude
        Argument of latitude at time zero, rad.
    rate
        Orbit rate, rad/s, constant.
    """

    radius: float
    raan: float
    inclination: float
    argument_of_latitude: float
    rate: float


@compiled
def orbit_frame(orbit, time):
    """Orbit frame from the 3-1-3 Euler angles (mars, Eq. 8).

    Parameters
    ----------
    orbit : CircularOrbit
    time : float
        Seconds since time zero; the argument of latitude grows from its initial value.

    Returns
    -------
    tuple, shape (3, 3)
        [ON]: rows are the radial, along-track and orbit-normal directions.
    """
    angle = orbit.argument_of_latitude + orbit.rate * time
    cos_u, sin_u = cos(angle), sin(angle)
    cos_i, sin_i = cos(orbit.inclination), sin(orbit.inclination)
    cos_n, sin_n = cos(orbit.raan), sin(orbit.raan)
    # Directions of the ascending node and, in the orbit's plane, of the point a quarter turn on.
    node = (cos_n, sin_n, 0.0)
    quarter = (-cos_i * sin_n, cos_i * cos_n, sin_i)
    radial = axpy(sin_u, quarter, scaled(cos_u, node))
    along = axpy(cos_u, quarter, scaled(-sin_u, node))
    return radial, along, (sin_i * sin_n, -sin_i * cos_n, cos_i)


@compiled
def position(orbit, time):
    """Inertial position, m, shape (3,) (mars, Eq. 9)."""
    return scaled(orbit.radius, orbit_frame(orbit, time)[0])


@compiled
def velocity(orbit, time):
    """Inertial velocity, m/s, shape (3,) (mars, Eqs. 6 and 10)."""
    return scaled(orbit.radius * orbit.rate, orbit_frame(orbit, time)[1])


@compiled
def hill_frame(r, v):
    """Hill frame [HN], shape (3, 3), from inertial position and velocity (mars, Eq. 12)."""
    radial, normal = unit(r), unit(cross(r, v))
    return radial, cross(normal, radial), normal
