"""The plans followed in closed loop."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import tracking
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Follow each plan with a controller."""
    tables, missing = tracking(step.section, Parameters.from_section(step.section))
    return {
        "tracking.csv": tables["tracking"],
        "tracking-flights.parquet": tables["tracking-flights"],
        "tracking-not-converged.csv": not_converged_table(missing),
    }
