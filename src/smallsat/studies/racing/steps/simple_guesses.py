"""The indirect method from guesses that need no solve."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods.simple_guesses import simple_guesses
from smallsat.studies.racing.parameters import Parameters

# The CubeSat whose listing is varied, too.
GUESSED = "Meeny"


def run(step: Step[Configuration]) -> Tables:
    """Try each guess at each segment."""
    parameters = Parameters.from_section(step.section)
    return {"simple-guesses.csv": simple_guesses(parameters, step.section, SCENARIOS[0], GUESSED)}
