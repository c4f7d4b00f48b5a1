"""What a person waits for, held against its goal. ``make waiting``.

On a machine without other work. Everything is built in a copy of the project, from nothing but
compiled functions. The table is shown in the report's last chapter.
"""

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from tests.project_copy import Project, copy_project
from tests.provenance import provenance

ROOT = Path(__file__).parents[1]

OUTPUT = ROOT / "data/accepted/pipeline/waiting.csv"
FIGURE = "figures/transfer/fig-25"
LONGEST = 3 * 3600  # a command that takes longer is not waited for


@dataclass(frozen=True)
class Wait:
    """A command, the seconds that it should take on two free cores, what has to be there before.

    ``before`` is run first and not timed; then the files of ``anew`` are taken away.
    """

    what: str
    command: str
    goal: float
    before: str = "true"
    anew: str = ""


WAITS = {
    "full": Wait("full rebuild", "snakemake all", 600.0),
    "nothing": Wait("nothing to do", "snakemake all", 2.5, before="snakemake all"),
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


def seconds(project: Project, wait: Wait) -> float:
    """Wall seconds of its command, which must succeed."""
    done = project.run(wait.before, LONGEST)
    for path in project.folder.glob(wait.anew) if wait.anew else ():
        path.unlink()
    began = time.perf_counter()
    if done.returncode == 0:
        done = project.run(wait.command, LONGEST)
    taken = time.perf_counter() - began
    if done.returncode != 0:
        sys.exit(f"waiting: {wait.command}: failed\n{(done.stdout + done.stderr)[-2000:]}")
    return taken


def main() -> None:
    """Time what is asked for, and exchange its rows of the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("waits", nargs="*", metavar="wait", help=f"{', '.join(WAITS)}; else all")
    asked = parser.parse_args().waits or list(WAITS)
    if unknown := [name for name in asked if name not in WAITS]:
        parser.error(f"{unknown[0]}: not one of {', '.join(WAITS)}")
    facts = provenance("make waiting", "snakemake")
    table = pd.read_csv(OUTPUT).set_index("wait") if OUTPUT.exists() else pd.DataFrame()
    rows = table.to_dict("index")
    with tempfile.TemporaryDirectory(prefix="waiting-") as folder:
        project = copy_project(ROOT, Path(folder))
        for name in asked:
            wait = WAITS[name]
            taken = seconds(project, wait)
            print(f"{wait.what}: {taken:.1f} s, goal {wait.goal:g} s", flush=True)
            said = {"what": wait.what, "command": wait.command, "goal_s": wait.goal}
            rows[name] = facts | said | {"seconds": round(taken, 1)}
    found = pd.DataFrame([{"wait": name} | rows[name] for name in WAITS if name in rows])
    found.to_csv(OUTPUT, index=False, lineterminator="\n")


if __name__ == "__main__":
    main()
