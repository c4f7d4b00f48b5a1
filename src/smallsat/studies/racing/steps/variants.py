"""Our solve of the listing with one thing changed."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods.listing_races import variants
from smallsat.studies.racing.parameters import Parameters

# The CubeSat whose variants are flown: all are alike in this.
VARIED = ("Meeny",)


def run(step: Step[Configuration]) -> Tables:
    """Fly each variant."""
    parameters = Parameters.from_section(step.section)
    return {"variants.csv": variants(parameters, step.section, SCENARIOS[0], VARIED)}
