"""Tables on the engine itself."""

import argparse
import json
from pathlib import Path

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.results import write_table
from smallsat.studies.rendezvous.methods import constraint_check, solver_comparison
from smallsat.studies.rendezvous.monte_carlo.initial_states import (
    IN_PLANE,
    Distribution,
    initial_states,
)
from smallsat.studies.rendezvous.parameters import check, law, start_state

KM = 1000.0


def main() -> None:
    """Parse the command line and write the tables."""
    parser = argparse.ArgumentParser(
        prog="python -m smallsat.studies.rendezvous.methods.engine_checks", description=__doc__
    )
    parser.add_argument("--config", required=True, type=json.loads, help="the section, JSON")
    parser.add_argument("--output-folder", required=True, type=Path)
    arguments = parser.parse_args()
    check(arguments.config)
    compare_solvers(arguments.config, arguments.output_folder)
    check_constraints(arguments.config, arguments.output_folder)


def compare_solvers(section: Config, folder: Path) -> None:
    """Write ``solvers.csv`` and ``solver-seconds.csv``: all back ends on sampled programs."""
    size, studies = section["solvers"], section["studies"]
    laws = {"QP": law(section), "1-norm": law(section, "lp")}
    nearest, farthest = (KM * distance for distance in studies["distance_km"])
    spread = Distribution(nearest, farthest, studies["velocity_deviation_m_s"], IN_PLANE)
    starts = initial_states(size["manoeuvres"], studies["seed"], spread, laws["QP"].mean_motion)
    given = solver_comparison.samples(laws, starts, size["programs"])
    answers, seconds = solver_comparison.compare(given)
    write_table(solver_comparison.summary(answers), folder / "solvers.csv")
    write_table(solver_comparison.seconds_summary(seconds), folder / "solver-seconds.csv")


def check_constraints(section: Config, folder: Path) -> None:
    """Write ``constraints.csv``: how far each constraint is violated in the three cases."""
    laws = {case: law(section, case) for case in ("v-bar", "r-bar", "rotating")}
    table = constraint_check.table(section, laws, start_state(section))
    for column in ("start", "sample", "between"):
        table[column] = table[column].round(6) + 0.0
    write_table(table, folder / "constraints.csv")


if __name__ == "__main__":
    report_input_errors(main)
