"""A scenario as the listings do it; the part is the scenario."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.races import solve_as_published
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly it."""
    parameters, tolerance = (
        Parameters.from_section(step.section),
        step.section.as_published.tolerance,
    )
    flown = solve_as_published(parameters, tolerance, step.part, parameters.as_published)
    return flown.files(f"as-published-{step.part}")
