"""The configuration in SI units, and the checks that no type can make."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from smallsat.dynamics.units import MINUTE
from smallsat.errors import InputError
from smallsat.studies.racing.configuration import (
    SCENARIOS,
    Configuration,
    CourseRanges,
    Scenario,
)
from smallsat.studies.racing.model.course import COINCIDENT, Course, Ranges, check_course, generate
from smallsat.studies.racing.model.course_file import read_course_file
from smallsat.studies.racing.model.cubesat import CubeSat, cubesat
from smallsat.studies.racing.model.matlab_random import MatlabStream


@dataclass(frozen=True)
class Race:
    """A course and those who fly it."""

    course: Course
    cubesats: tuple[CubeSat, ...]


@dataclass(frozen=True)
class Listing:
    """Numbers of Listings C.C and C.E, and how faithfully they are followed.

    Attributes
    ----------
    duration_multiple
        Multiple of the least possible time, for the guess of the duration.
    costate_bound
        Bound of each initial costate, either way.
    evaluations
        Largest number of function evaluations, differences included.
    deadzone, constraint_deadzone
        Size below which a component of the primer counts as none, in the flight and in the
        constraints.
    final_hamiltonian
        Its target.
    plane
        Largest distance from the ring's plane, m.
    tolerance
        Relative and absolute tolerance of a flight.
    transposed
        Whether the costates' matrix is the right one; the listing's is not.
    ring_sizes
        Whether a ring has its smaller axis as its size; by the listing it has none.
    direct_guess
        Whether a segment begins with the costates and the time of the direct method, where that
        converges; the listing's guess is made of directions.
    """

    duration_multiple: float
    costate_bound: float
    evaluations: int
    deadzone: float
    constraint_deadzone: float
    final_hamiltonian: float
    plane: float
    tolerance: float
    transposed: bool = False
    ring_sizes: bool = False
    direct_guess: bool = False


@dataclass(frozen=True)
class Parameters:
    """What the study needs, in SI units and radians.

    Attributes
    ----------
    mean_motion
        Mean motion of the course's origin, rad/s.
    ranges
        Ranges of the generator of courses.
    scatter
        Standard deviation of the start positions in x and in z, m.
    races
        By scenario.
    plane, pointing
        Largest distance from a ring's plane, m, and angle to its normal, rad, of a passage.
    listing
        What the listings solve with.
    """

    mean_motion: float
    ranges: Ranges
    scatter: float
    races: dict[str, Race]
    plane: float
    pointing: float
    listing: Listing

    @classmethod
    def from_section(cls, section: Configuration) -> "Parameters":
        """Convert the section of the configuration; courses are generated or read here.

        Raises
        ------
        InputError
            Naming the file or key of a course that is none, or of a CubeSat that starts in its
            ring.
        """
        listing, passage = section.listing, section.passage
        ranges = ranges_of(section.course)
        return cls(
            mean_motion=2.0 * np.pi / (section.orbit_period_min * MINUTE),
            ranges=ranges,
            scatter=float(np.sqrt(start_variance(section))),
            races={name: _race(section, name, ranges) for name in SCENARIOS},
            plane=passage.plane_m,
            pointing=float(np.radians(passage.pointing_deg)),
            listing=Listing(
                duration_multiple=listing.duration_multiple,
                costate_bound=listing.costate_bound,
                evaluations=listing.evaluations,
                deadzone=listing.deadzone,
                constraint_deadzone=listing.constraint_deadzone,
                final_hamiltonian=listing.final_hamiltonian,
                plane=passage.plane_m,
                tolerance=listing.tolerance,
            ),
        )


def ranges_of(course: CourseRanges) -> Ranges:
    """Ranges of the generator, SI units and radians."""
    return Ranges(
        semi_major=course.semi_major_m,
        semi_minor=course.semi_minor_m,
        distance=course.distance_m,
        azimuth=tuple(np.radians(course.azimuth_deg).tolist()),
        elevation=tuple(np.radians(course.elevation_deg).tolist()),
        rings=course.rings,
    )


def start_variance(section: Configuration) -> float:
    """Variance of a start position in x or z, m^2, that reproduces Tables 1 and 3.

    The listing gives the start ring an axis of 250 and calls it three sigma; the draws say that the
    250 is the square, in m^2, of three standard deviations.
    """
    start = section.start
    return start.axis_multiple * section.course.semi_major_m[1] / start.sigma_level**2


def _race(section: Configuration, name: str, ranges: Ranges) -> Race:
    scenario: Scenario = section.scenarios[name]
    key = f"config key 'racing.scenarios.{name}"
    if scenario.course_file:
        course = read_course_file(Path(scenario.course_file))
    else:
        course = generate(MatlabStream(scenario.seed), ranges)
        check_course(course, f"{key}'")
    for craft, values in scenario.cubesats:
        if np.linalg.norm(values.position_m - course.centres[0]) < COINCIDENT:
            raise InputError(
                f"{key}.cubesats.{craft}.position_m': {list(values.position_m)} is the centre of "
                f"ring 1; a CubeSat starts elsewhere, move it"
            )
    return Race(
        course,
        tuple(
            cubesat(craft, values.thrust_m_s2, values.position_m, values.axial)
            for craft, values in scenario.cubesats
        ),
    )


def check(section: Configuration) -> None:
    """Refuse what no type can: speeds that contradict one another, a course that is none.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    speeds = section.dynamic_programming
    if speeds.least_speed >= speeds.largest_speed:
        raise InputError(
            f"config key 'racing.dynamic_programming.least_speed': {speeds.least_speed:g} is "
            f"not allowed; must be less than largest_speed, {speeds.largest_speed:g}"
        )
    Parameters.from_section(section)


def number_of_cubesats(section: Configuration) -> int:
    """How many fly Scenario 1; as many fly Scenario 2."""
    return len(dict(section.scenarios.scenario_1.cubesats))


def rings_of_scenario_1(section: Configuration) -> int:
    """Number of rings that the seed of Scenario 1 gives."""
    return _race(section, SCENARIOS[0], ranges_of(section.course)).course.rings


def rings_of_scenario_2(section: Configuration) -> int:
    """Number of rings that the seed of Scenario 2 gives."""
    return _race(section, SCENARIOS[1], ranges_of(section.course)).course.rings
