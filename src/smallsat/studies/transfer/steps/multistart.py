"""The best single polynomials over many starts."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.experiments import multistart


def run(step: Step[Configuration]) -> Tables:
    """Solve from every start."""
    solved, starts = multistart(step.section)
    return solved.tables("multistart") | {
        "multistart-not-converged.csv": not_converged_table(solved.not_converged),
        "multistart-starts.csv": starts,
    }
