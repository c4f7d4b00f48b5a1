"""Write down where the configuration of a run departs from the documents' own values."""

import argparse
import json
from pathlib import Path

from smallsat.config import departures
from smallsat.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``changes``."""
    parser.add_argument("--config", required=True, type=json.loads, help="whole configuration")
    parser.add_argument("--default", required=True, type=json.loads, help="the documents' own")
    parser.add_argument("--output", required=True, type=Path)


def main(arguments: argparse.Namespace) -> None:
    """Write the departures as JSON."""
    write_json(departures(arguments.config, arguments.default), arguments.output)
