"""The extremal, and direct solutions near it; the part is the name of the experiment."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods import experiments


def run(step: Step[Configuration]) -> Tables:
    """Solve the cases of one experiment."""
    solved = getattr(experiments, step.part)(step.section)
    return solved.tables(step.part) | {
        f"{step.part}-not-converged.csv": not_converged_table(solved.not_converged)
    }
