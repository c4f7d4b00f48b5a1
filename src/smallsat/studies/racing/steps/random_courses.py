"""Optimal races on random courses, a shard of them."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods.random_courses import solve_random
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Solve the shard's courses; seconds go to a file of their own."""
    parameters = Parameters.from_section(step.section)
    rings = parameters.races[SCENARIOS[1]].course.rings
    courses = step.shard.units(step.section.random_courses.courses)
    found, seconds, missing = solve_random(parameters, step.section, courses, rings)
    stem = f"random-courses-{step.shard}"
    return {
        f"{stem}.csv": found,
        f"{stem}-seconds.csv": seconds,
        f"{stem}-not-converged.csv": not_converged_table(missing),
    }
