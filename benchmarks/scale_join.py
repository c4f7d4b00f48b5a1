"""Joining the shards of a sweep: seconds and memory over ever more manoeuvres.

``make scale`` runs it. The sizes that ``scale.py`` flies are joined in little more than it takes to
start Python, so that a line through them says nothing of a million. Here copies of a flown shard,
with other numbers of samples, are joined by the workflow's own step.
"""

import shutil

import pandas as pd
from scale import FOLDER, SWEEP, TABLES, step

from smallsat.results import read_table, write_table
from smallsat.shard import Shard

# The size whose first shard is copied, and how many copies are joined.
FLOWN, COPIES = 5000, (1, 10, 30, 60)


def joined(shard: pd.DataFrame, copies: int) -> dict[str, float]:
    """What the join of so many copies takes."""
    shutil.rmtree(FOLDER / str(copies), ignore_errors=True)
    for part in Shard.all(copies):
        moved = shard.assign(sample=(shard["sample"] + FLOWN * part.number).astype("int32"))
        write_table(moved, FOLDER / str(copies) / f"studies/shards/{SWEEP}-{part}.parquet")
    cost = step(copies, "joined", "--part", SWEEP, "--shard", str(Shard(copies, copies)))
    return {
        "shards": copies,
        "manoeuvres": copies * len(shard),
        "join_s": round(cost.seconds, 2),
        "join_MiB": round(cost.memory_MiB, 1),
    }


def main() -> None:
    """Measure, and write the table."""
    shards = sorted((FOLDER / str(FLOWN) / "studies/shards").glob("*.parquet"))
    rows = [joined(read_table(shards[0]), copies) for copies in COPIES]
    write_table(pd.DataFrame(rows), TABLES / "scale-join.csv")


if __name__ == "__main__":
    main()
