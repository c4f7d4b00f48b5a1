"""The five cases of Section 3.6, with linear and nonlinear truth."""

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.simulation.flights import simulate_cases
from smallsat.studies.rendezvous.simulation.nonlinear_flights import simulate_nonlinear


def run(step: Step[Cases]) -> Tables:
    """Simulate them."""
    return simulate_cases(step.section) | {"truth.csv": simulate_nonlinear(step.section)}
