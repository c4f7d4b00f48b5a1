"""Controllers that give the printed values of the eigenaxis turns."""

from smallsat.evidence.ledger import Ledger
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.controller_search import printed_values, search
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Search them."""
    printed = printed_values(Ledger.read(step.published / "values.csv"))
    parameters = Parameters.from_section(step.section)
    found = search(parameters, printed, step.section.numerics.controller_search)
    return {"controllers.csv": found}
