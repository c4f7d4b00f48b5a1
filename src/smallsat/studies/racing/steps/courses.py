"""The courses, and the start positions from their seeds."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods.recovery import recovered, search_days
from smallsat.studies.racing.model.course import course_table
from smallsat.studies.racing.parameters import Parameters

# Years whose days are tried as seeds of the shuffled race: the listing is of 2025.
YEARS = (2021, 2026)


def run(step: Step[Configuration]) -> Tables:
    """Make them."""
    parameters = Parameters.from_section(step.section)
    seeds = {name: step.section.scenarios[name].seed for name in SCENARIOS}
    return {
        f"course-{scenario}.csv": course_table(race.course)
        for scenario, race in parameters.races.items()
    } | {
        "start-positions.csv": recovered(parameters, seeds),
        "days-as-seeds.csv": search_days(parameters, SCENARIOS[1], *YEARS),
    }
