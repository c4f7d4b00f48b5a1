"""How far one sweep of chapter 4 of the rendezvous study goes, from ever more initial states.

``make scale`` runs it, and then ``scale_projection.py`` on what it has measured. A size is worked
through by the commands of the workflow's own rules, one process at a time: the initial states, each
shard, the join. Seconds are those of the processor, so that other work on the machine does not
count; memory is the largest resident size of any process.
"""

import argparse
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
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import pandas as pd

from smallsat.config import as_json, default_config
from smallsat.results import read_table, write_table
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
# Flown first, so that no size's seconds hold those of the compiler.
WARM_UP = 10


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


def provenance() -> dict[str, str]:
    """Where the numbers come from."""
    describe = ["git", "describe", "--always", "--dirty"]
    commit = subprocess.check_output(describe, cwd=ROOT, text=True)
    packages = ("numpy", "numba", "pandas", "pyarrow")
    return {
        "date": datetime.date.today().isoformat(),
        "commit": commit.strip(),
        "machine": machine(),
        "cores": str(os.cpu_count()),
        "versions": ", ".join(
            [f"Python {platform.python_version()}"]
            + [f"{name} {version(name)}" for name in packages]
        ),
        "seed": str(default_config(ROOT).rendezvous.studies.seed),
        "sweep": f"{SWEEP}, {json.dumps(CASES)}",
        "command": shlex.join(["python", "benchmarks/scale.py", *sys.argv[1:]]),
    }


def main() -> None:
    """Measure, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--limit-min", type=float, default=60.0, help="minutes a size, after which no shard begins"
    )
    limit_s = 60.0 * parser.parse_args().limit_min
    measured(WARM_UP, 1, limit_s)
    rows = []
    for states, shards in SIZES.items():
        rows.append(measured(states, shards, limit_s))
        print(", ".join(f"{key} {value:g}" for key, value in rows[-1].items()), flush=True)
    write_table(pd.DataFrame(rows).round(2), TABLES / "scale.csv")
    items = pd.DataFrame(provenance().items(), columns=["item", "value"])
    write_table(items, TABLES / "scale-provenance.csv")


if __name__ == "__main__":
    main()
