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
import shlex
import shutil
import subprocess
import sys
import time
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
SHORTEST_SHARD_S, LONGEST_SHARD_S, MOST_SHARDS = 60.0, 600.0, 100
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
    """One size, in so many shards, of which none begins when the limit has passed on the clock."""
    began = time.monotonic()
    folder = FOLDER / str(states)
    shutil.rmtree(folder, ignore_errors=True)
    drawn = step(states, "initial_states")
    shards: list[Cost] = []
    for shard in Shard.all(count):
        if time.monotonic() - began < limit_s:
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


@dataclass(frozen=True)
class Line:
    """Processor seconds as ``each`` for one of something, after ``start`` to begin with.

    ``residual`` is the largest relative departure of a measured size from it.
    """

    each: float
    start: float
    residual: float

    def __call__(self, number: float, starts: int = 1) -> float:
        """Seconds for so many of them, begun so many times."""
        return self.each * number + self.start * starts


def line(rows: Sequence[dict[str, float]], what: str, of: str, starts: str = "") -> Line:
    """The line by least squares of relative residuals, through all sizes that have such seconds."""
    there = [row for row in rows if not math.isnan(row[what])]
    features = np.array([[row[of], row[starts] if starts else 1.0] for row in there])
    seconds = np.array([row[what] for row in there])
    found = np.linalg.lstsq(features / seconds[:, None], np.ones(len(there)), rcond=None)[0]
    return Line(*map(float, found), float(np.max(np.abs(features @ found / seconds - 1.0))))


def lines(rows: Sequence[dict[str, float]]) -> dict[str, Line]:
    """What drawing takes a state, flying a manoeuvre and a shard, and joining a manoeuvre."""
    return {
        "states": line(rows, "states_s", "states"),
        "shards": line(rows, "shards_s", "manoeuvres", "shards_run"),
        "join": line(rows, "join_s", "manoeuvres"),
    }


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
    found, cores = lines(rows), os.cpu_count() or 1
    cases = rows[0]["manoeuvres"] / rows[0]["states"]
    for states in PROJECTED_STATES:
        manoeuvres = cases * states
        work = found["shards"].each * manoeuvres
        for nodes in PROJECTED_NODES:
            slots = nodes * cores

            def flying_s(shards: int, slots: int = slots, number: float = manoeuvres) -> float:
                shard_s = found["shards"](number / shards)
                return math.ceil(shards / slots) * (shard_s + job_s)

            most = min(MOST_SHARDS, max(1, math.floor(work / SHORTEST_SHARD_S)))
            least = min(most, math.ceil(work / LONGEST_SHARD_S))
            shards = min(range(least, most + 1), key=flying_s)
            alone = found["states"](states) + found["join"](manoeuvres)
            hours = (alone + flying_s(shards)) / 3600.0
            yield {
                "states": states,
                "nodes": nodes,
                "cores": slots,
                "shards": shards,
                "shard_s": found["shards"](manoeuvres / shards),
                "hours": hours,
                "node_hours": nodes * hours,
                "price": nodes * hours * price,
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
        "command": shlex.join(["python", "benchmarks/scale.py", *sys.argv[1:]]),
    }


def write(name: str, rows: Sequence[dict[str, float]]) -> None:
    """Write rows as a tracked table, numbers to four digits."""
    TABLES.mkdir(exist_ok=True)
    pd.DataFrame(rows).to_csv(TABLES / name, index=False, float_format="%.4g", lineterminator="\n")


def main() -> None:
    """Measure, project, and write the three tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--limit-min", type=float, default=60.0, help="minutes, after which no shard begins"
    )
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
    for what, fitted in lines(rows).items():
        found |= {f"{what} {name}": f"{value:.3g}" for name, value in vars(fitted).items()}
    with (TABLES / "scale-provenance.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("item", "value"))
        table.writerows(found.items())


if __name__ == "__main__":
    main()
