"""The configuration's ``racing`` section in SI units, and the checks that a schema cannot make."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from smallsat.config import Config
from smallsat.dynamics.units import MINUTE
from smallsat.errors import InputError
from smallsat.studies.racing.methods.as_published import Settings
from smallsat.studies.racing.model.course import COINCIDENT, Course, Ranges, check_course, generate
from smallsat.studies.racing.model.course_file import read_course_file
from smallsat.studies.racing.model.cubesat import CubeSat, cubesat
from smallsat.studies.racing.model.matlab_random import MatlabStream

SCENARIOS = ("scenario-1", "scenario-2")


@dataclass(frozen=True)
class Race:
    """A course and those who fly it."""

    course: Course
    cubesats: tuple[CubeSat, ...]


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
    as_published
        Settings of the listings.
    """

    mean_motion: float
    ranges: Ranges
    scatter: float
    races: dict[str, Race]
    plane: float
    pointing: float
    as_published: Settings


def parameters(section: Config) -> Parameters:
    """Parameters from the checked section; courses are generated or read here.

    Raises
    ------
    InputError
        Naming the file or key of a course that is none, or of a CubeSat that starts in its ring.
    """
    given, passage = section["as_published"], section["passage"]
    ranges = ranges_of(section)
    return Parameters(
        mean_motion=2.0 * np.pi / (section["orbit_period_min"] * MINUTE),
        ranges=ranges,
        scatter=float(np.sqrt(start_variance({"racing": section}))),
        races={name: _race(section, name, ranges) for name in SCENARIOS},
        plane=passage["plane_m"],
        pointing=float(np.radians(passage["pointing_deg"])),
        as_published=Settings(
            duration_multiple=given["duration_multiple"],
            costate_bound=given["costate_bound"],
            evaluations=given["evaluations"],
            deadzone=given["deadzone"],
            constraint_deadzone=given["constraint_deadzone"],
            final_hamiltonian=given["final_hamiltonian"],
            plane=passage["plane_m"],
            panels=given["panels"],
            first_penalty=given["first_weight"],
        ),
    )


def ranges_of(section: Config) -> Ranges:
    """Ranges of the generator, SI units and radians."""
    course = section["course"]
    return Ranges(
        semi_major=tuple(course["semi_major_m"]),
        semi_minor=tuple(course["semi_minor_m"]),
        distance=tuple(course["distance_m"]),
        azimuth=tuple(np.radians(course["azimuth_deg"]).tolist()),
        elevation=tuple(np.radians(course["elevation_deg"]).tolist()),
        rings=tuple(course["rings"]),
    )


def start_variance(config: Config) -> float:
    """Variance of a start position in x or z, m^2, that reproduces Tables 1 and 3.

    The listing gives the start ring an axis of 250 and calls it three sigma; the draws say that the
    250 is the square, in m^2, of three standard deviations.
    """
    section = config["racing"]
    start, course = section["start"], section["course"]
    return start["axis_multiple"] * course["semi_major_m"][1] / start["sigma_level"] ** 2


def _race(section: Config, scenario: str, ranges: Ranges) -> Race:
    given = section["scenarios"][scenario]
    name = f"config key 'racing.scenarios.{scenario}'"
    if given["course_file"]:
        course = read_course_file(Path(given["course_file"]))
    else:
        course = generate(MatlabStream(given["seed"]), ranges)
        check_course(course, name)
    for key, values in given["cubesats"].items():
        if np.linalg.norm(values["position_m"] - course.centres[0]) < COINCIDENT:
            raise InputError(
                f"{name[:-1]}.cubesats.{key}.position_m': {values['position_m']} is the centre of "
                f"ring 1; a CubeSat starts elsewhere, move it"
            )
    return Race(
        course,
        tuple(
            cubesat(key, values["thrust_m_s2"], values["position_m"], values["axial"])
            for key, values in given["cubesats"].items()
        ),
    )


def course_files(config: Config) -> list[str]:
    """Course files that the parameters are read from."""
    races = config["racing"]["scenarios"].values()
    return sorted({race["course_file"] for race in races} - {""})


def check(section: Config) -> Config:
    """Check what a schema cannot; paths of course files become absolute: jobs run elsewhere.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    for key, (low, high) in section["course"].items():
        if low > high:
            raise InputError(
                f"config key 'racing.course.{key}': [{low:g}, {high:g}] is no range; "
                f"the first must not exceed the second"
            )
    speeds = section["dynamic_programming"]
    if speeds["least_speed"] >= speeds["largest_speed"]:
        raise InputError(
            f"config key 'racing.dynamic_programming.least_speed': {speeds['least_speed']:g} is "
            f"not allowed; must be less than largest_speed, {speeds['largest_speed']:g}"
        )
    for scenario in SCENARIOS:
        given = section["scenarios"][scenario]
        if given["course_file"] and not Path(given["course_file"]).is_file():
            what = "is no file" if Path(given["course_file"]).exists() else "does not exist"
            raise InputError(
                f"config key 'racing.scenarios.{scenario}.course_file': "
                f"'{given['course_file']}' {what}; give a CSV file's path from the folder "
                f'in which snakemake is called, or "" for the course of the seed'
            )
    parameters(section)
    scenarios = {
        name: race
        | {"course_file": str(Path(race["course_file"]).resolve()) if race["course_file"] else ""}
        for name, race in section["scenarios"].items()
    }
    return section | {"scenarios": scenarios}


def number_of_cubesats(config: Config) -> int:
    """How many fly Scenario 1; as many fly Scenario 2."""
    return len(config["racing"]["scenarios"]["scenario-1"]["cubesats"])


def rings_of_scenario_1(config: Config) -> int:
    """Number of rings that the seed of Scenario 1 gives."""
    section = config["racing"]
    return _race(section, "scenario-1", ranges_of(section)).course.rings


def rings_of_scenario_2(config: Config) -> int:
    """Number of rings that the seed of Scenario 2 gives."""
    section = config["racing"]
    return _race(section, "scenario-2", ranges_of(section)).course.rings
