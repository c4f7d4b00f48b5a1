"""The environment of nonlinear motion from the configuration, and the target's orbit."""

import numpy as np

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.environment.spherical_harmonics import terms
from smallsat.dynamics.environment.torques import ATMOSPHERE, density
from smallsat.dynamics.orbits.kepler_orbits import Elements, state_of
from smallsat.dynamics.units import KM
from smallsat.studies.rendezvous.configuration import Truth
from smallsat.studies.rendezvous.model.truth import Environment

# The Earth's rate, rad/s: its field and its air turn with it.
EARTH_RATE = 7.2921159e-5


def orbit_radius(mean_motion: float) -> float:
    """Radius, m, of the circular orbit with a mean motion, rad/s, in the central field."""
    return float((egm96.MU / mean_motion**2) ** (1 / 3))


def target_state(settings: Truth, mean_motion: float) -> np.ndarray:
    """Inertial position, m, and velocity, m/s, of the target at time zero, shape (6,).

    The elements are osculating: the orbit is circular in the central field alone, and the other
    terms of the field make it slightly eccentric, by about 1e-3.

    Parameters
    ----------
    settings
        What the configuration says of the truth.
    mean_motion
        Mean motion of the target, rad/s.
    """
    angles = np.radians(
        [settings.inclination_deg, settings.raan_deg, settings.argument_of_latitude_deg]
    )
    elements = Elements(orbit_radius(mean_motion), 0.0, angles[0], angles[1], 0.0, angles[2])
    return np.concatenate(state_of(elements, egm96.MU))


def elliptic_target(
    settings: Truth, circular: float, eccentricity: float, true_anomaly: float
) -> np.ndarray:
    """Inertial state (6,), m and m/s, of a target whose perigee is as high as a circular orbit.

    ``circular`` is the mean motion of that orbit, rad/s; the perigee is in the node.
    """
    tilt, node = np.radians([settings.inclination_deg, settings.raan_deg])
    semi_major = orbit_radius(circular) / (1.0 - eccentricity)
    elements = Elements(semi_major, eccentricity, tilt, node, 0.0, true_anomaly)
    return np.concatenate(state_of(elements, egm96.MU))


def elliptic_mean_motion(circular: float, eccentricity: float) -> float:
    """Mean motion, rad/s, of that target."""
    return float(circular * (1.0 - eccentricity) ** 1.5)


def central(settings: Truth) -> Truth:
    """The truth with the Earth's central field alone."""
    return settings.with_(gravity_degree=0, gravity_order=0, density_factor=0.0)


def box(settings: Truth) -> np.ndarray:
    """Panels of a body, shape (6, 4): area, m^2, and outward normal, by the body's axes."""
    size = settings.body_size_m
    x, y, z = size.radial, size.along, size.normal
    faces = np.column_stack([[y * z, x * z, x * y], np.eye(3)])
    return np.vstack([faces, faces * [1, -1, -1, -1]])


def environment(settings: Truth, mean_motion: float, mass: float) -> Environment:
    """Gravity, air and bodies for `smallsat.studies.rendezvous.model.truth`.

    Parameters
    ----------
    settings
        What the configuration says of the truth.
    mean_motion
        Mean motion of the target, rad/s: gives the height for the air's density.
    mass
        Mass of each body, kg.

    The density and the scale height at the orbit's altitude come from the exponential model of
    `smallsat.dynamics.environment.torques`, times the configuration's factor; the thesis names no
    model.
    """
    radius = orbit_radius(mean_motion)
    altitude = radius - egm96.RADIUS
    row = int(np.searchsorted(ATMOSPHERE[:, 0] * KM, altitude, side="right")) - 1
    coefficient = settings.drag_coefficient
    panels = box(settings)
    return Environment(
        mu=egm96.MU,
        radius=egm96.RADIUS,
        gravity=terms(egm96.COEFFICIENTS, settings.gravity_degree, settings.gravity_order),
        earth_rate=EARTH_RATE,
        earth_angle=float(np.radians(settings.earth_angle_deg)),
        density=float(settings.density_factor * density(altitude, ATMOSPHERE)),
        density_radius=radius,
        scale_height=float(ATMOSPHERE[max(row, 0), 2] * KM),
        panels=np.stack([panels, panels]),
        drag=np.array([coefficient.target, coefficient.chaser]) / mass,
        step=settings.step_s,
    )
