"""From how far off each method still finds the optimum."""

from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.basin import basin


def run(step: Step[Configuration]) -> Tables:
    """Start every method near and far."""
    return {"basin.csv": basin(step.section)}
