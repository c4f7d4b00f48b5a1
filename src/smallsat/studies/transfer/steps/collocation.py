"""Direct and indirect collocation, the document's future work."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.collocation import collocation


def run(step: Step[Configuration]) -> Tables:
    """Solve by both; seconds go to a file of their own."""
    table, missing = collocation(step.section)
    return {
        "collocation.csv": table.drop(columns="seconds"),
        "collocation-seconds.csv": table[["method", "intervals", "seconds"]],
        "collocation-not-converged.csv": not_converged_table(missing),
    }
