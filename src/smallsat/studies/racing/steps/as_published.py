"""A scenario as the listings do it; the part is the scenario."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.methods.races import solve_as_published
from smallsat.studies.racing.parameters import parameters


def run(step: Step) -> Tables:
    """Fly it."""
    given, tolerance = parameters(step.section), step.section["as_published"]["tolerance"]
    flown = solve_as_published(given, tolerance, step.part, given.as_published)
    return flown.files(f"as-published-{step.part}")
