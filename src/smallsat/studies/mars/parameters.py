"""The configuration in SI units, and the checks that no type can make."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from smallsat.dynamics.orbits.circular_orbits import CircularOrbit
from smallsat.dynamics.units import KM
from smallsat.errors import InputError
from smallsat.studies.mars.configuration import AnswerTimes, Configuration, Durations, Orbit
from smallsat.studies.mars.model.gains import Gains, gains

# Gravity of Mars, m^3/s^2: Konopliv et al., Mars high resolution gravity fields from MRO (2011).
MARS_MU = 42828.37e9
# The Mars day as printed, s (mars, Section XIII.B); a what-if run may fly another time.
MARS_DAY = 88620.0
# The printed rates have six significant digits; a rate belongs to an altitude to half of the last.
RATE_AGREES = 1e-6
# Times are multiples of the step to this, s.
SAME_TIME = 1e-6


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

    @classmethod
    def from_section(cls, section: Configuration) -> "Parameters":
        """Convert the section of the configuration."""
        orbits, spacecraft = section.orbits, section.spacecraft
        radius = orbits.mars_radius_km * KM

        def orbit(entry: Orbit) -> CircularOrbit:
            return CircularOrbit(
                radius=radius + entry.altitude_km * KM,
                raan=float(np.radians(entry.raan_deg)),
                inclination=float(np.radians(entry.inclination_deg)),
                argument_of_latitude=float(np.radians(entry.argument_of_latitude_deg)),
                rate=entry.rate_rad_s,
            )

        inertia = np.array(spacecraft.inertia_kg_m2)
        required = section.requirements
        return cls(
            lmo=orbit(orbits.lmo),
            gmo=orbit(orbits.gmo),
            mars_radius=radius,
            inertia=inertia,
            initial_state=np.r_[spacecraft.initial_mrp, np.radians(spacecraft.initial_rate_deg_s)],
            gains=gains(inertia, required.largest_decay_time_s, required.largest_damping_ratio),
            visibility=float(np.radians(section.visibility_deg)),
        )


def check(section: Configuration) -> None:
    """Refuse what no type can: keys that contradict one another, a body that is none.

    A rate must be that of a circular orbit at its altitude, and every time a step of its run.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    moments = section.spacecraft.inertia_kg_m2
    if 2.0 * max(moments) > sum(moments):
        raise InputError(
            f"config key 'mars.spacecraft.inertia_kg_m2': {list(moments)} is of no body; no moment "
            f"may exceed the sum of the other two"
        )
    parameters = Parameters.from_section(section)
    for name, orbit in (("lmo", parameters.lmo), ("gmo", parameters.gmo)):
        rate = float(np.sqrt(MARS_MU / orbit.radius**3))
        if abs(orbit.rate / rate - 1.0) > RATE_AGREES:
            raise InputError(
                f"config key 'mars.orbits.{name}.rate_rad_s': {orbit.rate:g} does not belong to "
                f"altitude_km {section.orbits[name].altitude_km:g}, where a circular orbit has the "
                f"rate {rate:.7g}; set both"
            )
    for key, time, end in _times(section.durations_s, section.answer_times_s):
        steps = time / section.step_s
        if abs(steps - round(steps)) * section.step_s > SAME_TIME or time > end:
            within = f" within the run's {end:g} s" if np.isfinite(end) else ""
            raise InputError(
                f"config key 'mars.{key}': {time:g} is not allowed; must be a multiple of step_s "
                f"{section.step_s:g}{within}"
            )


def _times(durations: Durations, answers: AnswerTimes) -> Iterator[tuple[str, float, float]]:
    """Key, time and end of the run of every time that must be a row of a run, s."""
    for name, duration in durations:
        yield f"durations_s.{name}", duration, np.inf
    for name in ("no_torque", "fixed_torque"):
        yield f"answer_times_s.{name}", answers[name], durations.response
    for name, run in (("pointing", "response"), ("mission", "mission")):
        for place, time in enumerate(answers[name]):
            yield f"answer_times_s.{name}.{place}", time, durations[run]
