"""Robust MPC of the docking phase: what its tubes take, and what the flown ones keep."""

from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.docking_flights import docking_flights
from smallsat.studies.rendezvous.monte_carlo.tubes import sizes


def run(step: Step[MonteCarlo]) -> Tables:
    """Compute the tubes, and fly."""
    states = read_table(step.results / "studies/disturbed-states.parquet")
    flown = docking_flights(step.section, states)
    return {
        "studies/tube-sizes.csv": sizes(step.section, base(step.section)),
        "studies/tube-constraints.csv": flown["constraints"],
        "studies/tube-ways.parquet": flown["ways"],
    }
