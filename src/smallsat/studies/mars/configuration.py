"""The configuration's ``mars`` section."""

from typing import Annotated

from annotated_types import Ge, Gt, Interval, Le, Len

from smallsat.quantities import (
    Count,
    Inclination,
    Integer,
    NonNegative,
    Number,
    Part,
    Positive,
    Seed,
    Several,
    Vector,
)

Duration = Annotated[Number, Gt(0), Le(1e6)]
AtLeastOne = Annotated[Number, Ge(1)]


class Orbit(Part):
    raan_deg: Number
    inclination_deg: Inclination
    argument_of_latitude_deg: Number
    rate_rad_s: Positive
    altitude_km: Positive


class Orbits(Part):
    mars_radius_km: Positive
    lmo: Orbit
    gmo: Orbit


class Spacecraft(Part):
    """Principal moments in the body frame, and the attitude at time zero."""

    inertia_kg_m2: Annotated[tuple[Positive, Positive, Positive], Len(3, 3)]
    initial_mrp: Vector
    initial_rate_deg_s: Vector


class Requirements(Part):
    largest_decay_time_s: Positive
    largest_damping_ratio: Positive


class FrameDifference(Part):
    """Steps of the finite difference for the rate of the GMO frame."""

    tracking_error: Positive
    control: Positive


class MrpSwitch(Part):
    """Norms at which each run goes over to the shadow set."""

    torque: AtLeastOne
    sun: AtLeastOne
    nadir: AtLeastOne
    gmo: AtLeastOne
    mission: AtLeastOne


class Durations(Part):
    response: Duration
    mission: Duration
    day: Duration


class AnswerTimes(Part):
    """When the document prints its answers; its tables have places for so many."""

    position_lmo: NonNegative
    position_gmo: NonNegative
    hill_frame: NonNegative
    reference_frames: NonNegative
    no_torque: NonNegative
    fixed_torque: NonNegative
    pointing: Annotated[Several[NonNegative], Len(1, 4)]
    mission: Annotated[Several[NonNegative], Len(1, 5)]


class Animation(Part):
    frames_per_s: Count
    mission_step_s: Positive
    day_step_s: Positive


class Regulator(Part):
    """Largest values that the linear-quadratic regulator is asked for, by Bryson's rule."""

    angle_deg: Positive
    rate_deg_s: Positive
    torque_N_m: Positive


class SlidingMode(Part):
    """Rate asked for by attitude, acceleration towards that, and where it becomes smaller."""

    slope_deg_s: Positive
    reaching_deg_s2: Positive
    layer_deg_s: Positive


class Laws(Part):
    """Gains of the laws that the document does not have; all others are the document's."""

    integral_time_s: Positive
    integral_limit_N_m_s: NonNegative
    lqr: Regulator
    sliding_mode: SlidingMode


class Wheels(Part):
    """Limits of each of three reaction wheels along the body's axes."""

    torque_N_m: Positive
    momentum_N_m_s: Positive


class MonteCarlo(Part):
    """Random attitudes at the start, and moments of inertia that the laws do not know."""

    runs: Annotated[Integer, Interval(ge=1, le=10_000)]
    seed: Seed
    inertia_error_pct: Annotated[Number, Interval(ge=0, le=50)]


class Beyond(Part):
    """Pointing errors below ``settled_deg`` count as settled, and as late after ``late_s``."""

    laws: Laws
    wheels: Wheels
    settled_deg: Positive
    late_s: Duration
    monte_carlo: MonteCarlo


class Configuration(Part):
    orbits: Orbits
    spacecraft: Spacecraft
    requirements: Requirements
    visibility_deg: Inclination
    fixed_torque_N_m: Vector
    # Shorter ones fill the memory.
    step_s: Annotated[Number, Ge(0.01)]
    frame_difference_s: FrameDifference
    mrp_switch: MrpSwitch
    durations_s: Durations
    answer_times_s: AnswerTimes
    animation: Animation
    beyond: Beyond
