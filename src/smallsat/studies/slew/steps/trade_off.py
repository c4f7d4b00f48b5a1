"""The 180 deg turn in longer times."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import trade_off
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Plan it in each of them."""
    tables, missing = trade_off(step.section, Parameters.from_section(step.section))
    return {
        "trade-off.csv": tables["trade-off"],
        "trade-off-plans.parquet": tables["trade-off-plans"],
        "trade-off-seconds.csv": tables["trade-off-seconds"],
        "trade-off-not-converged.csv": not_converged_table(missing),
    }
