"""Indirect shooting on long flights; the part is the number of intervals."""

from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.long_flights import long_flights


def run(step: Step[Configuration]) -> Tables:
    """Shoot from every guess."""
    return {f"long-flights-k{step.part}.csv": long_flights(step.section, int(step.part))}
