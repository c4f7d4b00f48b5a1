"""Solve the cases of one experiment. ``python -m smallsat.studies.transfer.solve -h``."""

import argparse
import json
from pathlib import Path

from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.results import write_table
from smallsat.studies.transfer.methods import collocation as beyond
from smallsat.studies.transfer.methods import experiments
from smallsat.studies.transfer.methods.experiments import Solved


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(description=__doc__)
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


def _write(results: Path, name: str, solved: Solved) -> None:
    # Seconds go to a file of their own: everything else is the same in every build.
    keys = ["method", "run", "degree", "intervals"]
    timed = solved.cases[solved.cases["residual"].notna()]
    write_table(timed[[*keys, "seconds"]], results / f"{name}-seconds.csv")
    write_table(solved.cases.drop(columns="seconds"), results / f"{name}.csv")
    write_table(solved.trajectories, results / f"{name}.parquet")


def _write_missing(results: Path, name: str, cases: list[NotConverged]) -> None:
    write_table(not_converged_table(cases), results / f"{name}-not-converged.csv")


def _experiment(arguments: argparse.Namespace) -> None:
    solved = getattr(experiments, arguments.command)(arguments.config)
    _write(arguments.results, arguments.command, solved)
    _write_missing(arguments.results, arguments.command, solved.not_converged)


def _as_published(arguments: argparse.Namespace) -> None:
    solved = experiments.as_published(arguments.config, arguments.intervals)
    _write(arguments.results, f"as-published-k{arguments.intervals}", solved)


def _multistart(arguments: argparse.Namespace) -> None:
    solved, starts = experiments.multistart(arguments.config)
    _write(arguments.results, "multistart", solved)
    _write_missing(arguments.results, "multistart", solved.not_converged)
    write_table(starts, arguments.results / "multistart-starts.csv")


def _collocation(arguments: argparse.Namespace) -> None:
    table, missing = beyond.collocation(arguments.config)
    write_table(
        table[["method", "intervals", "seconds"]], arguments.results / "collocation-seconds.csv"
    )
    write_table(table.drop(columns="seconds"), arguments.results / "collocation.csv")
    _write_missing(arguments.results, "collocation", missing)


if __name__ == "__main__":
    report_input_errors(main)
