"""The studies of chapters 4 and 5: seconds over the number of initial states, and memory.

Seconds are those of the processor, so that other work on the machine does not count. Both chapters
at full size are the sum over the jobs of the last build, which went side by side, read from its
benchmark files.
"""

import resource
import time
from pathlib import Path

import pandas as pd

from smallsat.config import default_config
from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.disturbances import disturbed_motion

ROOT = Path(__file__).parents[1]
SAMPLES = (125, 250, 500, 1000)
DISTURBED = 40
# Beginnings of the names of their jobs.
GROUPS = (
    "states",
    "domain",
    "rendezvous-sweep",
    "approach-sweep",
    "docking-sweep",
    "weights",
    "delay",
    "prediction",
    "robustness",
    "passages",
    "summaries",
    "sweep-summary",
    "variant",
)


def measure() -> dict[str, float]:
    """Processor seconds of the baseline from ever more states, and how linear they are."""
    section = default_config(ROOT).rendezvous
    law = base(section)
    states = states_table(section, max(SAMPLES), section.studies.seed)[STATE].to_numpy()
    simulate([law], states[:1])  # compiles
    found, steps = {}, 0
    for count in SAMPLES:
        began = time.process_time()
        flown = simulate([law], states[:count])
        found[f"baseline_{count}_states_s"] = time.process_time() - began
        steps = int(flown.steps.sum())
    last = found[f"baseline_{SAMPLES[-1]}_states_s"]
    found["seconds_per_state_last_over_first"] = (last / SAMPLES[-1]) / (
        found[f"baseline_{SAMPLES[0]}_states_s"] / SAMPLES[0]
    )
    found["programs_per_s"] = steps / last
    motion = disturbed_motion(section, law)
    streams = [stream(1, k) for k in range(DISTURBED + 1)]
    simulate([law], states[:1], motion=motion, generators=streams[-1:])
    began = time.process_time()
    simulate([law], states[:DISTURBED], motion=motion, generators=streams[:DISTURBED])
    found["disturbed_manoeuvres_per_s"] = DISTURBED / (time.process_time() - began)
    found["peak_memory_MiB"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return found | _last_build()


def _last_build() -> dict[str, float]:
    """Sums over the jobs that flew the studies, drew and judged them, where there are any."""
    jobs = [
        pd.read_csv(path, sep="\t")
        for path in sorted((ROOT / "logs/rendezvous").glob("*.benchmark.tsv"))
        if path.name.startswith(GROUPS)
    ]
    if not jobs:
        return {}
    table = pd.concat(jobs)
    return {
        "last_build_jobs": float(len(table)),
        "last_build_jobs_s": float(table["s"].sum()),
        "last_build_on_two_cores_min": float(table["s"].sum()) / 2.0 / 60.0,
    }


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name:36} {value:.4g}")
