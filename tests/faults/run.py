"""Strike a small build at seeded moments and see whether the next one ends alike: `make faults`.

A moment is a share of the processor time that the undisturbed build uses. The next build is called
once, as a person would, with no option that mends anything.
"""

import argparse
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from random import Random

from tests.faults.builds import (
    TARGETS,
    UNDISTURBED,
    Build,
    gone,
    made,
    moved,
    processes,
    start,
)
from tests.faults.kinds import FAULTS, FULL_DISK, READ_ONLY, Fault, read_only, small_disk
from tests.project_copy import Project, copy_project
from tests.provenance import provenance

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "data/accepted/pipeline/faults.csv"
# What a killed build may take to disappear: a compiled function first runs to its end.
PATIENCE_S = 30.0


@dataclass(frozen=True)
class Outcome:
    """What became of a fault; the columns of the table."""

    number: int
    fault: str
    moment_pct: int | None
    hit: str
    said: str
    left: int
    next: str
    jobs_anew: int
    differ: int
    alike: bool


def strike(project: Project, number: int, fault: Fault, seed: int, whole_s: float) -> Outcome:
    """One fault at its seeded moment, the next build, and how that ended."""
    random = Random(f"{seed}/{number}")
    share = random.uniform(0.05, 0.95) if fault.running else None
    run = f"fault-{number}"
    folder = project.folder / "runs" / run
    with ExitStack() as stack:
        if fault.words == FULL_DISK:
            stack.enter_context(small_disk(folder))
        if share is None:
            shutil.copytree(project.folder / "runs" / UNDISTURBED, folder, symlinks=True)
            build = Build(project, run, subprocess.Popen(["true"], text=True))
        else:
            build = start(project, run)
            while build.spent() < share * whole_s and build.shell.poll() is None:
                time.sleep(0.02)
        struck = build.shell.poll() is None or share is None
        hit = fault.strike(build, random) if struck else "nothing: it had ended"
        said, left = "", 0
        if share is not None and not fault.beside:
            said = _said(*build.ended())
            left = 0 if gone(folder, PATIENCE_S) else len(processes(folder))
        (folder / "filler").unlink(missing_ok=True)
        if fault.words == READ_ONLY:
            with read_only(folder):
                said = _said(*start(project, run).ended())
        status, output = start(project, run).ended()
        if fault.beside:
            said = _said(*build.ended())
        gone(folder, PATIENCE_S)
        left += len(processes(folder))
        different = moved(project, run)
        good = status == 0 and not left and not different
        if not good:
            print(output, *different, sep="\n")
    if good:
        shutil.rmtree(folder, ignore_errors=True)
    return Outcome(
        number,
        fault.words,
        None if share is None else round(100 * share),
        hit,
        said,
        left,
        _said(status, output),
        made(output),
        len(different),
        good,
    )


def _said(status: int, output: str) -> str:
    """How a build ended, in a few words."""
    if status == 0:
        return "done"
    if status < 0 or status > 128:
        return "killed"
    if "Traceback" in output:
        return "traceback"
    return "refused" if "smallsat: " in output else "failed"


def outcomes(project: Project, seed: int, only: list[str]) -> Iterator[Outcome]:
    """All faults in their order, each as it ends."""
    # Compiles, so that the seconds of the undisturbed build are those of the builds to be struck.
    status, output = start(project, "warm-up").ended()
    assert status == 0, output
    whole = start(project, UNDISTURBED)
    spent = 0.0
    while whole.shell.poll() is None:
        spent = max(spent, whole.spent())
        time.sleep(0.05)
    status, output = whole.ended()
    assert status == 0, output
    planned = [fault for fault in FAULTS for _ in range(fault.moments)]
    for number, fault in enumerate(planned, 1):
        if not only or any(word in (fault.words, str(number)) for word in only):
            yield strike(project, number, fault, seed, spent)


def write(path: Path, rows: list[dict[str, object]]) -> None:
    """Write a small table."""
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def main() -> None:
    """Strike all faults; keep the table of a whole series; exit with 1 if one was not survived."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("only", nargs="*", help="numbers or names of faults; all if none is given")
    parser.add_argument("--seed", type=int, default=20261127)
    parser.add_argument("--folder", type=Path, help="where the copy of the project goes")
    arguments = parser.parse_args()
    if os.geteuid() != 0:
        sys.exit("faults: a full disk and a read-only folder need root, to mount them")
    with tempfile.TemporaryDirectory(dir=arguments.folder, prefix="faults-") as place:
        project = copy_project(ROOT, Path(place))
        found = []
        for outcome in outcomes(project, arguments.seed, arguments.only):
            found.append(outcome)
            print(*asdict(outcome).values(), sep=" | ", flush=True)
    if not arguments.only:
        # Before the table is written, which would count as a change of the project.
        facts = provenance("make faults", "snakemake", "numba", "papermill")
        facts |= {"seed": str(arguments.seed), "targets": " ".join(TARGETS)}
        write(TABLE, [asdict(outcome) for outcome in found])
        rows = [{"item": item, "value": value} for item, value in facts.items()]
        write(TABLE.with_stem("faults-provenance"), rows)
    alike = sum(outcome.alike for outcome in found)
    print(f"{alike} of {len(found)} faults: the next build ended by itself, all bytes the same.")
    raise SystemExit(alike != len(found))


if __name__ == "__main__":
    main()
