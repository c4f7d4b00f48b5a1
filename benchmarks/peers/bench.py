"""Speed beside peers: every problem, every contender, in one run. ``make bench``.

The repetitions of a problem's contenders take turns, so that whatever else the machine does falls
on all of them. Counted are processor seconds of the solution; what is done once before it (import,
transcription, compilation) is counted beside it. An error is measured, not assumed.
"""

import argparse
import datetime
import importlib
import platform
import statistics
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pandas as pd
from contender import Problem

MODULES = ("mars", "transfer", "slew", "racing", "mpc")
OUTPUT = Path(__file__).parents[2] / "data/accepted/pipeline/bench.csv"


def main() -> None:
    """Measure the problems asked for, print the table, and keep it where all were measured."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problems", nargs="*", help="all, if none is named")
    asked = parser.parse_args().problems
    rows = [
        row for name in asked or MODULES for row in measure(importlib.import_module(name).problem())
    ]
    table = pd.DataFrame(rows).assign(
        machine=machine(), python=platform.python_version(), date=datetime.date.today()
    )
    shown = ["problem", "peer", "version", "setup_s", "median_s", "ratio", "error", "as_accurate"]
    print(table[shown].to_string(index=False, float_format=lambda value: f"{value:.3g}"))
    if not asked:
        table.to_csv(OUTPUT, index=False, float_format="%.4g")


def measure(problem: Problem) -> list[dict[str, Any]]:
    """One row a contender; ``ratio`` is its median over ours, the first's."""
    prepared = [timed(one.prepare) for one in problem.contenders]
    solves = [solve for solve, _ in prepared]
    seconds: list[list[float]] = [[] for _ in solves]
    errors = [0.0] * len(solves)
    for _ in range(problem.repetitions):
        for i, solve in enumerate(solves):
            found, taken = timed(solve)
            seconds[i].append(taken)
            errors[i] = max(errors[i], problem.error(found))
    medians = [statistics.median(taken) for taken in seconds]
    return [
        {
            "problem": problem.name,
            "peer": one.name,
            "package": one.package,
            "version": version(one.package),
            "setup_s": setup,
            "median_s": median,
            "min_s": min(taken),
            "ratio": median / medians[0],
            "measure": problem.measure,
            "error": error,
            "required": problem.required,
            "as_accurate": error <= problem.required,
        }
        for one, (_, setup), taken, median, error in zip(
            problem.contenders, prepared, seconds, medians, errors, strict=True
        )
    ]


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and its processor seconds."""
    began = time.process_time()
    found = call()
    return found, time.process_time() - began


def machine() -> str:
    """The processor's name, and its cores."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0]}, {len(names)} cores" if names else platform.machine()


if __name__ == "__main__":
    main()
