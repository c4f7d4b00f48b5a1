"""Commands of the racing study. ``python -m smallsat.studies.racing -h``."""

import argparse
import json
from pathlib import Path

import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table, write_table
from smallsat.studies.racing.evidence.observations import observations, timings
from smallsat.studies.racing.methods import checks, recovery
from smallsat.studies.racing.methods.races import Tables, fly_as_published, fly_optima, variants
from smallsat.studies.racing.methods.random_courses import fly_random
from smallsat.studies.racing.model.course import course_table
from smallsat.studies.racing.parameters import SCENARIOS, Parameters, parameters

# Years whose days are tried as seeds of the shuffled race: the listing is of 2025.
YEARS = (2021, 2026)
# The CubeSat whose variants are flown: all are alike in this.
VARIED = ("Meeny",)
# How the tables end that list the cases without a solution of a command.
NOT_CONVERGED = "-not-converged.csv"


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.studies.racing", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    runs = {
        "courses": ("the courses, and the start positions from their seeds", _courses),
        "as-published": ("a scenario as the listings do it", _as_published),
        "optima": ("a scenario by every well-posed method", _optima),
        "variants": ("the published solve with one thing changed", _variants),
        "checks": ("meshes, starts, thrusts and places", _checks),
        "dynamic-programming": ("the optimum over ring speeds", _dynamic_programming),
        "random": ("a shard of the random courses", _random),
        "observe": ("an observation a published value, from the results", _observe),
    }
    for name, (explanation, _) in runs.items():
        command = commands.add_parser(name, help=explanation)
        command.add_argument(
            "--config", required=True, type=json.loads, help="racing section, JSON"
        )
        command.add_argument("--output-folder", required=True, type=Path)
        command.add_argument("--scenario", choices=SCENARIOS, default=SCENARIOS[0])
        command.add_argument("--shard", type=int, default=0)
        command.add_argument("--shards", type=int, default=1)
    arguments = parser.parse_args()
    given = parameters(arguments.config)
    runs[arguments.command][1](arguments.config, given, arguments.output_folder, arguments)


def _courses(section: Config, given: Parameters, folder: Path, _: argparse.Namespace) -> None:
    for scenario, race in given.races.items():
        write_table(course_table(race.course), folder / f"course-{scenario}.csv")
    seeds = {name: section["scenarios"][name]["seed"] for name in SCENARIOS}
    write_table(recovery.recovered(given, seeds), folder / "start-positions.csv")
    days = recovery.search_days(given, SCENARIOS[1], *YEARS)
    write_table(days, folder / "days-as-seeds.csv")


def _write(tables: Tables, folder: Path, stem: str) -> None:
    for name, table in tables.frames().items():
        write_table(table, folder / f"{stem}-{name}.csv")
    write_table(tables.trajectory(), folder / f"{stem}-trajectories.parquet")


def _as_published(
    section: Config, given: Parameters, folder: Path, arguments: argparse.Namespace
) -> None:
    tolerance = section["as_published"]["tolerance"]
    flown = fly_as_published(given, tolerance, arguments.scenario, given.as_published)
    _write(flown, folder, f"as-published-{arguments.scenario}")


def _optima(
    section: Config, given: Parameters, folder: Path, arguments: argparse.Namespace
) -> None:
    flown = fly_optima(given, section, arguments.scenario)
    _write(flown, folder, f"optima-{arguments.scenario}")
    _write_missing(flown.not_converged, folder, f"optima-{arguments.scenario}")


def _write_missing(cases: list[NotConverged], folder: Path, stem: str) -> None:
    write_table(not_converged_table(cases), folder / f"{stem}{NOT_CONVERGED}")


def _variants(section: Config, given: Parameters, folder: Path, _: argparse.Namespace) -> None:
    write_table(variants(given, section, SCENARIOS[0], VARIED), folder / "variants.csv")


def _checks(section: Config, given: Parameters, folder: Path, _: argparse.Namespace) -> None:
    parts: dict[str, list[checks.Checked]] = {
        "meshes": [checks.mesh_refinement(given, section, name) for name in SCENARIOS],
        "other-starts": [(checks.other_starts(given, section, name), []) for name in SCENARIOS],
        "thrust-sweep": [checks.thrust_sweep(given, section, SCENARIOS[0])],
        "random-positions": [checks.start_positions(given, section, SCENARIOS[1])],
    }
    for name, found in parts.items():
        write_table(
            pd.concat([part[0] for part in found], ignore_index=True), folder / f"{name}.csv"
        )
    missing = [case for found in parts.values() for part in found for case in part[1]]
    _write_missing(missing, folder, "checks")


def _dynamic_programming(
    section: Config, given: Parameters, folder: Path, _: argparse.Namespace
) -> None:
    table, missing = checks.dynamic_programming(given, section, SCENARIOS[0])
    write_table(table, folder / "dynamic-programming.csv")
    _write_missing(missing, folder, "dynamic-programming")


def _random(
    section: Config, given: Parameters, folder: Path, arguments: argparse.Namespace
) -> None:
    rings = given.races[SCENARIOS[1]].course.rings
    found, seconds, missing = fly_random(given, section, arguments.shard, arguments.shards, rings)
    stem = f"random-courses-{arguments.shard}"
    write_table(found, folder / f"{stem}.csv")
    write_table(seconds, folder / f"{stem}-seconds.csv")
    _write_missing(missing, folder, stem)


def _observe(section: Config, given: Parameters, folder: Path, _: argparse.Namespace) -> None:
    races = [
        pd.read_csv(folder / f"{kind}-{name}-races.csv")
        for name in SCENARIOS
        for kind in ("as-published", "optima")
    ]
    table = pd.concat(races, ignore_index=True)
    write_table(table, folder / "races.csv")
    rings = [
        pd.read_csv(folder / f"{kind}-{name}-rings.csv")
        for name in SCENARIOS
        for kind in ("as-published", "optima")
    ]
    write_table(pd.concat(rings, ignore_index=True), folder / "rings.csv")
    shards = sorted(folder.glob("random-courses-[0-9].csv"))
    courses = pd.concat([pd.read_csv(path) for path in shards], ignore_index=True)
    courses = courses.sort_values(["number", "rule"], ignore_index=True)
    write_table(courses, folder / "random-courses.csv")
    write_table(observations_table(observations(table)), folder / "observations.csv")
    missing = [read_table(path, ("tried",)) for path in sorted(folder.glob(f"*{NOT_CONVERGED}"))]
    found = [part for part in missing if len(part)] or [not_converged_table([])]
    write_table(pd.concat(found, ignore_index=True), folder / "not-converged.csv")
    write_table(timings(folder), folder / "timings.csv")


if __name__ == "__main__":
    report_input_errors(main)
