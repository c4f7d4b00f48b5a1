"""The configuration's ``slew`` section in SI units, and the checks that a schema cannot express."""

from dataclasses import dataclass

import numpy as np

from smallsat.config import Config
from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle
from smallsat.dynamics.orbits.kepler_orbits import Elements, Gravity, state_of
from smallsat.dynamics.units import KM
from smallsat.errors import InputError

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


def panels(section: Config, offset: float | None = None, scale: float = 1.0) -> np.ndarray:
    """Table 5 as an array, shape (6, 7): area, outward normal, centre of pressure.

    Parameters
    ----------
    section
        The configuration's ``slew`` section.
    offset
        How far the long panels' centre of pressure lies off the centre, m; else as in Table 5.
    scale
        Factor of the dimensions, for the printed ones.
    """
    craft = section["spacecraft"]
    size = craft["size_m"]
    length, b, h = (scale * size[name] for name in ("length", "breadth", "height"))
    shift = length / craft["offset_divisor"] if offset is None else offset
    side, end = craft["panel_area_m2"]["side"], craft["panel_area_m2"]["end"]
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


def parameters(section: Config) -> Parameters:
    """Convert the ``slew`` section of the configuration."""
    gravity, orbit, wheels = section["gravity"], section["orbit"], section["wheels"]
    manoeuvre = section["manoeuvre"]
    angles = [
        orbit[f"{name}_deg"]
        for name in ("inclination", "raan", "argument_of_perigee", "true_anomaly")
    ]
    return Parameters(
        gravity=Gravity(
            gravity["mu_km3_s2"] * KM**3, gravity["earth_radius_km"] * KM, gravity["j2"]
        ),
        orbit=Elements(
            orbit["semi_major_axis_km"] * KM, orbit["eccentricity"], *np.radians(angles).tolist()
        ),
        inertia=np.array(section["spacecraft"]["inertia_kg_m2"], dtype=float),
        panels=panels(section),
        drag_coefficient=float(section["spacecraft"]["drag_coefficient"]),
        torque=wheels["torque_mN_m"] * MILLI,
        momentum=wheels["momentum_mN_m_s"] * MILLI,
        duration=float(manoeuvre["duration_s"]),
        initial=np.array(manoeuvre["initial_quaternion"], dtype=float),
        targets={
            case: np.array(manoeuvre[case]["target_quaternion"], dtype=float) for case in CASES
        },
    )


def quarter_angle_deg(config: Config) -> float:
    """Angle of the smaller of the document's two turns, deg: it follows from the quaternions."""
    return parameters(config["slew"]).angle_deg("quarter")


def half_angle_deg(config: Config) -> float:
    """Angle of the larger of the document's two turns, deg: it follows from the quaternions."""
    return parameters(config["slew"]).angle_deg("half")


def check(section: Config) -> Config:
    """Refuse what the schema cannot: no body, quaternion, turn or orbit, and what contradicts.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    tensor = np.array(section["spacecraft"]["inertia_kg_m2"], dtype=float)
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
    manoeuvre = section["manoeuvre"]
    for name, value in (
        ("initial_quaternion", manoeuvre["initial_quaternion"]),
        ("quarter.target_quaternion", manoeuvre["quarter"]["target_quaternion"]),
        ("half.target_quaternion", manoeuvre["half"]["target_quaternion"]),
    ):
        length = float(np.linalg.norm(np.array(value, dtype=float)))
        if abs(length - 1.0) > UNIT:
            raise InputError(
                f"config key 'slew.manoeuvre.{name}': {value} has the length {length:g}; "
                f"must be a unit quaternion, scalar last"
            )
    given = parameters(section)
    for case in CASES:
        if np.radians(given.angle_deg(case)) < NO_TURN:
            raise InputError(
                f"config key 'slew.manoeuvre.{case}.target_quaternion': "
                f"{manoeuvre[case]['target_quaternion']} is the initial attitude; must differ from "
                f"initial_quaternion {manoeuvre['initial_quaternion']}"
            )
    perigee = given.orbit.semi_major_axis * (1.0 - given.orbit.eccentricity)
    if perigee <= given.gravity.radius:
        raise InputError(
            f"config key 'slew.orbit.eccentricity': {given.orbit.eccentricity:g} puts the perigee "
            f"at {perigee / KM:g} km from the Earth's centre; must be more than earth_radius_km "
            f"{given.gravity.radius / KM:g}"
        )
    _check_faces(section["spacecraft"])
    _check_times(section)
    factors = section["environment"]["density_factors"]
    if 1.0 not in factors:
        raise InputError(
            f"config key 'slew.environment.density_factors': {factors} lacks the factor 1, which "
            f"the curves are drawn for; add it"
        )
    return section


def _check_faces(craft: Config) -> None:
    """Table 5 calls four faces alike, so that breadth and height must agree as well."""
    size = craft["size_m"]
    for name, first, second in (
        ("side", "length", "breadth"),
        ("side", "length", "height"),
        ("end", "breadth", "height"),
    ):
        area = craft["panel_area_m2"][name]
        face = size[first] * size[second]
        if abs(area / face - 1.0) > SAME:
            raise InputError(
                f"config key 'slew.spacecraft.panel_area_m2.{name}': {area:g} is not {first} times "
                f"{second} of size_m, {face:g}; set areas and sizes together"
            )


def _check_times(section: Config) -> None:
    duration = section["manoeuvre"]["duration_s"]
    shortest = 1.0 / section["resampling_hz"]
    for key, step in (
        ("onboard.step_s", section["onboard"]["step_s"]),
        ("numerics.step_s", section["numerics"]["step_s"]),
        ("resampling_hz", shortest),
    ):
        if step > duration:
            value = section["resampling_hz"] if key == "resampling_hz" else step
            raise InputError(
                f"config key 'slew.{key}': {value:g} makes steps longer than "
                f"slew.manoeuvre.duration_s {duration:g}; must fit into it"
            )
