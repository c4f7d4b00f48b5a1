"""The larger turn with a failed wheel, and with wheels that hold momentum."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.wheel_states import wheel_states
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Find its least time in each state of the wheels."""
    table, missing = wheel_states(step.section, Parameters.from_section(step.section))
    return {
        "wheel-states.csv": table,
        "wheel-states-not-converged.csv": not_converged_table(missing),
    }
