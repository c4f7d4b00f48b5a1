"""The configuration's ``mars`` section in SI units."""

from dataclasses import dataclass

import numpy as np

from smallsat.config import Config
from smallsat.dynamics.circular_orbits import CircularOrbit
from smallsat.mars.gains import Gains, gains

KM = 1000.0


@dataclass(frozen=True)
class Parameters:
    """What the study needs, in SI units and radians.

    Attributes
    ----------
    lmo, gmo
        Orbits of the nano-satellite and of the mothercraft.
    mars_radius
        m.
    inertia
        Principal moments, shape (3,), kg m^2.
    initial_state
        MRPs and body rate at time zero, shape (6,), rad/s.
    gains
        Control gains, from the requirements.
    visibility
        Largest angle between the two positions at which the mothercraft is visible, rad.
    """

    lmo: CircularOrbit
    gmo: CircularOrbit
    mars_radius: float
    inertia: np.ndarray
    initial_state: np.ndarray
    gains: Gains
    visibility: float


def parameters(section: Config) -> Parameters:
    """Convert the ``mars`` section of the configuration."""
    orbits, spacecraft = section["orbits"], section["spacecraft"]
    radius = orbits["mars_radius_km"] * KM

    def orbit(entry: Config) -> CircularOrbit:
        return CircularOrbit(
            radius=radius + entry["altitude_km"] * KM,
            raan=float(np.radians(entry["raan_deg"])),
            inclination=float(np.radians(entry["inclination_deg"])),
            latitude_angle=float(np.radians(entry["latitude_angle_deg"])),
            rate=float(entry["rate_rad_s"]),
        )

    inertia = np.array(spacecraft["inertia_kg_m2"], dtype=float)
    rate = np.radians(np.array(spacecraft["initial_rate_deg_s"], dtype=float))
    requirements = section["requirements"]
    return Parameters(
        lmo=orbit(orbits["lmo"]),
        gmo=orbit(orbits["gmo"]),
        mars_radius=radius,
        inertia=inertia,
        initial_state=np.r_[np.array(spacecraft["initial_mrp"], dtype=float), rate],
        gains=gains(
            inertia, requirements["largest_decay_time_s"], requirements["largest_damping_ratio"]
        ),
        visibility=float(np.radians(section["visibility_deg"])),
    )
