"""Commands of the Mars pointing study. ``python -m smallsat.studies.mars -h``."""

import argparse
import json
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.results import write_table
from smallsat.studies.mars.evidence.observations import observations
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.methods.simulation import as_table, day_run, document_runs, finite
from smallsat.studies.mars.model.modes import shares, timeline
from smallsat.studies.mars.parameters import check, parameters


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.studies.mars", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, explanation in (
        ("simulate", "the document's runs, the Mars day, and an observation a published value"),
        ("check", "the document's runs again, by quaternions and an adaptive integrator"),
    ):
        command = commands.add_parser(name, help=explanation)
        command.add_argument("--config", required=True, type=json.loads, help="mars section, JSON")
        command.add_argument("--output-folder", required=True, type=Path)
    arguments = parser.parse_args()
    check(arguments.config)
    {"simulate": _simulate, "check": _check}[arguments.command](
        arguments.config, arguments.output_folder
    )


def _simulate(section: dict, folder: Path) -> None:
    given = parameters(section)
    runs = document_runs(section, given)
    day_record = day_run(section, given)
    unsolved = [
        _overflow(name, record, section["step_s"])
        for name, record in [*runs.items(), ("day", day_record)]
        if not finite(record)
    ]
    tables = [as_table(record).assign(run=name) for name, record in runs.items()]
    write_table(pd.concat(tables, ignore_index=True), folder / "trajectories.parquet")

    day = as_table(day_record)
    columns = ["time_s", "sigma_1", "sigma_2", "sigma_3", "mode"]
    write_table(day[columns], folder / "day.parquet")
    intervals = timeline(day["time_s"].to_numpy(), day["mode"].to_numpy())
    write_table(intervals, folder / "modes.csv")
    write_table(shares(intervals), folder / "mode-shares.csv")

    # All digits, for results that are printed as exact fractions.
    observed = observations_table(observations(section, given, runs))
    write_table(observed, folder / "observations.csv")
    write_table(not_converged_table(unsolved), folder / "not-converged.csv")


def _overflow(name: str, record: np.ndarray, step: float) -> NotConverged:
    """The run as a case without a solution; what it recorded before is worth nothing."""
    time = record[np.flatnonzero(~np.isfinite(record[:, 1:7]).all(axis=1))[0], 0]
    record[:, 1:16] = np.nan
    return NotConverged(
        case=f"the run '{name}'",
        status=f"no number from {time:g} s on: the motion is too fast for the step, or the "
        "reference frame is undefined there",
        tried=f"classical Runge-Kutta steps of {step:g} s, the torque held over a step",
    )


def _check(section: dict, folder: Path) -> None:
    write_table(check_runs(section, parameters(section)), folder / "independent.parquet")


if __name__ == "__main__":
    report_input_errors(main)
