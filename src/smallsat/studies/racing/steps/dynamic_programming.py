"""The optimum over ring speeds, by dynamic programming."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods.dynamic_programming import dynamic_programming
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Find it."""
    table, missing = dynamic_programming(
        Parameters.from_section(step.section), step.section, SCENARIOS[0]
    )
    return {
        "dynamic-programming.csv": table,
        "dynamic-programming-not-converged.csv": not_converged_table(missing),
    }
