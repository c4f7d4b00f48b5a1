"""A scenario by every well-posed method; the part is the scenario."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.races import solve_optima
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Solve it."""
    flown = solve_optima(Parameters.from_section(step.section), step.section, step.part)
    return flown.files(f"optima-{step.part}") | {
        f"optima-{step.part}-not-converged.csv": not_converged_table(flown.not_converged)
    }
