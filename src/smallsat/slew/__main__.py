"""Commands of the slew study. ``python -m smallsat.slew -h``."""

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.evidence.not_converged import not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.results import write_table
from smallsat.slew import beyond, controller_search, environment_study, minimum_time
from smallsat.slew.flights import eigenaxis_flights, replay
from smallsat.slew.observations import observations, timings
from smallsat.slew.onboard import final_orbit_states, third_order, transition_errors
from smallsat.slew.parameters import Parameters, check, parameters
from smallsat.slew.plans import (
    best_plan,
    guidance_model,
    held_table,
    hold,
    least_infeasible,
    node_table,
    resampled,
    summary,
)

REPETITIONS = 10


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.slew", description=__doc__)
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
    for name, table in minimum_time.tables(section, given).items():
        write_table(table, folder / f"{name}.csv")
    bounds = [
        {
            "model": "wheels, gravity gradient" if gradient else "wheels",
            "bound_s": minimum_time.bound_time(given, gradient),
        }
        for gradient in (False, True)
    ]
    write_table(pd.DataFrame(bounds), folder / "bound.csv")


def _plans(section: Config, given: Parameters, folder: Path) -> None:
    model, manoeuvre = guidance_model(given), section["manoeuvre"]
    rows, nodes, replays, seconds, helds, starts = [], [], [], [], [], []
    quarter = manoeuvre["quarter"]
    meshes = {
        "one segment": Mesh(1, quarter["nodes"]),
        "segments": Mesh(quarter["segments"], quarter["segment_nodes"]),
    }
    for kind, mesh in meshes.items():
        name = f"90 deg, {kind}"
        result, found = best_plan(
            model, given, "quarter", given.duration, mesh, section, section["numerics"]["starts"]
        )
        held = hold(model, given, "quarter", result, section) if kind == "segments" else None
        if held is not None:
            helds.append(held_table(model, held, name))
        rows.append(summary(model, given, name, result, found, held))
        starts.append(found.assign(plan=name))
        table = node_table(model, result, given, name)
        nodes.append(table)
        seconds.append({"plan": name, "seconds": result.seconds})
        torques = resampled(table, section["resampling_hz"])
        replays.append(replay(given, section, torques, given.duration).assign(flight=name))

    # The same problem without the gravity gradient, which has a solution by hand.
    free = type(model)(given.inertia, given.torque, given.momentum, given.duration, True, None)
    for kind, mesh in meshes.items():
        name = f"90 deg, no gravity gradient, {kind}"
        result, found = best_plan(free, given, "quarter", given.duration, mesh, section, 3)
        held = hold(free, given, "quarter", result, section) if kind == "segments" else None
        rows.append(summary(free, given, name, result, found, held))

    half = manoeuvre["half"]
    meshes = {
        "one segment": Mesh(1, half["nodes"]),
        "segments": Mesh(half["segments"], half["segment_nodes"]),
    }
    infeasible = []
    for kind, mesh in meshes.items():
        name = f"180 deg, least infeasible, {kind}"
        result, refused = least_infeasible(model, given, "half", given.duration, mesh, section)
        table = node_table(model, result, given, name)
        nodes.append(table)
        seconds.append({"plan": name, "seconds": result.seconds})
        rows.append(summary(model, given, name, result, pd.DataFrame({"converged": [True]}), None))
        infeasible.append(
            {
                "mesh": kind,
                "hard_status": refused.status,
                "hard_converged": refused.converged,
                "soft_status": result.solution.status,
                "miss": result.solution.objective,
            }
        )
        torques = resampled(table, section["resampling_hz"])
        replays.append(replay(given, section, torques, given.duration).assign(flight=name))
    write_table(pd.DataFrame(rows), folder / "plans.csv")
    write_table(pd.DataFrame(infeasible), folder / "infeasible.csv")
    write_table(pd.concat(starts, ignore_index=True), folder / "plan-starts.csv")
    write_table(pd.concat(nodes, ignore_index=True), folder / "plan-nodes.parquet")
    write_table(pd.concat(helds, ignore_index=True), folder / "held-plans.parquet")
    flights = pd.concat(replays, ignore_index=True)
    write_table(flights, folder / "replays.parquet")
    chosen = {
        name: flights[flights["flight"] == name].reset_index(drop=True)
        for name in ("90 deg, segments", "180 deg, least infeasible, segments")
    }
    write_table(transition_errors(chosen), folder / "propagator.csv")
    seconds.append({"plan": "on-board propagator", "seconds": _propagator_seconds(section, given)})
    write_table(pd.DataFrame(seconds), folder / "plan-seconds.csv")


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
    tables = beyond.trade_off(section, given)
    write_table(tables["trade-off"], folder / "trade-off.csv")
    write_table(tables["trade-off-plans"], folder / "trade-off-plans.parquet")
    write_table(tables["trade-off-seconds"], folder / "trade-off-seconds.csv")


def _degradation(section: Config, given: Parameters, folder: Path) -> None:
    write_table(beyond.degradation(section, given), folder / "degradation.csv")


def _observe(section: Config, given: Parameters, folder: Path) -> None:
    found = observations_table(observations(section, given, folder))
    write_table(found, folder / "observations.csv")
    write_table(not_converged_table([]), folder / "not-converged.csv")
    write_table(timings(folder), folder / "timings.csv")


def _tracking(section: Config, given: Parameters, folder: Path) -> None:
    tables = beyond.tracking(section, given)
    write_table(tables["tracking"], folder / "tracking.csv")
    write_table(tables["tracking-flights"], folder / "tracking-flights.parquet")


if __name__ == "__main__":
    report_input_errors(main)
