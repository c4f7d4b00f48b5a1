"""Solve the cases of one experiment. ``python -m smallsat.transfer.solve -h``."""

import argparse
import json
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.errors import report_input_errors
from smallsat.results import write_table
from smallsat.transfer import beyond, experiments
from smallsat.transfer.problem import TransferProblem

# A plausible costate for indirect collocation: signs of a spiral outwards, lambda_m between the
# initial and the final value. The document's own guess does not converge there.
COLLOCATION_COSTATE = (-1.0, 0.0, -0.5, 1.0, 0.5)


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.transfer.solve", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in (
        ("indirect", "indirect shooting, single and multiple"),
        ("as-published", "direct shooting from the document's guess, for one number of intervals"),
        ("converged", "direct multiple shooting, converged"),
        ("continuous", "direct multiple shooting with a continuous control"),
        ("multistart", "best single polynomial over many starts"),
        ("collocation", "direct and indirect collocation"),
    ):
        command = commands.add_parser(name, help=text)
        command.add_argument("--config", required=True, type=json.loads)
        command.add_argument("--results", required=True, type=Path)
        if name == "as-published":
            command.add_argument("--intervals", required=True, type=int)
    arguments = parser.parse_args()
    run = {
        "as-published": _as_published,
        "multistart": _multistart,
        "collocation": _collocation,
    }.get(arguments.command, _experiment)
    run(arguments)


def _write(results: Path, name: str, cases: pd.DataFrame, trajectories: pd.DataFrame) -> None:
    # Seconds go to a file of their own: everything else is the same in every build.
    keys = ["method", "run", "degree", "intervals"]
    timed = cases[cases["residual"].notna()]
    write_table(timed[[*keys, "seconds"]], results / f"{name}-seconds.csv")
    write_table(cases.drop(columns="seconds"), results / f"{name}.csv")
    write_table(trajectories, results / f"{name}.parquet")


def _experiment(arguments: argparse.Namespace) -> None:
    experiment = getattr(experiments, arguments.command)
    _write(arguments.results, arguments.command, *experiment(arguments.config))


def _as_published(arguments: argparse.Namespace) -> None:
    cases, trajectories = experiments.as_published(arguments.config, arguments.intervals)
    _write(arguments.results, f"as-published-k{arguments.intervals}", cases, trajectories)


def _multistart(arguments: argparse.Namespace) -> None:
    cases, trajectories, starts = experiments.multistart(arguments.config)
    _write(arguments.results, "multistart", cases, trajectories)
    write_table(starts, arguments.results / "multistart-starts.csv")


def _collocation(arguments: argparse.Namespace) -> None:
    problem = TransferProblem.from_config(arguments.config)
    table = pd.concat(
        [
            beyond.direct_collocation(problem),
            beyond.indirect_collocation(problem, np.array(COLLOCATION_COSTATE)),
        ],
        ignore_index=True,
    )
    write_table(
        table[["method", "intervals", "seconds"]], arguments.results / "collocation-seconds.csv"
    )
    write_table(table.drop(columns="seconds"), arguments.results / "collocation.csv")


if __name__ == "__main__":
    report_input_errors(main)
