"""What a person waits for, held against its goal. ``make waiting``.

A fresh clone of what is committed is built and tested as the README says, on a machine without
other work. Its environment is made first and not timed. The report's last chapter shows the table.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from benchmarks.yardstick import yardstick
from tests.project_copy import MAKE
from tests.provenance import provenance

ROOT = Path(__file__).parents[1]
OUTPUT = ROOT / "data/accepted/pipeline/waiting.csv"
FIGURE = "figures/transfer/fig-25"


@dataclass(frozen=True)
class Wait:
    """A command, the seconds that it should take on two free cores, and what has to be there.

    ``before`` is run first and not timed; then the files of ``anew`` are taken away.
    """

    what: str
    command: str
    goal: float
    before: str = "true"
    anew: str = ""


WAITS = {
    "full": Wait("full rebuild", "make", 600.0),
    "nothing": Wait("nothing to do", "make", 2.5, before="make"),
    "figure": Wait(
        "one figure from cached results",
        f"snakemake {FIGURE}.svg",
        5.0,
        before=f"snakemake {FIGURE}.svg",
        anew=f"{FIGURE}.*",
    ),
    "quick": Wait("quick configuration", "snakemake all --configfile config/quick.yaml", 180.0),
    "tests": Wait("all tests, their run included", "make test", 720.0),
}


def run(command: str, folder: Path) -> None:
    """Run a line in the clone, as after its environment has been activated."""
    mine = str(Path(sys.executable).parent)
    path = [part for part in os.environ["PATH"].split(os.pathsep) if part != mine]
    environment = {name: value for name, value in os.environ.items() if name not in MAKE}
    environment["PATH"] = os.pathsep.join([str(folder / ".venv/bin"), *path])
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, check=False)
    if done.returncode != 0:
        sys.exit(f"waiting: {command}: failed; everything is still in {folder}")


def seconds(wait: Wait, folder: Path) -> float:
    """Wall seconds of its command."""
    run(wait.before, folder)
    for path in folder.glob(wait.anew) if wait.anew else ():
        path.unlink()
    began = time.perf_counter()
    run(wait.command, folder)
    return time.perf_counter() - began


def with_row(rows: pd.DataFrame, row: dict[str, object]) -> pd.DataFrame:
    """The table with a row more, in place of one of the same wait and commit."""
    again = (rows["wait"] == row["wait"]) & (rows["commit"] == row["commit"])
    return pd.concat([rows[~again], pd.DataFrame([row])], ignore_index=True)[[*rows.columns]]


def main() -> None:
    """Time what is asked for, and add its rows to the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("waits", nargs="*", metavar="wait", help=f"{', '.join(WAITS)}; else all")
    asked = parser.parse_args().waits or list(WAITS)
    if unknown := [name for name in asked if name not in WAITS]:
        parser.error(f"{unknown[0]}: not one of {', '.join(WAITS)}")
    facts = provenance("make waiting", "snakemake")
    folder = Path(tempfile.mkdtemp(prefix="waiting-"))
    subprocess.run(["git", "clone", "--quiet", ROOT, folder], check=True)
    run("make .venv/installed", folder)
    for name in asked:
        wait = WAITS[name]
        pace = yardstick()
        taken = seconds(wait, folder)
        pace = (pace + yardstick()) / 2
        print(
            f"{wait.what}: {taken:.1f} s, goal {wait.goal:g} s; yardstick {pace:.3f} s", flush=True
        )
        said = {"what": wait.what, "command": wait.command, "goal_s": wait.goal}
        found = {"seconds": round(taken, 1), "yardstick_s": round(pace, 3)}
        table = with_row(pd.read_csv(OUTPUT), {"wait": name} | facts | said | found)
        table.to_csv(OUTPUT, index=False, lineterminator="\n")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
