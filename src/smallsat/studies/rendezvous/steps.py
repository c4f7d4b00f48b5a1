"""Commands of the rendezvous study. ``python -m smallsat.studies.rendezvous -h``."""

import argparse
import json
from pathlib import Path

import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table, write_table
from smallsat.studies.rendezvous.evidence.monte_carlo_observations import study_observations
from smallsat.studies.rendezvous.evidence.observations import observations, undocked
from smallsat.studies.rendezvous.inference import summary as inferred
from smallsat.studies.rendezvous.inference.search import SIDES, search
from smallsat.studies.rendezvous.parameters import check
from smallsat.studies.rendezvous.simulation.flights import fly_cases
from smallsat.studies.rendezvous.simulation.nonlinear_flights import fly_nonlinear


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, words in {
        "fly": "the five cases of Section 3.6, with linear and nonlinear truth",
        "search": "search parameter sets, the R-bar on one side",
        "infer": "what the searches found, put together",
        "observe": "what is computed for every published value",
    }.items():
        command = commands.add_parser(name, help=words)
        command.add_argument("--config", required=True, type=json.loads, help="the section, JSON")
        command.add_argument("--output-folder", required=True, type=Path)
        if name == "search":
            command.add_argument("--side", required=True, choices=SIDES)
    arguments = parser.parse_args()
    section, folder = arguments.config, arguments.output_folder
    check(section)
    if arguments.command == "search":
        write_table(search(section, arguments.side), folder / f"search-{arguments.side}.parquet")
    else:
        {"fly": _fly, "infer": _infer, "observe": _observe}[arguments.command](section, folder)


def _fly(section: Config, folder: Path) -> None:
    fly_cases(section, folder)
    write_table(fly_nonlinear(section), folder / "truth.csv")


def _infer(section: Config, folder: Path) -> None:
    evaluated = pd.concat(
        [read_table(folder / f"search-{side}.parquet") for side in SIDES], ignore_index=True
    )
    write_table(evaluated, folder / "inference.parquet")
    write_table(inferred.configured_residuals(section), folder / "residuals.csv")
    write_table(inferred.identified(section, evaluated), folder / "identified.csv")
    write_table(inferred.profiles(section, evaluated), folder / "profiles.csv")
    write_table(inferred.readings(evaluated), folder / "readings.csv")
    write_table(inferred.ensemble(section, evaluated), folder / "ensemble.csv")
    write_table(inferred.linear_programs(section), folder / "lp-variants.csv")


def _observe(section: Config, folder: Path) -> None:
    found = observations(section, folder) + study_observations({"rendezvous": section}, folder)
    write_table(observations_table(found), folder / "observations.csv")
    write_table(not_converged_table(undocked(folder)), folder / "not-converged.csv")


if __name__ == "__main__":
    report_input_errors(main)
