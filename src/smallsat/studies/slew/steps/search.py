"""Controllers that give the printed values of the eigenaxis turns."""

from smallsat.step import Step, Tables
from smallsat.studies.slew.methods.controller_search import search
from smallsat.studies.slew.parameters import parameters


def run(step: Step) -> Tables:
    """Search them."""
    return {"controllers.csv": search(parameters(step.section))}
