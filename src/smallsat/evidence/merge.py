"""Put the verdicts of all studies into one table."""

import argparse
from pathlib import Path

import pandas as pd

from smallsat.evidence.verdicts import TEXT_COLUMNS
from smallsat.results import read_table, write_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``merge``."""
    parser.add_argument("verdicts", nargs="+", type=Path, help="of each study, in their order")
    parser.add_argument("--output", required=True, type=Path)


def main(arguments: argparse.Namespace) -> None:
    """Join the tables in the order given."""
    tables = [read_table(path, TEXT_COLUMNS) for path in arguments.verdicts]
    write_table(pd.concat(tables, ignore_index=True), arguments.output)
