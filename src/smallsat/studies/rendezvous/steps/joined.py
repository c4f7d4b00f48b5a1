"""The shards of a group of manoeuvres in one table; the part is the group."""

from smallsat.shard import Shard
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.monte_carlo.shards import merge
from smallsat.studies.rendezvous.monte_carlo.tables import KEY, PASSAGES, PASSAGES_KEY, SCHEMA


def run(step: Step[MonteCarlo]) -> Tables:
    """Join them in one order."""
    schema, key = (PASSAGES, PASSAGES_KEY) if step.part == "passages" else (SCHEMA, KEY)
    folder = step.results / "studies/shards"
    shards = Shard.all(step.shard.count)
    paths = [folder / f"{step.part}-{shard}.parquet" for shard in shards]
    return {f"studies/{step.part}.parquet": merge(paths, schema, key)}
