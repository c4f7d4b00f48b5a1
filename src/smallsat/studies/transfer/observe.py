"""Gather solved cases and observe values. ``python -m smallsat.studies.transfer.observe -h``."""

import argparse
import json
from pathlib import Path

import pandas as pd

from smallsat.errors import report_input_errors
from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.not_converged import not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table, write_table
from smallsat.studies.transfer.evidence.early_stopping import early_stopping_table
from smallsat.studies.transfer.evidence.observations import observe, seconds

# Experiments whose cases we must solve; what the document's own method leaves unsolved is a result.
OUR_EXPERIMENTS = ("indirect", "converged", "continuous", "multistart", "collocation")


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    gather = commands.add_parser("gather", help="merge as-published shards; compare with Table 4")
    gather.add_argument("--results", required=True, type=Path)
    gather.add_argument("--intervals", required=True, type=json.loads)
    values = commands.add_parser("values", help="observations for the published values")
    values.add_argument("--published", required=True, type=Path)
    values.add_argument("--results", required=True, type=Path)
    arguments = parser.parse_args()
    {"gather": _gather, "values": _observe}[arguments.command](arguments)


def _gather(arguments: argparse.Namespace) -> None:
    results = arguments.results
    shards = [f"as-published-k{k}" for k in arguments.intervals]
    for suffix in (".csv", ".parquet", "-seconds.csv"):
        tables = [read_table(results / f"{shard}{suffix}") for shard in shards]
        write_table(pd.concat(tables, ignore_index=True), results / f"as-published{suffix}")
    cases = read_table(results / "as-published.csv")
    write_table(early_stopping_table(cases), results / "early-stopping.csv")


def _observe(arguments: argparse.Namespace) -> None:
    rows = [
        row
        for row in read_ledger(arguments.published / "values.csv")
        if row["document"] == "transfer"
    ]
    results = arguments.results
    write_table(observations_table(observe(rows, results)), results / "observations.csv")
    missing = [
        read_table(results / f"{name}-not-converged.csv", ("case", "status", "tried"))
        for name in OUR_EXPERIMENTS
    ]
    found = [table for table in missing if len(table)]
    nothing = not_converged_table([])
    write_table(pd.concat(found) if found else nothing, results / "not-converged.csv")
    timings = pd.concat(
        [read_table(results / f"{name}-seconds.csv") for name in ("indirect", "as-published")]
    )
    write_table(seconds(rows, results, timings), results / "timings.csv")


if __name__ == "__main__":
    report_input_errors(main)
