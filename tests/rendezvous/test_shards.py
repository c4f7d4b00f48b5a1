"""Shards of a study: the merged table does not depend on their number, and says what is wrong."""

import pandas as pd
import pytest
import synthetic

from smallsat.errors import InputError
from smallsat.results import write_table
from smallsat.shard import Shard
from smallsat.studies.rendezvous.monte_carlo.shards import merge

COUNT = 17


def shard_files(folder, shards):
    """Three cases of 17 manoeuvres in so many shards, each with its own samples."""
    cases = [
        synthetic.manoeuvres(name, COUNT, docking_time_s=1.0 + i)
        for i, name in enumerate(("b", "a", "c"))
    ]
    paths = []
    for shard in range(1, shards + 1):
        own = Shard(shard, shards).units(COUNT)
        path = folder / f"{shard}-of-{shards}.parquet"
        write_table(pd.concat([case.iloc[own] for case in cases], ignore_index=True), path)
        paths.append(path)
    return paths


@pytest.mark.parametrize("shards", [2, 5, 17])
def test_any_number_of_shards_gives_the_same_bytes(tmp_path, shards):
    """One shard or seventeen: the merged file is the same, case by case and sample by sample."""
    write_table(merge(shard_files(tmp_path, 1)), tmp_path / "one.parquet")
    merged = merge(shard_files(tmp_path, shards))
    write_table(merged, tmp_path / "many.parquet")
    assert (tmp_path / "one.parquet").read_bytes() == (tmp_path / "many.parquet").read_bytes()
    assert list(dict.fromkeys(merged["case"])) == ["b", "a", "c"]
    assert merged["sample"].tolist() == 3 * list(range(COUNT))


def test_a_damaged_shard_is_named_and_removed(tmp_path):
    """Half a file stops the merge in one line, and the next call makes it again."""
    first, second = shard_files(tmp_path, 2)
    second.write_bytes(second.read_bytes()[:300])
    with pytest.raises(InputError, match=r"2-of-2\.parquet: damaged results file"):
        merge([first, second])
    assert first.exists() and not second.exists()


def test_a_missing_column_and_a_wrong_type_are_named(tmp_path):
    """The schema is explicit: nothing that differs from it is merged."""
    table = synthetic.manoeuvres("a", 3)
    write_table(table.drop(columns="docking_steps"), tmp_path / "short.parquet")
    with pytest.raises(InputError, match=r"column 'docking_steps' is missing; needed: int32"):
        merge([tmp_path / "short.parquet"])
    table["sample"] = table["sample"].astype("int64")
    write_table(table, tmp_path / "wide.parquet")
    with pytest.raises(InputError, match=r"column 'sample' is of type int64; needed: int32"):
        merge([tmp_path / "wide.parquet"])


def test_the_same_manoeuvre_twice_is_refused(tmp_path):
    """Shards of two runs with different numbers must not be mixed."""
    whole, *_ = shard_files(tmp_path, 1)
    half, *_ = shard_files(tmp_path, 2)
    with pytest.raises(InputError, match=r"case b, sample 0, run 0 is there twice"):
        merge([whole, half])
