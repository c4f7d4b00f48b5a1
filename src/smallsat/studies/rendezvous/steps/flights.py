"""The five cases of Section 3.6, with linear and nonlinear truth."""

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.simulation.flights import fly_cases
from smallsat.studies.rendezvous.simulation.nonlinear_flights import fly_nonlinear


def run(step: Step) -> Tables:
    """Simulate them."""
    return fly_cases(step.section) | {"truth.csv": fly_nonlinear(step.section)}
