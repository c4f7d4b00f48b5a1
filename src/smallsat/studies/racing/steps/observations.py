"""All races together, and what is computed for every published value."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import joined
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.evidence.observations import observations, timings

KINDS = ("listing", "optima")


def run(step: Step[Configuration]) -> Tables:
    """Join scenarios and shards, observe, and list what did not converge."""
    shards = [f"random-courses-{shard}" for shard in step.shard.all(step.shard.count)]
    courses = pd.concat([_read(step, shard) for shard in shards], ignore_index=True)
    races = _scenarios(step, "races")
    ledger = Ledger.read(step.published / "values.csv")
    solving = [
        "checks",
        "dynamic-programming",
        "miss-weights",
        "drifting-rings",
        *[f"optima-{scenario}" for scenario in SCENARIOS],
        *shards,
    ]
    return {
        "races.csv": races,
        "rings.csv": _scenarios(step, "rings"),
        "random-courses.csv": courses.sort_values(["number", "rule"], ignore_index=True),
        "observations.csv": observations_table(observations(races, ledger)),
        "not-converged.csv": joined(step.results, solving),
        "timings.csv": timings(step.results),
    }


def _scenarios(step: Step[Configuration], table: str) -> pd.DataFrame:
    names = [f"{kind}-{scenario}-{table}" for scenario in SCENARIOS for kind in KINDS]
    return pd.concat([_read(step, name) for name in names], ignore_index=True)


def _read(step: Step[Configuration], name: str) -> pd.DataFrame:
    return read_table(step.results / f"{name}.csv")
