"""Shards of a step are a partition, and a wrong one is refused in one line."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smallsat.errors import InputError
from smallsat.shard import Shard


@given(total=st.integers(0, 60), count=st.integers(1, 12))
@settings(max_examples=50, deadline=None)
def test_shards_are_a_partition(total, count):
    """Every unit in one shard, and sizes that differ by one at most."""
    units = [shard.units(total) for shard in Shard.all(count)]
    assert sorted(i for one in units for i in one) == list(range(total))
    assert max(map(len, units)) - min(map(len, units)) <= 1


def test_a_shard_is_read_as_it_is_written():
    assert [str(Shard.parse(text)) for text in ("1-of-1", "3-of-12")] == ["1-of-1", "3-of-12"]


@pytest.mark.parametrize("text", ["5-of-4", "0-of-4", "1-of-0", "1", "one-of-4", "1-of-4 "])
def test_a_shard_out_of_range_is_refused(text):
    with pytest.raises(InputError, match=r"not allowed; from 1-of-N to N-of-N"):
        Shard.parse(text)
