"""The configuration's ``slew`` section."""

from typing import Annotated

from annotated_types import Ge, Gt, Interval, Le, Len

from smallsat.quantities import (
    Fraction,
    Inclination,
    Integer,
    NonNegative,
    Number,
    Part,
    Percent,
    Positive,
    Seed,
    Several,
    Vector,
)

Quaternion = Annotated[tuple[Number, Number, Number, Number], Len(4, 4)]
Duration = Annotated[Number, Gt(0), Le(3600)]


class Gravity(Part):
    mu_km3_s2: Positive
    earth_radius_km: Positive
    j2: NonNegative


class Orbit(Part):
    semi_major_axis_km: Positive
    eccentricity: Fraction
    inclination_deg: Inclination
    raan_deg: Number
    argument_of_perigee_deg: Number
    true_anomaly_deg: Number


class Size(Part):
    length: Positive
    breadth: Positive
    height: Positive


class PanelArea(Part):
    """Of the long faces and of the ends."""

    side: Positive
    end: Positive


class Spacecraft(Part):
    """The centre of pressure lies length / divisor off the centre."""

    mass_kg: Positive
    inertia_kg_m2: Annotated[tuple[Vector, Vector, Vector], Len(3, 3)]
    size_m: Size
    panel_area_m2: PanelArea
    offset_divisor: Positive
    drag_coefficient: Positive


class Wheels(Part):
    """Shares are of the healthy wheel's; wheels that lose torque keep their momentum."""

    torque_mN_m: Positive
    momentum_mN_m_s: Positive
    torque_share_pct: Percent
    momentum_share_pct: Annotated[Number, Interval(ge=100, le=100)]


class Turn(Part):
    """To a target, planned on so many nodes, or on so many segments of nodes."""

    target_quaternion: Quaternion
    nodes: Annotated[Integer, Interval(ge=3, le=200)]
    segments: Annotated[Integer, Interval(ge=1, le=60)]
    segment_nodes: Annotated[Integer, Interval(ge=3, le=40)]


class Manoeuvre(Part):
    """The two turns; quaternions have their scalar last."""

    duration_s: Duration
    initial_quaternion: Quaternion
    quarter: Turn
    half: Turn


class Controller(Part):
    damping_ratio: Positive
    natural_frequency_rad_s: Positive


class Onboard(Part):
    step_s: Annotated[Number, Ge(0.001)]


class Environment(Part):
    """Figure 2; offsets of the centre of pressure and factors of the density are bands."""

    attitude_deg: Vector
    duration_days: Annotated[Number, Interval(ge=0.01, le=100)]
    altitudes_km: Several[Positive]
    offsets_mm: Several[Positive]
    density_factors: Several[Positive]


class ControllerSearch(Part):
    """Stiffness and damping on a grid, and from how many of its points the nearest is sought."""

    grid: Annotated[Integer, Interval(ge=3, le=200)]
    starts: Annotated[Integer, Interval(ge=1, le=9)]


class Numerics(Part):
    """Smoothing of the cost is in torque limits; held is the control of a flown plan."""

    # Flights are recorded ten times a second.
    step_s: Annotated[Number, Interval(ge=1e-4, le=0.1)]
    smoothing: Several[Positive]
    held_smoothing: Positive
    starts: Annotated[Integer, Interval(ge=1, le=1000)]
    seed: Seed
    held_intervals: Annotated[Integer, Interval(ge=20, le=2000)]
    controller_search: ControllerSearch


class Tracking(Part):
    natural_frequency_rad_s: Positive
    damping_ratio: Positive
    integral_per_s: Positive
    torque_margin_pct: Percent


class Magnetic(Part):
    """Field on the ground, and dipoles of the spacecraft: its own, and that of a torquer."""

    field_T: Positive
    residual_A_m2: Positive
    torquer_A_m2: Positive


class Beyond(Part):
    magnetic: Magnetic
    trade_off_s: Several[Duration]
    savings_s: Several[Duration]
    stored_momentum_pct: Percent
    torque_shares_pct: Several[Percent]
    inertia_error_pct: Percent
    tracking: Tracking


class Configuration(Part):
    gravity: Gravity
    orbit: Orbit
    spacecraft: Spacecraft
    wheels: Wheels
    manoeuvre: Manoeuvre
    controller: Controller
    onboard: Onboard
    resampling_hz: Positive
    environment: Environment
    numerics: Numerics
    beyond: Beyond
