"""The courses, and the start positions from their seeds."""

from smallsat.step import Step, Tables
from smallsat.studies.racing.methods.recovery import recovered, search_days
from smallsat.studies.racing.model.course import course_table
from smallsat.studies.racing.parameters import SCENARIOS, parameters

# Years whose days are tried as seeds of the shuffled race: the listing is of 2025.
YEARS = (2021, 2026)


def run(step: Step) -> Tables:
    """Make them."""
    given = parameters(step.section)
    seeds = {name: step.section["scenarios"][name]["seed"] for name in SCENARIOS}
    return {
        f"course-{scenario}.csv": course_table(race.course)
        for scenario, race in given.races.items()
    } | {
        "start-positions.csv": recovered(given, seeds),
        "days-as-seeds.csv": search_days(given, SCENARIOS[1], *YEARS),
    }
