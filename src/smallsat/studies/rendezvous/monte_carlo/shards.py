"""Parts of a study that run on their own: any number of them gives the same merged table."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pyarrow as pa

from smallsat.errors import InputError
from smallsat.results import read_table
from smallsat.studies.rendezvous.monte_carlo.tables import KEY, SCHEMA, conforming


def merge(
    paths: Sequence[Path], schema: pa.Schema = SCHEMA, key: Sequence[str] = KEY
) -> pd.DataFrame:
    """Join shards in one order, whatever their number.

    Raises
    ------
    InputError
        If a shard is missing or damaged, or two of them hold the same manoeuvre. A damaged shard
        is removed first, so that the next call of Snakemake makes it again.
    """
    tables = []
    for path in paths:
        try:
            tables.append(conforming(read_table(path), schema, str(path)))
        except InputError as error:
            if not path.exists():
                raise
            path.unlink()
            raise InputError(f"{error}; it has been deleted for you") from None
    table = pd.concat(tables, ignore_index=True)
    table = table.sort_values(list(key), key=_in_order, kind="stable", ignore_index=True)
    twice = table.duplicated(list(key))
    if twice.any():
        one = ", ".join(f"{name} {table.loc[twice, name].iloc[0]}" for name in key)
        raise InputError(
            f"{paths[0].parent}: {one} is there twice; delete the folder of the shards and run "
            f"`snakemake` again"
        )
    return table


def _in_order(column: pd.Series) -> pd.Series:
    """Cases in the order of the study, which every shard keeps; numbers by size."""
    if column.name != "case":
        return column
    order = {case: i for i, case in enumerate(dict.fromkeys(column))}
    return column.map(order)
