"""Seconds that the jobs of a build took; the command keeps those of this build for others.

Snakemake measures every job into ``logs/<study>/<name>.benchmark.tsv``. A checkout without a build
expects what stands in ``data/accepted/seconds.csv``:

rule
    Name of the rule.
seconds
    Wall-clock seconds of its job, in a build on all cores of the machine.
machine
    Processor and number of cores on which it was measured.
"""

import argparse
import csv
import os
import platform
import re
from pathlib import Path

COLUMNS = ("rule", "seconds", "machine")
_SUFFIX = ".benchmark.tsv"


def last_build(logs: Path) -> dict[str, float]:
    """Seconds of each rule's last job, from the folder of a build's logs."""
    found = {}
    for path in sorted(logs.rglob(f"*{_SUFFIX}")):
        place = path.relative_to(logs).as_posix().removesuffix(_SUFFIX)
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
        if rows:
            found[re.sub("[/-]", "_", place)] = float(rows[0]["s"])
    return found


def accepted(path: Path) -> dict[str, float]:
    """Seconds by rule that stand in a table; none if there is no table."""
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {row["rule"]: float(row["seconds"]) for row in csv.DictReader(file)}


def machine() -> str:
    """Processor and number of cores of this machine."""
    information = Path("/proc/cpuinfo")
    text = information.read_text(encoding="utf-8") if information.exists() else ""
    name = re.search(r"^model name\s*: (.+)$", text, re.MULTILINE)
    return f"{name[1] if name else platform.machine()}, {os.cpu_count()} cores"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``seconds``."""
    parser.add_argument("logs", type=Path, help="folder of the logs of a build")
    parser.add_argument("--output", type=Path, required=True, help="the table")


def main(arguments: argparse.Namespace) -> None:
    """Write the seconds of a build into a table."""
    here = machine()
    with arguments.output.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for rule, seconds in sorted(last_build(arguments.logs).items()):
            table.writerow((rule, f"{seconds:.1f}", here))
