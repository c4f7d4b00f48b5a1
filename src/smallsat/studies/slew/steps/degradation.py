"""The 180 deg turn over the wheels' torque."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import degradation
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Plan it for each share of the torque."""
    tables, missing = degradation(step.section, Parameters.from_section(step.section))
    return {
        "degradation.csv": tables["degradation"],
        "degradation-not-converged.csv": not_converged_table(missing),
    }
