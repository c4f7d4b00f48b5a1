"""What the searches found, put together."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference import summary
from smallsat.studies.rendezvous.inference.search import SIDES


def run(step: Step[Cases]) -> Tables:
    """Summarise them."""
    ledger = Ledger.read(step.published / "values.csv")
    evaluated = pd.concat(
        [read_table(step.results / f"search-{side}.parquet") for side in SIDES], ignore_index=True
    )
    return {
        "inference.parquet": evaluated,
        "residuals.csv": summary.configured_residuals(step.section, ledger),
        "identified.csv": summary.identified(step.section, evaluated),
        "profiles.csv": summary.profiles(step.section, evaluated),
        "readings.csv": summary.readings(evaluated),
        "ensemble.csv": summary.ensemble(step.section, evaluated),
        "lp-variants.csv": summary.linear_programs(step.section, ledger),
    }
