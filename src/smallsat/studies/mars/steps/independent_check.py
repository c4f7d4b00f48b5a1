"""The document's runs again, by quaternions and an adaptive integrator."""

from smallsat.step import Step, Tables
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Integrate everything once more."""
    return {"independent.parquet": check_runs(step.section, Parameters.from_section(step.section))}
