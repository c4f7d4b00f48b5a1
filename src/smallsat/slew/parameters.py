"""The configuration's ``slew`` section in SI units, and the checks that a schema cannot express."""

from dataclasses import dataclass

import numpy as np

from smallsat.config import Config
from smallsat.dynamics.kepler_orbits import Elements, Gravity, state_of
from smallsat.errors import InputError

KM = 1000.0
MILLI = 1e-3
# Body rate at both ends of a manoeuvre, rad/s.
REST = (0.0, 0.0, 0.0)
UNIT = 1e-9


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
        Of the panels.
    torque, momentum
        Largest torque, N m, and momentum, N m s, of each wheel.
    duration
        Of the manoeuvre, s.
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
    angles = [orbit[f"{name}_deg"] for name in ("inclination", "raan", "perigee", "anomaly")]
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
            case: np.array(manoeuvre[case]["target_quaternion"], dtype=float)
            for case in ("quarter", "half")
        },
    )


def check(section: Config) -> None:
    """Refuse what the schema cannot: a tensor of no body, a quaternion that is none.

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
