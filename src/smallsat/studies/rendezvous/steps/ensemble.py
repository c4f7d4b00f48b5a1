"""Everything that claims rest on, flown with one acceptable set; the part is its number, from 1."""

import pandas as pd

from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.inference.parameter_set import member
from smallsat.studies.rendezvous.monte_carlo.cases import GROUPS, cases
from smallsat.studies.rendezvous.monte_carlo.runs import simulate_cases
from smallsat.studies.rendezvous.steps import constraints, flights, initial_states
from smallsat.studies.rendezvous.steps.manoeuvres import starts

# Groups that no claim of the document rests on.
LEFT_OUT = ("passages", "impulse-bits", "rotation", "orbits")


def run(step: Step[Configuration]) -> Tables:
    """Fly it; the tables are those of the study itself, in a folder of their own."""
    kept = read_table(step.accepted / "sets.csv")
    own = kept.iloc[[int(step.part) - 1]]
    section = member(step.section, own.to_dict("records")[0])
    inner = Step(section, step.results, step.published)
    tables: dict[str, pd.DataFrame] = {
        "set.csv": own,
        **flights.run(inner),
        **constraints.run(inner),
        **initial_states.run(inner),
    }
    for group in GROUPS:
        if group not in LEFT_OUT:
            flown = cases(section, group)
            begun = [starts(case, tables.__getitem__) for case in flown]
            tables[f"studies/{group}.parquet"] = simulate_cases(section, flown, begun)
    return {f"ensemble/{step.part}/{name}": table for name, table in tables.items()}
