"""A scenario as the listings solve it; the part is the scenario."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.listing_races import solve_listing
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly it."""
    parameters = Parameters.from_section(step.section)
    flown = solve_listing(parameters, step.section, step.part, parameters.listing)
    return flown.files(f"listing-{step.part}")
