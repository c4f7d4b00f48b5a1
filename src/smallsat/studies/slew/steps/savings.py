"""What the path and the gravity gradient save of the torque in longer times."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.savings import savings
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Plan the larger turn by both models, with and without gradient."""
    table, missing = savings(step.section, Parameters.from_section(step.section))
    return {"savings.csv": table, "savings-not-converged.csv": not_converged_table(missing)}
