"""Commands of the slew study. ``python -m smallsat.studies.slew -h``."""

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table, write_table
from smallsat.studies.slew.evidence.observations import observations, timings
from smallsat.studies.slew.methods import beyond, controller_search, environment_study, minimum_time
from smallsat.studies.slew.methods.bound import bound_time
from smallsat.studies.slew.methods.flights import eigenaxis_flights, replay
from smallsat.studies.slew.methods.plans import HELD_COLUMNS, guidance_model, joined, resampled
from smallsat.studies.slew.methods.turns import (
    INFEASIBLE,
    NODE_COLUMNS,
    START_COLUMNS,
    free_plans,
    turn_plans,
)
from smallsat.studies.slew.model.onboard import final_orbit_states, third_order, transition_errors
from smallsat.studies.slew.model.simulation import COLUMNS
from smallsat.studies.slew.parameters import Parameters, check, parameters

REPETITIONS = 10
# Commands that solve, and list what they did not in a table of their own.
SOLVING = ("minimum-times", "plans", "trade-off", "degradation", "tracking")
FLOWN = ("trade-off-plans", "tracking-flights")


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.studies.slew", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    runs: dict[str, tuple[str, Callable[[Config, Parameters, Path], None]]] = {
        "flights": ("eigenaxis control, on-board propagation, environment", _flights),
        "search": ("controllers that give the printed values", _search),
        "minimum-times": ("least times, by two methods", _minimum_times),
        "plans": ("the document's two minimum-torque plans, flown in the fuller model", _plans),
        "trade-off": ("the 180 deg turn in longer times", _trade_off),
        "degradation": ("the 180 deg turn over the wheels' torque", _degradation),
        "tracking": ("the plans followed in closed loop", _tracking),
        "observe": ("an observation a published value, from the results", _observe),
    }
    for name, (explanation, _) in runs.items():
        command = commands.add_parser(name, help=explanation)
        command.add_argument("--config", required=True, type=json.loads, help="slew section, JSON")
        command.add_argument("--output-folder", required=True, type=Path)
    arguments = parser.parse_args()
    check(arguments.config)
    runs[arguments.command][1](
        arguments.config, parameters(arguments.config), arguments.output_folder
    )


def _flights(section: Config, given: Parameters, folder: Path) -> None:
    flights = eigenaxis_flights(section, given)
    write_table(flights, folder / "flights.parquet")
    write_table(final_orbit_states(section, given), folder / "orbit.csv")
    write_table(environment_study.torque_table(section, given), folder / "environment.csv")


def _search(section: Config, given: Parameters, folder: Path) -> None:
    write_table(controller_search.search(given), folder / "controllers.csv")


def _minimum_times(section: Config, given: Parameters, folder: Path) -> None:
    tables, missing = minimum_time.tables(section, given)
    bounds = [
        {
            "model": "wheels, gravity gradient" if gradient else "wheels",
            "bound_s": bound_time(given, gradient),
        }
        for gradient in (False, True)
    ]
    write_table(pd.DataFrame(bounds), folder / "bound.csv")
    _write(tables, missing, "minimum-times", folder)


def _plans(section: Config, given: Parameters, folder: Path) -> None:
    model = guidance_model(given)
    turns = [
        *turn_plans(model, given, "quarter", section),
        *free_plans(given, section),
        *turn_plans(model, given, "half", section),
    ]
    write_table(pd.DataFrame([turn.row for turn in turns]), folder / "plans.csv")
    infeasible = pd.DataFrame(
        [turn.infeasible for turn in turns if turn.infeasible], columns=list(INFEASIBLE)
    )
    write_table(infeasible, folder / "infeasible.csv")
    starts = [turn.starts for turn in turns if turn.starts is not None]
    write_table(joined(starts, START_COLUMNS), folder / "plan-starts.csv")
    nodes = [turn.nodes for turn in turns if turn.nodes is not None]
    write_table(joined(nodes, NODE_COLUMNS), folder / "plan-nodes.parquet")
    helds = [turn.held for turn in turns if turn.held is not None]
    write_table(joined(helds, HELD_COLUMNS), folder / "held-plans.parquet")

    replays = {
        str(nodes["plan"].iloc[0]): replay(
            given, section, resampled(nodes, section["resampling_hz"]), given.duration
        )
        for nodes in nodes
    }
    flights = [flown.assign(flight=name) for name, flown in replays.items()]
    write_table(joined(flights, (*COLUMNS, "flight")), folder / "replays.parquet")
    chosen = {name: flown for name, flown in replays.items() if name.endswith(", segments")}
    write_table(transition_errors(chosen), folder / "propagator.csv")
    seconds = [{"plan": turn.row["plan"], "seconds": turn.seconds} for turn in turns if turn.timed]
    seconds.append({"plan": "on-board propagator", "seconds": _propagator_seconds(section, given)})
    write_table(pd.DataFrame(seconds), folder / "plan-seconds.csv")
    missing = [row for turn in turns for row in turn.missing]
    write_table(not_converged_table(missing), folder / "plans-unsolved.csv")


def _propagator_seconds(section: Config, given: Parameters) -> float:
    """Seconds of the on-board propagation of the orbit, compiled, as the mean of several runs."""
    step = section["onboard"]["step_s"]
    steps = round(given.duration / step)
    start = np.concatenate(given.state)
    third_order(start, *given.gravity, steps, step)
    began = time.perf_counter()
    for _ in range(REPETITIONS):
        third_order(start, *given.gravity, steps, step)
    return (time.perf_counter() - began) / REPETITIONS


def _trade_off(section: Config, given: Parameters, folder: Path) -> None:
    _write(*beyond.trade_off(section, given), "trade-off", folder)


def _degradation(section: Config, given: Parameters, folder: Path) -> None:
    _write(*beyond.degradation(section, given), "degradation", folder)


def _tracking(section: Config, given: Parameters, folder: Path) -> None:
    _write(*beyond.tracking(section, given), "tracking", folder)


def _observe(section: Config, given: Parameters, folder: Path) -> None:
    found = observations_table(observations(section, given, folder))
    write_table(found, folder / "observations.csv")
    missing = [read_table(folder / f"{run}-unsolved.csv", ("status", "tried")) for run in SOLVING]
    missing = [table for table in missing if len(table)] or missing[:1]
    write_table(pd.concat(missing, ignore_index=True), folder / "not-converged.csv")
    write_table(timings(given, folder), folder / "timings.csv")


def _write(
    tables: dict[str, pd.DataFrame], missing: list[NotConverged], run: str, folder: Path
) -> None:
    """The tables of a run, flights as Parquet, and the cases that it did not solve."""
    for name, table in tables.items():
        suffix = "parquet" if name in FLOWN else "csv"
        write_table(table, folder / f"{name}.{suffix}")
    write_table(not_converged_table(missing), folder / f"{run}-unsolved.csv")


if __name__ == "__main__":
    report_input_errors(main)
