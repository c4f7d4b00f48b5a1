"""The racing study's solves: the whole course, the listing's problem, random courses.

The document gives 30 to 60 minutes for a new course with four CubeSats.
"""

import time
from pathlib import Path

import numpy as np

from smallsat.config import default_config
from smallsat.studies.racing.methods.course_program import CourseProgram
from smallsat.studies.racing.methods.listing_races import solve_listing
from smallsat.studies.racing.methods.races import solve_optima, whole_leg
from smallsat.studies.racing.model.course import generate
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

ROOT = Path(__file__).parents[1]
COURSES = 20


def measure() -> dict[str, float]:
    """Seconds of building and solving, each in one process on one core."""
    section = default_config(ROOT).racing
    parameters = Parameters.from_section(section)
    race = parameters.races["scenario-1"]
    found: dict[str, float] = {}

    program = CourseProgram(race.course.rings, "state", section.optimum.intervals)
    began = time.perf_counter()
    program.solve(
        whole_leg(race.course, race.cubesats[0]), race.cubesats[0], parameters.mean_motion
    )
    found["build_and_first_solve_s"] = time.perf_counter() - began
    for craft in race.cubesats:
        began = time.perf_counter()
        plan = program.solve(whole_leg(race.course, craft), craft, parameters.mean_motion)
        found[f"whole_course_{craft.name}_s"] = time.perf_counter() - began
        found[f"whole_course_{craft.name}_converged"] = float(plan.converged)

    # Compiled before the clock starts.
    solve_listing(parameters, section, "scenario-1", parameters.listing, ("Miny",))
    for scenario in parameters.races:
        began = time.perf_counter()
        solve_listing(parameters, section, scenario, parameters.listing)
        found[f"listing_{scenario}_s"] = time.perf_counter() - began
        began = time.perf_counter()
        solve_optima(parameters, section, scenario)
        found[f"all_other_solutions_{scenario}_s"] = time.perf_counter() - began

    rings = parameters.races["scenario-2"].course.rings
    program = CourseProgram(rings, "state", section.optimum.intervals)
    began, converged = time.perf_counter(), 0
    for seed in range(COURSES):
        draws = np.random.default_rng(seed)
        course = generate(draws, parameters.ranges, rings)
        craft = CubeSat("any", section.random_courses.thrust_m_s2, (), course.start)
        converged += program.solve(
            whole_leg(course, craft), craft, parameters.mean_motion
        ).converged
    found["random_course_s"] = (time.perf_counter() - began) / COURSES
    found["random_courses_converged_share"] = converged / COURSES
    return found


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name:40} {value:.4g}")
