"""How long the deadzone leaves a CubeSat without thrust in our solves of the listing."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.listing_races import without_thrust
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Solve the races of each such CubeSat on several flights."""
    return {
        "without-thrust.csv": without_thrust(Parameters.from_section(step.section), step.section)
    }
