"""The document's runs again, by quaternions and an adaptive integrator."""

from smallsat.step import Step, Tables
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.parameters import parameters


def run(step: Step) -> Tables:
    """Integrate everything once more."""
    return {"independent.parquet": check_runs(step.section, parameters(step.section))}
