"""All cases as published in one table, and the experiment behind an inference."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.evidence.printed_stop import printed_stop_table
from smallsat.studies.transfer.methods.long_flights import joined_flights


def run(step: Step[Configuration]) -> Tables:
    """Join the numbers of intervals; compare the stopped runs with Table 4."""
    shards = [f"as-published-k{intervals}" for intervals in (1, *step.section.intervals)]
    tables = {
        f"as-published{suffix}": pd.concat(
            [read_table(step.results / f"{shard}{suffix}") for shard in shards], ignore_index=True
        )
        for suffix in (".csv", ".parquet", "-seconds.csv", "-path.csv")
    }
    flights = [
        read_table(step.results / f"long-flights-k{intervals}.csv")
        for intervals in (1, *step.section.intervals)
    ]
    tables["long-flights.csv"] = joined_flights(flights)
    ledger = Ledger.read(step.published / "values.csv")
    stopped = printed_stop_table(
        tables["as-published.csv"], tables["as-published-path.csv"], ledger
    )
    return tables | {"printed-stop.csv": stopped}
