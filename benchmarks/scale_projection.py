"""Time and price of the measured sweep on more nodes and from up to a million initial states.

``make scale`` runs it on what ``scale.py`` and ``scale_join.py`` have measured on one node, and on
``slurm.csv``, in which ``make test-slurm`` keeps what a cluster adds to a job. The model stands in
``docs/scale.md``.
"""

import argparse
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.results import read_table, write_table

TABLES = Path(__file__).parents[1] / "data/accepted/pipeline"
STATES, NODES = (5000, 50_000, 1_000_000), (1, 2, 4, 8, 16, 32, 64)
# A shard is sized to minutes, and the configuration allows so many of them.
SHORTEST_SHARD_S, LONGEST_SHARD_S, MOST_SHARDS = 60.0, 600.0, 100


@dataclass(frozen=True)
class Line:
    """Processor seconds as ``each`` for one of something, after ``start`` to begin with.

    ``residual`` is the largest relative departure of a measured size from it.
    """

    each: float
    start: float
    residual: float

    def __call__(self, number: float) -> float:
        """Seconds for so many of them."""
        return self.start + self.each * number


def line(sizes: pd.DataFrame, what: str, of: str, starts: str = "") -> Line:
    """The line by least squares of relative residuals, through all sizes that have such seconds.

    ``starts`` is the column that says how often the seconds have begun; else once.
    """
    there = sizes[sizes[what].notna()]
    begun = there[starts] if starts else np.ones(len(there))
    features = np.column_stack([there[of], begun])
    seconds = there[what].to_numpy()
    found = np.linalg.lstsq(features / seconds[:, None], np.ones(len(there)), rcond=None)[0]
    return Line(*map(float, found), float(np.max(np.abs(features @ found / seconds - 1.0))))


def lines(sizes: pd.DataFrame, joins: pd.DataFrame) -> dict[str, Line]:
    """What drawing takes a state, flying a manoeuvre and a shard, and joining a manoeuvre."""
    return {
        "states": line(sizes, "states_s", "states"),
        "shards": line(sizes, "shards_s", "manoeuvres", "shards_run"),
        "join": line(joins, "join_s", "manoeuvres"),
    }


def flying_s(shard: Line, manoeuvres: float, shards: int, slots: int, job_s: float) -> float:
    """Seconds until all shards are flown, so many at once."""
    return math.ceil(shards / slots) * (shard(manoeuvres / shards) + job_s)


def projected(
    sizes: pd.DataFrame, found: dict[str, Line], cores: int, job_s: float, price: float
) -> Iterator[dict[str, float]]:
    """Time and price of sizes on so many nodes.

    Parameters
    ----------
    sizes
        What was measured on one core.
    found
        The `lines` through it.
    cores
        Of a node.
    job_s
        Seconds that the cluster adds to a job.
    price
        Of a node for an hour.
    """
    cases = sizes["manoeuvres"].iloc[0] / sizes["states"].iloc[0]
    for states in STATES:
        manoeuvres = cases * states
        work = found["shards"].each * manoeuvres
        most = min(MOST_SHARDS, max(1, math.floor(work / SHORTEST_SHARD_S)))
        least = min(most, math.ceil(work / LONGEST_SHARD_S))
        alone = found["states"](states) + found["join"](manoeuvres)
        for nodes in NODES:
            flown = {
                shards: flying_s(found["shards"], manoeuvres, shards, nodes * cores, job_s)
                for shards in range(least, most + 1)
            }
            shards = min(flown, key=flown.__getitem__)
            hours = (alone + flown[shards]) / 3600.0
            yield {
                "states": states,
                "nodes": nodes,
                "cores": nodes * cores,
                "shards": shards,
                "shard_s": round(found["shards"](manoeuvres / shards), 1),
                "hours": round(hours, 4),
                "node_hours": round(nodes * hours, 4),
                "price": round(nodes * hours * price, 4),
            }


def main() -> None:
    """Project, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--price", type=float, default=0.1, help="of a node for an hour")
    price = parser.parse_args().price
    sizes = read_table(TABLES / "scale.csv")
    measured = read_table(TABLES / "scale-provenance.csv", ["value"]).set_index("item")["value"]
    job_s = float(read_table(TABLES / "slurm.csv")["overhead_s"].iloc[0])
    found = lines(sizes, read_table(TABLES / "scale-join.csv"))
    rows = projected(sizes, found, int(measured["cores"]), job_s, price)
    write_table(pd.DataFrame(rows), TABLES / "scale-projected.csv")
    fitted = [{"of": name, **asdict(one)} for name, one in found.items()]
    model = pd.DataFrame(fitted).assign(job_s=job_s, price_per_node_hour=price)
    write_table(model, TABLES / "scale-model.csv")


if __name__ == "__main__":
    main()
