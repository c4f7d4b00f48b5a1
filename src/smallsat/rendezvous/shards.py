"""Parts of a study that run on their own: any number of them gives the same merged table."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from smallsat.errors import InputError
from smallsat.rendezvous.study_tables import KEY, conforming
from smallsat.results import read_table, write_table


def part(count: int, shard: int, shards: int) -> np.ndarray:
    """Numbers of the units of one shard: every so-manieth, so that shards take equally long.

    Parameters
    ----------
    count
        Of all units.
    shard
        From 1 to ``shards``.
    """
    if not 1 <= shard <= shards:
        raise InputError(f"shard {shard}: not allowed; from 1 to {shards}")
    return np.arange(shard - 1, count, shards)


def merge(paths: Sequence[Path], output: Path) -> pd.DataFrame:
    """Join shards in one order, whatever their number, and write them as one table.

    Raises
    ------
    InputError
        If a shard is missing or damaged, or two of them hold the same manoeuvre. A damaged shard
        is removed first, so that the next call of Snakemake makes it again.
    """
    tables = []
    for path in paths:
        try:
            tables.append(conforming(read_table(path), str(path)))
        except InputError as error:
            if not path.exists():
                raise
            path.unlink()
            raise InputError(f"{error}; it has been deleted for you") from None
    table = pd.concat(tables, ignore_index=True)
    # The order of the cases is that of the study, which each shard keeps.
    order = {case: i for i, case in enumerate(dict.fromkeys(table["case"]))}
    table = table.sort_values(KEY, key=_ranked(order), kind="stable", ignore_index=True)
    twice = table.duplicated(KEY)
    if twice.any():
        one = table.loc[twice, KEY].iloc[0]
        raise InputError(
            f"{output}: case '{one['case']}', sample {one['sample']}, run {one['run']} is there "
            f"twice; delete the folder of the shards and run `snakemake` again"
        )
    write_table(table, output)
    return table


def _ranked(order: dict[str, int]):
    return lambda column: column.map(order) if column.name == "case" else column
