"""Seconds that the workflow itself takes, from a build that is complete.

Run `make` first. The cold build of the transfer cases goes to a folder of its own under runs/.
"""

import shutil
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
FIGURE = "figures/transfer/fig-25"


def timed(*command: str) -> float:
    """Wall seconds of a command that must succeed."""
    began = time.perf_counter()
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return time.perf_counter() - began


def measure() -> dict[str, float]:
    """Wall seconds of what a person waits for."""
    for path in ROOT.glob(f"{FIGURE}.*"):
        path.unlink()
    one_figure = timed("snakemake", f"{FIGURE}.svg")
    timed("make")  # the new figure goes into the report
    nothing = timed("make")
    # Another seed makes it a what-if run, so that nothing already built is used or touched.
    shutil.rmtree(ROOT / "runs/benchmark", ignore_errors=True)
    names = ("indirect", "as-published", "converged", "multistart")
    cold = timed(
        "snakemake",
        *(f"data/results/transfer/{name}.csv" for name in names),
        "--config",
        "run=benchmark",
        'transfer={"numerics": {"seed": 1}}',
    )
    return {
        "one figure from cached results (s; goal 8)": one_figure,
        "nothing to do (s; goal 4)": nothing,
        "all transfer cases, both runs and the early stops, cold (s; goal 60)": cold,
    }


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name}: {value:.3g}")
