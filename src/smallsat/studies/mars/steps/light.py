"""Light and link over the Mars day."""

from smallsat.step import Step, Tables
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.light import day_conditions, summary
from smallsat.studies.mars.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Follow the orbits over the day."""
    intervals = day_conditions(step.section, Parameters.from_section(step.section))
    return {"light-intervals.csv": intervals, "light.csv": summary(step.section, intervals)}
