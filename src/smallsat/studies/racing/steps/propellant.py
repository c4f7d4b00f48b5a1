"""What the races cost in propellant."""

from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.propellant import propellant_table


def run(step: Step[Configuration]) -> Tables:
    """Tabulate it."""
    races, sweep = (read_table(step.results / f"{name}.csv") for name in ("races", "thrust-sweep"))
    return {"propellant.csv": propellant_table(races, sweep, step.section.specific_impulses_s)}
