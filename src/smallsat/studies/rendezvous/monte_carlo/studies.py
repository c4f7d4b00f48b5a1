"""Commands of the studies of many manoeuvres."""

import argparse
import json
from math import ceil
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.errors import report_input_errors
from smallsat.results import read_table, write_table
from smallsat.studies.rendezvous.monte_carlo.cases import (
    BASELINE,
    GROUPS,
    PHASES,
    Case,
    base,
    cases,
)
from smallsat.studies.rendezvous.monte_carlo.initial_states import (
    IN_PLANE,
    Distribution,
    initial_states,
    quadrant,
)
from smallsat.studies.rendezvous.monte_carlo.runs import fly_cases, fly_passages
from smallsat.studies.rendezvous.monte_carlo.shards import merge, part
from smallsat.studies.rendezvous.monte_carlo.tables import (
    KEY,
    PASSAGES,
    PASSAGES_KEY,
    SCHEMA,
    STATE,
    end_columns,
)
from smallsat.studies.rendezvous.parameters import check

# Of chapter 4, and of chapter 5, which has states of its own.
STARTS, DISTURBED_STARTS = "initial-states.parquet", "disturbed-states.parquet"
DOMAIN = "domain.parquet"
# Fewer have no quantiles to speak of.
LEAST_STATES = 10


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="command", required=True)

    states = commands.add_parser("states", help="draw the initial states")
    states.add_argument("--config", required=True, type=json.loads, help="its section, JSON")
    states.add_argument("--folder", required=True, type=Path)

    shard = commands.add_parser("shard", help="fly one part of the manoeuvres of a group")
    shard.add_argument("group", choices=GROUPS)
    shard.add_argument("--shard", required=True, type=int, help="from 1 on")
    shard.add_argument("--shards", required=True, type=int)
    shard.add_argument("--config", required=True, type=json.loads, help="its section, JSON")
    shard.add_argument("--folder", required=True, type=Path, help="of the merged tables")
    shard.add_argument("--output", required=True, type=Path)

    merged = commands.add_parser("merge", help="join the shards of a group")
    merged.add_argument("group", choices=GROUPS)
    merged.add_argument("shards", nargs="+", type=Path)
    merged.add_argument("--output", required=True, type=Path)

    arguments = parser.parse_args()
    {"states": _states, "shard": _shard, "merge": _merge}[arguments.command](arguments)


def _states(arguments: argparse.Namespace) -> None:
    section, folder = arguments.config, arguments.folder
    studies, robustness = section["studies"], section["studies"]["robustness"]
    for name, count, seed in (
        (STARTS, studies["samples"], studies["seed"]),
        (DISTURBED_STARTS, robustness["states"], robustness["seed"]),
    ):
        # States have streams of their own: a share of them is the first of them, unchanged.
        flown = max(LEAST_STATES, ceil(studies["share"] * count))
        write_table(states_table(section, min(flown, count), seed), folder / name)


def _shard(arguments: argparse.Namespace) -> None:
    section, group = arguments.config, arguments.group
    check(section)
    flown = cases(section, group)
    own = []
    for case in flown:
        table = start_table(case, arguments.folder)
        own.append(table.iloc[part(len(table), arguments.shard, arguments.shards)])
    if group == "passages":
        table = fly_passages(section, flown[0], own[0])
    else:
        table = fly_cases(section, flown, own)
    write_table(table, arguments.output)


def _merge(arguments: argparse.Namespace) -> None:
    schema, key = (PASSAGES, PASSAGES_KEY) if arguments.group == "passages" else (SCHEMA, KEY)
    merge(arguments.shards, arguments.output, schema, key)


def states_table(section: Config, count: int, seed: int) -> pd.DataFrame:
    """Initial states of a study, one a row, with distance, m, and quadrant."""
    settings = section["studies"]
    nearest, farthest = (1e3 * distance for distance in settings["distance_km"])
    law = Distribution(nearest, farthest, settings["velocity_deviation_m_s"], IN_PLANE)
    drawn = initial_states(count, seed, law, base(section).mean_motion)
    table = pd.DataFrame({"sample": np.arange(count, dtype=np.int32)})
    table[list(STATE)] = drawn
    table["distance_m"] = np.linalg.norm(drawn[:, :3], axis=1)
    table["quadrant"] = quadrant(drawn).astype(np.int8)
    return table


def start_table(case: Case, folder: Path) -> pd.DataFrame:
    """Where a case begins: an initial state, or where the baseline ended the phase before."""
    if case.phases[0] == 0:
        table = read_table(folder / (STARTS if case.world is None else DISTURBED_STARTS))
    else:
        flown = read_table(folder / DOMAIN)
        before = end_columns(PHASES[case.phases[0] - 1])
        ended = (flown["case"] == BASELINE) & (flown["end_phase"] > case.phases[0])
        table = flown.loc[ended, ["sample", *before]]
        table = table.rename(columns=dict(zip(before, STATE, strict=True)))
    runs = [table.assign(run=np.int32(run)) for run in range(case.runs)]
    return pd.concat(runs, ignore_index=True)


if __name__ == "__main__":
    report_input_errors(main)
