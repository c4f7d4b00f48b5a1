"""A posterior of the numbers that are not printed, from where the project's long walk ended."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.posterior import walk
from smallsat.studies.rendezvous.model.columns import STATE


def run(step: Step[Cases]) -> Tables:
    """Walk on; the table is the kept walk with the new steps."""
    ledger = Ledger.read(step.published / "values.csv")
    kept = read_table(step.accepted / "posterior.csv")
    states = read_table(step.results / "studies/initial-states.parquet")
    starts = states[STATE].to_numpy()[: step.section.inference.starts]
    walked = walk(step.section, kept, starts, ledger)
    return {"posterior.csv": pd.concat([kept, walked], ignore_index=True)}
