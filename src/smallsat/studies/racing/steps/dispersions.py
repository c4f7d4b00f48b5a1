"""The optimal plans flown open loop with dispersions."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.dispersions import dispersion_tables
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly them."""
    parameters = Parameters.from_section(step.section)
    rings, flights = dispersion_tables(parameters, step.section)
    return {"dispersions.csv": rings, "dispersed-flights.csv": flights}
