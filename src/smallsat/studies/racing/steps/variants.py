"""The published solve with one thing changed."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.methods.races import variants
from smallsat.studies.racing.parameters import SCENARIOS, parameters

# The CubeSat whose variants are flown: all are alike in this.
VARIED = ("Meeny",)


def run(step: Step) -> Tables:
    """Fly each variant."""
    given = parameters(step.section)
    return {"variants.csv": variants(given, step.section, SCENARIOS[0], VARIED)}
