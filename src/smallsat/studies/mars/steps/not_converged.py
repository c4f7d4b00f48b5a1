"""The runs that are no number, of all steps."""

from smallsat.evidence.not_converged import joined
from smallsat.step import Step, Tables
from smallsat.studies.mars.configuration import Configuration


def run(step: Step[Configuration]) -> Tables:
    """Join what each step lists."""
    return {"not-converged.csv": joined(step.results, ("simulation", "laws"))}
