"""How far each constraint is violated in the three cases."""

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.methods import constraint_check
from smallsat.studies.rendezvous.parameters import CASES, law, start_state


def run(step: Step[Configuration]) -> Tables:
    """Look at the constraints at samples and between them."""
    laws = {case: law(step.section, case) for case in CASES[:3]}
    table = constraint_check.table(step.section, laws, start_state(step.section))
    for column in ("start", "sample", "between"):
        table[column] = table[column].round(6) + 0.0
    return {"constraints.csv": table}
