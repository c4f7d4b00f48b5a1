"""The switching function of the shortest flight, and longer flights that coast."""

from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.coasting import coasting


def run(step: Step[Configuration]) -> Tables:
    """Fly in longer times with least propellant."""
    flights, paths = coasting(step.section)
    return {"coasting.csv": flights, "coasting.parquet": paths}
