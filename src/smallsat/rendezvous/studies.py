"""Commands of the studies of many manoeuvres. ``python -m smallsat.rendezvous.studies -h``."""

import argparse
import json
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.rendezvous.initial_states import (
    IN_PLANE,
    Distribution,
    initial_states,
    quadrant,
)
from smallsat.rendezvous.parameters import law
from smallsat.rendezvous.shards import merge, part
from smallsat.rendezvous.study_cases import BASELINE, GROUPS, PHASES, Case, cases
from smallsat.rendezvous.study_runs import fly_cases
from smallsat.rendezvous.study_tables import STATE, end_columns
from smallsat.results import read_table, write_table

STARTS, DOMAIN = "initial-states.parquet", "domain.parquet"


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.rendezvous.studies")
    commands = parser.add_subparsers(dest="command", required=True)

    states = commands.add_parser("states", help="draw the initial states")
    states.add_argument("--config", required=True, type=json.loads, help="its section, JSON")
    states.add_argument("--output", required=True, type=Path)

    shard = commands.add_parser("shard", help="fly one part of the manoeuvres of a group")
    shard.add_argument("group", choices=GROUPS)
    shard.add_argument("--shard", required=True, type=int, help="from 1 on")
    shard.add_argument("--shards", required=True, type=int)
    shard.add_argument("--config", required=True, type=json.loads, help="its section, JSON")
    shard.add_argument("--folder", required=True, type=Path, help="of the merged tables")
    shard.add_argument("--output", required=True, type=Path)

    merged = commands.add_parser("merge", help="join the shards of a group")
    merged.add_argument("shards", nargs="+", type=Path)
    merged.add_argument("--output", required=True, type=Path)

    arguments = parser.parse_args()
    {"states": _states, "shard": _shard, "merge": _merge}[arguments.command](arguments)


def _states(arguments: argparse.Namespace) -> None:
    write_table(states_table(arguments.config), arguments.output)


def _shard(arguments: argparse.Namespace) -> None:
    section, folder = arguments.config, arguments.folder
    flown = cases(section, arguments.group)
    starts = [start_table(case, section, folder) for case in flown]
    own = [table.iloc[part(len(table), arguments.shard, arguments.shards)] for table in starts]
    write_table(fly_cases(flown, own), arguments.output)


def _merge(arguments: argparse.Namespace) -> None:
    merge(arguments.shards, arguments.output)


def states_table(section: Config) -> pd.DataFrame:
    """Initial states of the domain study and the sweeps, one a row."""
    settings = section["studies"]
    nearest, farthest = (1e3 * distance for distance in settings["distance_km"])
    drawn = initial_states(
        settings["samples"],
        settings["seed"],
        Distribution(nearest, farthest, settings["velocity_deviation_m_s"], IN_PLANE),
        law(section).mean_motion,
    )
    table = pd.DataFrame({"sample": np.arange(len(drawn), dtype=np.int32)})
    table[list(STATE)] = drawn
    table["distance_m"] = np.linalg.norm(drawn[:, :3], axis=1)
    table["quadrant"] = quadrant(drawn).astype(np.int8)
    return table


def start_table(case: Case, section: Config, folder: Path) -> pd.DataFrame:
    """Where a case begins: an initial state, or where the baseline ended the phase before."""
    if case.phases[0] == 0:
        table = read_table(folder / STARTS)
    else:
        flown = read_table(folder / DOMAIN)
        before = end_columns(PHASES[case.phases[0] - 1])
        ended = (flown["case"] == BASELINE) & (flown["end_phase"] > case.phases[0])
        table = flown.loc[ended, ["sample", *before]]
        table = table.rename(columns=dict(zip(before, STATE, strict=True)))
    return table.assign(run=np.int32(0)).reset_index(drop=True)


if __name__ == "__main__":
    report_input_errors(main)
