"""Manoeuvres of chapters 4 and 5, from many initial states; the part is their group."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import BASELINE, PHASES, Case, cases
from smallsat.studies.rendezvous.monte_carlo.runs import simulate_cases, simulate_passages
from smallsat.studies.rendezvous.monte_carlo.tables import end_columns


def run(step: Step[MonteCarlo]) -> Tables:
    """Simulate a shard of a group."""
    flown = cases(step.section, step.part)
    tables = [starts(case, lambda name: read_table(step.results / name)) for case in flown]
    own = [table.iloc[list(step.shard.units(len(table)))] for table in tables]
    if step.part == "passages":
        table = simulate_passages(step.section, flown[0], own[0])
    else:
        table = simulate_cases(step.section, flown, own)
    return {f"studies/shards/{step.part}-{step.shard}.parquet": table}


def starts(case: Case, table_of: Callable[[str], pd.DataFrame]) -> pd.DataFrame:
    """Where a case begins: an initial state, or where the baseline ended the phase before."""
    if case.phases[0] == 0:
        name = "initial-states" if case.motion is None else "disturbed-states"
        table = table_of(f"studies/{name}.parquet")
    else:
        flown = table_of("studies/domain.parquet")
        before = end_columns(PHASES[case.phases[0] - 1])
        ended = (flown["case"] == BASELINE) & (flown["end_phase"] > case.phases[0])
        table = flown.loc[ended, ["sample", *before]]
        table = table.rename(columns=dict(zip(before, STATE, strict=True)))
    runs = [table.iloc[: case.states].assign(run=np.int32(run)) for run in range(case.runs)]
    return pd.concat(runs, ignore_index=True)
