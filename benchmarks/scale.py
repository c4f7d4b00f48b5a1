"""How far one sweep of chapter 4 goes: ever more initial states, measured and projected.

``make scale`` runs it. A size is worked through by the commands of the workflow's own rules, one
process at a time: the initial states, each shard, the join. Seconds are those of the processor, so
that other work on the machine does not count; memory is the largest resident size of any process.
What a cluster adds to each job is taken from what ``make test-slurm`` has written.
"""

import argparse
import csv
import datetime
import json
import math
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.config import as_json, default_config
from smallsat.results import read_table
from smallsat.shard import Shard
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.workflow.seconds import machine

ROOT = Path(__file__).parents[1]
TABLES = ROOT / "data/accepted/pipeline"
FOLDER = ROOT / "runs/scale"
SWEEP = "rendezvous-sweep"
# The quickest of the sweep's cases: the largest size is done within half an hour of one core.
CASES = {"horizons": [15, 30], "sample_times_s": [50.0, 60.0]}
# Initial states, and in how many shards: the document's number, and up to a hundred times as many.
SIZES = {500: 1, 1000: 1, 2000: 1, 5000: 2, 50_000: 20}
# A shard is sized to minutes, and the configuration allows so many of them.
SHORTEST_SHARD_S, LONGEST_SHARD_S, MOST_SHARDS = 60.0, 300.0, 100
# Flown first, so that no size's seconds hold those of the compiler.
WARM_UP = 10
PROJECTED_STATES, PROJECTED_NODES = (5000, 50_000, 1_000_000), (1, 2, 4, 8, 16, 32, 64)


@dataclass(frozen=True)
class Cost:
    """What a process has cost: processor seconds, and its largest resident memory in MiB."""

    seconds: float
    memory_MiB: float


def timed(command: Sequence[str]) -> Cost:
    """Run a command of the project to its end, without what it prints."""
    process = subprocess.Popen(
        [sys.executable, "-m", "smallsat", *command], cwd=ROOT, stderr=subprocess.DEVNULL
    )
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0)


def step(states: int, name: str, *words: str) -> Cost:
    """Run a step of the sweep for so many initial states, as its rule does."""
    section = default_config(ROOT).rendezvous.only(MonteCarlo)
    text = json.loads(as_json(section))
    text["studies"] |= {"samples": states, "rendezvous": CASES}
    folder = FOLDER / str(states)
    return timed(
        ["run", "rendezvous", name, "--config", json.dumps(text), "--results", str(folder), *words]
    )


def measured(states: int, count: int, limit_s: float) -> dict[str, float]:
    """One size, in so many shards; no shard begins once they have taken the limit together."""
    folder = FOLDER / str(states)
    shutil.rmtree(folder, ignore_errors=True)
    drawn = step(states, "initial_states")
    shards: list[Cost] = []
    for shard in Shard.all(count):
        if sum(one.seconds for one in shards) < limit_s:
            words = ("--part", SWEEP, "--shard", str(shard))
            shards.append(step(states, "manoeuvres", *words))
    whole = len(shards) == count
    last = str(Shard(count, count))
    join = step(states, "joined", "--part", SWEEP, "--shard", last) if whole else None
    flown = sum(
        len(read_table(path)) for path in sorted((folder / "studies/shards").glob("*.parquet"))
    )
    table = folder / f"studies/{SWEEP}.parquet"
    return {
        "states": states,
        "shards": count,
        "shards_run": len(shards),
        "manoeuvres": flown,
        "states_s": drawn.seconds,
        "shards_s": sum(one.seconds for one in shards),
        "longest_shard_s": max(one.seconds for one in shards),
        "shard_MiB": max(one.memory_MiB for one in shards),
        "join_s": join.seconds if join else math.nan,
        "join_MiB": join.memory_MiB if join else math.nan,
        "table_MiB": table.stat().st_size / 2.0**20 if whole else math.nan,
    }


def job_s() -> float:
    """Seconds that a cluster adds to a job, as ``make test-slurm`` has seen them."""
    return float(read_table(TABLES / "slurm.csv")["overhead_s"].iloc[0])


def fit(rows: Sequence[dict[str, float]], what: str) -> tuple[np.ndarray, float]:
    """Seconds as a linear function of the states: coefficients, and the largest relative residual.

    Only sizes that were worked through in full count; all weigh the same in relative terms.
    """
    full = [row for row in rows if row["shards_run"] == row["shards"]]
    states, seconds = (np.array([row[key] for row in full]) for key in ("states", what))
    line = np.polyfit(states, seconds, 1, w=1.0 / seconds)
    return line, float(np.max(np.abs(np.polyval(line, states) / seconds - 1.0)))


def projected(
    rows: Sequence[dict[str, float]], job_s: float, price: float
) -> Iterator[dict[str, float]]:
    """Time and cost of sizes on so many nodes, by the model of ``docs/scale.md``.

    Parameters
    ----------
    rows
        What was measured.
    job_s
        Seconds that the cluster adds to a job.
    price
        Of a node for an hour.
    """
    lines = {what: fit(rows, what)[0] for what in ("states_s", "shards_s", "join_s")}
    cores = os.cpu_count() or 1
    for states in PROJECTED_STATES:
        drawn, work, join = (float(np.polyval(line, states)) for line in lines.values())
        for nodes in PROJECTED_NODES:
            slots = nodes * cores
            most = min(MOST_SHARDS, max(1, math.floor(work / SHORTEST_SHARD_S)))
            shards = min(max(slots, math.ceil(work / LONGEST_SHARD_S)), most)
            rounds = math.ceil(shards / slots)
            seconds = drawn + join + 2.0 * job_s + rounds * (work / shards + job_s)
            yield {
                "states": states,
                "nodes": nodes,
                "cores": slots,
                "shards": shards,
                "shard_s": work / shards,
                "hours": seconds / 3600.0,
                "node_hours": nodes * seconds / 3600.0,
                "price": nodes * seconds / 3600.0 * price,
            }


def provenance(arguments: argparse.Namespace) -> dict[str, str]:
    """Where the numbers come from."""
    commit = subprocess.check_output(
        ["git", "describe", "--always", "--dirty"], cwd=ROOT, text=True
    )
    section = default_config(ROOT).rendezvous
    return {
        "date": datetime.date.today().isoformat(),
        "commit": commit.strip(),
        "machine": machine(),
        "versions": ", ".join(
            [f"Python {platform.python_version()}"]
            + [f"{name} {version(name)}" for name in ("numpy", "numba", "pandas", "pyarrow")]
        ),
        "seed": str(section.studies.seed),
        "cases": json.dumps(CASES),
        "job_s": f"{job_s():g}",
        "price_per_node_hour": f"{arguments.price:g}",
        "command": "make scale",
    }


def write(name: str, rows: Sequence[dict[str, float]]) -> None:
    """Write rows as a tracked table, numbers to four digits."""
    TABLES.mkdir(exist_ok=True)
    pd.DataFrame(rows).to_csv(TABLES / name, index=False, float_format="%.4g", lineterminator="\n")


def main() -> None:
    """Measure, project, and write the three tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--limit-min", type=float, default=30.0, help="processor minutes a size")
    parser.add_argument("--price", type=float, default=0.1, help="of a node for an hour")
    arguments = parser.parse_args()
    measured(WARM_UP, 1, math.inf)
    rows = []
    for states, shards in SIZES.items():
        rows.append(measured(states, shards, 60.0 * arguments.limit_min))
        print(", ".join(f"{key} {value:g}" for key, value in rows[-1].items()), flush=True)
    write("scale.csv", rows)
    write("scale-projected.csv", list(projected(rows, job_s(), arguments.price)))
    found = provenance(arguments)
    for what in ("states_s", "shards_s", "join_s"):
        (slope, start), residual = fit(rows, what)
        found |= {
            f"{what} per 1000 states": f"{1000.0 * slope:.4g}",
            f"{what} for none": f"{start:.4g}",
            f"{what} largest residual": f"{residual:.2g}",
        }
    with (TABLES / "scale-provenance.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("item", "value"))
        table.writerows(found.items())


if __name__ == "__main__":
    main()
