"""The initial states of chapters 4 and 5."""

from math import ceil

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table

# Fewer have no quantiles to speak of.
LEAST_STATES = 10


def run(step: Step[MonteCarlo]) -> Tables:
    """Draw them."""
    studies, robustness = step.section.studies, step.section.studies.robustness
    tables = {}
    for name, count, seed in (
        ("initial-states", studies.samples, studies.seed),
        ("disturbed-states", robustness.states, robustness.seed),
    ):
        # States have streams of their own: a share of them is the first of them, unchanged.
        drawn = min(max(LEAST_STATES, ceil(studies.share * count)), count)
        tables[f"studies/{name}.parquet"] = states_table(step.section, drawn, seed)
    return tables
