"""The configuration's ``racing`` section."""

from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Ge, Interval, Len, Lt
from pydantic import AfterValidator, Field, StrictBool

from smallsat.quantities import (
    Count,
    Differing,
    Integer,
    NonNegative,
    Number,
    Part,
    Positive,
    Seed,
    Several,
    T,
    Text,
    Vector,
)


def _ordered(values: tuple[Any, Any]) -> tuple[Any, Any]:
    if values[0] > values[1]:
        raise ValueError("the first must not exceed the second")
    return values


def _absolute(path: str) -> str:
    """The path of a course file from the root: jobs run elsewhere."""
    if path and not Path(path).is_file():
        raise ValueError(
            f"{'is no file' if Path(path).exists() else 'does not exist'}; give a CSV file's path "
            'from the folder in which snakemake is called, or "" for the course of the seed'
        )
    return path and str(Path(path).resolve())


Ordered = Annotated[tuple[T, T], AfterValidator(_ordered), Len(2, 2)]
Angle = Annotated[Number, Interval(ge=-180, le=180)]
# What ode45 takes: its least is a hundred times the spacing of numbers at one.
Tolerance = Annotated[Number, Interval(ge=2.3e-14, le=1e-3)]
Panels = Annotated[Integer, Interval(ge=8, le=10000)]


class CourseRanges(Part):
    semi_major_m: Ordered[Positive]
    semi_minor_m: Ordered[Positive]
    distance_m: Ordered[Positive]
    azimuth_deg: Ordered[Angle]
    elevation_deg: Ordered[Angle]
    rings: Ordered[Annotated[Integer, Interval(ge=1, le=100)]]


class Start(Part):
    """The variance of a start position is (multiple x largest axis) / level^2."""

    axis_multiple: Positive
    sigma_level: Positive


class Passage(Part):
    """How near to a ring's plane and normal a passage is."""

    plane_m: Positive
    pointing_deg: Positive


class Craft(Part):
    """A CubeSat; an axial one has the thrust along each axis."""

    thrust_m_s2: Positive
    axial: StrictBool
    position_m: Vector


class CubeSats(Part):
    Eeny: Craft
    Meeny: Craft
    Miny: Craft
    Mo: Craft


class Scenario(Part):
    """A course, from its seed or a file, and those who fly it."""

    seed: Annotated[Integer, Interval(ge=0, le=2**32 - 1)]
    course_file: Annotated[Text, AfterValidator(_absolute)]
    cubesats: CubeSats


class Scenarios(Part):
    scenario_1: Scenario = Field(alias="scenario-1")
    scenario_2: Scenario = Field(alias="scenario-2")


SCENARIOS = tuple(str(field.alias) for field in Scenarios.model_fields.values())


class Listing(Part):
    """Listings C.B to C.F; the tolerance is that of the flights, others are flown as variants."""

    duration_multiple: Annotated[Number, Ge(1)]
    costate_bound: Positive
    evaluations: Annotated[Integer, Ge(8)]
    deadzone: NonNegative
    constraint_deadzone: NonNegative
    final_hamiltonian: Annotated[Number, Lt(0)]
    tolerance: Tolerance
    other_tolerances: Differing[Tolerance]


class Optimum(Part):
    """Held controls a segment, and the starts that all have to find the same optimum."""

    intervals: Annotated[Integer, Interval(ge=4, le=200)]
    finer_intervals: Several[Annotated[Integer, Interval(ge=4, le=400)]]
    starts: Annotated[Integer, Interval(ge=1, le=1000)]
    seed: Seed
    indirect_panels: Panels


class DynamicProgramming(Part):
    cubesat: Literal["Eeny", "Meeny", "Miny", "Mo"]
    least_speed: Positive
    largest_speed: Positive
    speeds: Annotated[Integer, Interval(ge=3, le=200)]
    refinements: Annotated[Integer, Interval(ge=1, le=30)]


class RandomCourses(Part):
    courses: Annotated[Integer, Interval(ge=2, le=100000)]
    thrust_m_s2: Positive
    seed: Seed
    positions: Annotated[Integer, Interval(ge=2, le=1000)]


class SpecificImpulses(Part):
    """Of kinds of propulsion, s."""

    cold_gas: Positive
    monopropellant: Positive
    field_emission: Positive


class MissWeights(Part):
    """Weights of a miss, as shares of the largest ring multiplier of this CubeSat's race."""

    cubesat: Literal["Eeny", "Meeny", "Miny", "Mo"]
    threshold_shares: Several[Positive]


class Dispersions(Part):
    """Standard deviations of what differs from the plan: by axis, but for the thrust."""

    flights: Annotated[Integer, Interval(ge=20, le=100000)]
    seed: Seed
    position_m: Positive
    velocity_m_s: Positive
    thrust_pct: Positive
    pointing_deg: Positive


class Animation(Part):
    frames_per_s: Count
    step_s: Positive


class Configuration(Part):
    """The whole section; the orbit is that of the course's origin."""

    orbit_period_min: Positive
    course: CourseRanges
    start: Start
    passage: Passage
    scenarios: Scenarios
    listing: Listing
    optimum: Optimum
    dynamic_programming: DynamicProgramming
    random_courses: RandomCourses
    thrust_sweep_m_s2: Annotated[Several[Positive], Len(2)]
    specific_impulses_s: SpecificImpulses
    miss_weights: MissWeights
    dispersions: Dispersions
    animation: Animation


def course_files(section: Configuration) -> list[str]:
    """Course files that the parameters are read from."""
    return sorted({race.course_file for _, race in section.scenarios} - {""})
