"""What the searches found, put together."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.strict_yaml import read_yaml
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference import summary
from smallsat.studies.rendezvous.inference.parameter_set import SEARCHES
from smallsat.studies.rendezvous.inference.posterior import marginals
from smallsat.studies.rendezvous.model.columns import STATE


def run(step: Step[Cases]) -> Tables:
    """Summarise them."""
    ledger = Ledger.read(step.published / "values.csv")
    evaluated = pd.concat(
        [read_table(step.results / f"search-{name}.parquet") for name in SEARCHES],
        ignore_index=True,
    )
    states = read_table(step.results / "studies/initial-states.parquet")
    starts = states[STATE].to_numpy()[: step.section.inference.starts]
    return {
        "inference.parquet": evaluated,
        "text.csv": summary.constraints(
            step.section, read_yaml(step.published / "constraints.yaml")
        ),
        "residuals.csv": summary.configured_residuals(step.section, starts, ledger),
        "identified.csv": summary.identified(step.section, evaluated).merge(
            marginals(read_table(step.results / "posterior.csv")), on="parameter"
        ),
        "profiles.csv": summary.profiles(step.section, evaluated),
        "readings.csv": summary.readings(evaluated),
        "trade-offs.csv": summary.trade_offs(evaluated),
        "sets.csv": summary.kept(step.section, evaluated),
        "lp-variants.csv": summary.linear_programs(step.section, ledger),
    }
