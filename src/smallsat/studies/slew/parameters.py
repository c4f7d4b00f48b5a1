"""The configuration in SI units, and the checks that no type can make."""

from dataclasses import dataclass

import numpy as np

from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle
from smallsat.dynamics.orbits.kepler_orbits import Elements, Gravity, state_of
from smallsat.dynamics.units import KM
from smallsat.errors import InputError
from smallsat.studies.slew.configuration import Configuration, Spacecraft

MILLI = 1e-3
# Body rate at both ends of a manoeuvre, rad/s.
REST = (0.0, 0.0, 0.0)
# Times count from the start of the manoeuvre, s.
START = 0.0
UNIT = 1e-9
# Areas are those of the body's faces to this, and turns smaller than this, rad, are none.
SAME = 1e-9
NO_TURN = 1e-6
CASES = ("quarter", "half")


@dataclass(frozen=True)
class Parameters:
    """What the study needs, in SI units and radians.

    Attributes
    ----------
    gravity, orbit
        The Earth's gravity and the orbit at the start.
    inertia
        Inertia tensor, shape (3, 3), kg m^2.
    panels
        Table 5, shape (6, 7): area, normal, centre of pressure.
    drag_coefficient
        Drag coefficient of the panels.
    torque, momentum
        Largest torque, N m, and momentum, N m s, of each wheel.
    duration
        Duration of the manoeuvre, s.
    initial
        Attitude at the start, quaternion.
    targets
        Attitude at the end, by case.
    """

    gravity: Gravity
    orbit: Elements
    inertia: np.ndarray
    panels: np.ndarray
    drag_coefficient: float
    torque: float
    momentum: float
    duration: float
    initial: np.ndarray
    targets: dict[str, np.ndarray]

    @classmethod
    def from_section(cls, section: Configuration) -> "Parameters":
        """Convert the section of the configuration."""
        gravity, orbit, wheels = section.gravity, section.orbit, section.wheels
        manoeuvre = section.manoeuvre
        angles = (
            orbit.inclination_deg,
            orbit.raan_deg,
            orbit.argument_of_perigee_deg,
            orbit.true_anomaly_deg,
        )
        return cls(
            gravity=Gravity(gravity.mu_km3_s2 * KM**3, gravity.earth_radius_km * KM, gravity.j2),
            orbit=Elements(
                orbit.semi_major_axis_km * KM, orbit.eccentricity, *np.radians(angles).tolist()
            ),
            inertia=np.array(section.spacecraft.inertia_kg_m2),
            panels=panels(section.spacecraft),
            drag_coefficient=section.spacecraft.drag_coefficient,
            torque=wheels.torque_mN_m * MILLI,
            momentum=wheels.momentum_mN_m_s * MILLI,
            duration=manoeuvre.duration_s,
            initial=np.array(manoeuvre.initial_quaternion),
            targets={case: np.array(manoeuvre[case].target_quaternion) for case in CASES},
        )

    @property
    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """Inertial position, m, and velocity, m/s, at the start."""
        return state_of(self.orbit, self.gravity.mu)

    def turn(self, case: str) -> np.ndarray:
        """The turn from the initial attitude to a target, quaternion, shape (4,)."""
        return np.array(error_quaternion(tuple(self.targets[case]), tuple(self.initial)))

    def angle_deg(self, case: str) -> float:
        """Angle of a turn, deg, at most 180."""
        return float(np.degrees(turn_angle(tuple(self.turn(case)))))

    def axis(self, case: str) -> np.ndarray:
        """Axis of a turn in the body, shape (3,); of the turn by at most 180 deg."""
        turn = self.turn(case)
        turn = turn if turn[3] >= 0.0 else -turn
        return turn[:3] / np.linalg.norm(turn[:3])

    @property
    def names(self) -> dict[str, str]:
        """What the turns are called: by their angle, and by their case where that is the same."""
        names = {case: f"{self.angle_deg(case):g} deg" for case in CASES}
        if len(set(names.values())) < len(names):
            names = {case: f"{name}, {case}" for case, name in names.items()}
        return names


def panels(craft: Spacecraft, offset: float | None = None, scale: float = 1.0) -> np.ndarray:
    """Table 5 as an array, shape (6, 7): area, outward normal, centre of pressure.

    Parameters
    ----------
    craft
        The spacecraft.
    offset
        How far the long panels' centre of pressure lies off the centre, m; else as in Table 5.
    scale
        Factor of the dimensions, for the printed ones.
    """
    size = craft.size_m
    length, b, h = scale * size.length, scale * size.breadth, scale * size.height
    shift = length / craft.offset_divisor if offset is None else offset
    side, end = craft.panel_area_m2.side, craft.panel_area_m2.end
    return np.array(
        [
            [side, 1, 0, 0, b / 2, -shift, 0],
            [end, 0, 1, 0, 0, length / 2, 0],
            [side, 0, 0, 1, 0, -shift, h / 2],
            [side, -1, 0, 0, -b / 2, -shift, 0],
            [end, 0, -1, 0, 0, -length / 2, 0],
            [side, 0, 0, -1, 0, -shift, -h / 2],
        ]
    )


def quarter_angle_deg(section: Configuration) -> float:
    """Angle of the smaller of the document's two turns, deg: it follows from the quaternions."""
    return Parameters.from_section(section).angle_deg("quarter")


def half_angle_deg(section: Configuration) -> float:
    """Angle of the larger of the document's two turns, deg: it follows from the quaternions."""
    return Parameters.from_section(section).angle_deg("half")


def check(section: Configuration) -> None:
    """Refuse what no type can: no body, quaternion, turn or orbit, and what contradicts.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    _check_body(np.array(section.spacecraft.inertia_kg_m2))
    manoeuvre = section.manoeuvre
    initial = manoeuvre.initial_quaternion
    for name, value in (
        ("initial_quaternion", initial),
        ("quarter.target_quaternion", manoeuvre.quarter.target_quaternion),
        ("half.target_quaternion", manoeuvre.half.target_quaternion),
    ):
        length = float(np.linalg.norm(value))
        if abs(length - 1.0) > UNIT:
            raise InputError(
                f"config key 'slew.manoeuvre.{name}': {list(value)} has the length {length:g}; "
                f"must be a unit quaternion, scalar last"
            )
    parameters = Parameters.from_section(section)
    for case in CASES:
        if np.radians(parameters.angle_deg(case)) < NO_TURN:
            raise InputError(
                f"config key 'slew.manoeuvre.{case}.target_quaternion': "
                f"{list(manoeuvre[case].target_quaternion)} is the initial attitude; must differ "
                f"from initial_quaternion {list(initial)}"
            )
    perigee = parameters.orbit.semi_major_axis * (1.0 - parameters.orbit.eccentricity)
    if perigee <= parameters.gravity.radius:
        raise InputError(
            f"config key 'slew.orbit.eccentricity': {section.orbit.eccentricity:g} puts the "
            f"perigee at {perigee / KM:g} km from the Earth's centre; must be more than "
            f"earth_radius_km {section.gravity.earth_radius_km:g}"
        )
    _check_faces(section.spacecraft)
    _check_times(section)
    factors = section.environment.density_factors
    if 1.0 not in factors:
        raise InputError(
            f"config key 'slew.environment.density_factors': {list(factors)} lacks the factor 1, "
            f"which the curves are drawn for; add it"
        )


def _check_body(tensor: np.ndarray) -> None:
    key = "config key 'slew.spacecraft.inertia_kg_m2'"
    if not np.array_equal(tensor, tensor.T):
        raise InputError(f"{key}: {tensor.tolist()} is not allowed; must be symmetric")
    moments = np.linalg.eigvalsh(tensor)
    if moments[0] <= 0.0:
        raise InputError(
            f"{key}: has the principal moment {moments[0]:g}; must be positive definite"
        )
    if moments[2] > moments[0] + moments[1]:
        raise InputError(
            f"{key}: principal moments {', '.join(f'{m:g}' for m in moments)} are of no body; "
            f"none may exceed the sum of the other two"
        )


def _check_faces(craft: Spacecraft) -> None:
    """Table 5 calls four faces alike, so that breadth and height must agree as well."""
    for name, first, second in (
        ("side", "length", "breadth"),
        ("side", "length", "height"),
        ("end", "breadth", "height"),
    ):
        area = craft.panel_area_m2[name]
        face = craft.size_m[first] * craft.size_m[second]
        if abs(area / face - 1.0) > SAME:
            raise InputError(
                f"config key 'slew.spacecraft.panel_area_m2.{name}': {area:g} is not {first} times "
                f"{second} of size_m, {face:g}; set areas and sizes together"
            )


def _check_times(section: Configuration) -> None:
    duration = section.manoeuvre.duration_s
    for key, value, step in (
        ("onboard.step_s", section.onboard.step_s, section.onboard.step_s),
        ("numerics.step_s", section.numerics.step_s, section.numerics.step_s),
        ("resampling_hz", section.resampling_hz, 1.0 / section.resampling_hz),
    ):
        if step > duration:
            raise InputError(
                f"config key 'slew.{key}': {value:g} makes steps longer than "
                f"slew.manoeuvre.duration_s {duration:g}; must fit into it"
            )
