"""The larger turn by two models of the body, beside the printed run."""

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.models import compared, fly_models
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Plan and fly it by each."""
    parameters = Parameters.from_section(step.section)
    flights, missing = fly_models(step.section, parameters)
    ledger = Ledger.read(step.published / "values.csv")
    return {
        "models.csv": compared(flights, parameters, ledger),
        "models-flights.parquet": flights,
        "models-not-converged.csv": not_converged_table(missing),
    }
