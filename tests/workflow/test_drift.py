"""What `make drift` says about two tables: what moved, and how far."""

import importlib.util

import numpy as np
import pandas as pd
import pytest


@pytest.fixture(scope="module")
def drifted(root):
    place = importlib.util.spec_from_file_location("drift", root / "tests/drift/run.py")
    module = importlib.util.module_from_spec(place)
    place.loader.exec_module(module)

    def found(before, now):
        return list(module.drifted(pd.DataFrame(before), pd.DataFrame(now)))

    return found


def test_equal_tables_do_not_move(drifted):
    """Empty cells are equal to one another."""
    table = {"t": [1.0, np.nan], "word": ["a", None]}
    assert drifted(table, table) == [("t", 2, 0, 0.0), ("word", 2, 0, 0.0)]


def test_the_change_is_relative_to_the_largest_of_its_column(drifted):
    """So that what is zero but for rounding does not count as moved by much."""
    moved = drifted({"t": [100.0, 1e-16]}, {"t": [100.0, 2e-16]})
    assert moved == [("t", 2, 1, pytest.approx(1e-18))]
    assert drifted({"t": [100.0, 1.0]}, {"t": [99.0, 1.0]}) == [("t", 2, 1, pytest.approx(0.01))]


@pytest.mark.parametrize(
    ("before", "now"),
    [
        ({"word": ["a"]}, {"word": ["b"]}),
        ({"t": [1.0]}, {"t": [np.nan]}),
        ({"t": [1.0]}, {"t": [1.0, 2.0]}),
        ({"t": [1.0]}, {}),
        ({"t": [True]}, {"t": [False]}),
    ],
)
def test_what_has_no_size_moved_without_end(drifted, before, now):
    """Words, what is no number any more, rows and columns that come or go."""
    ((_, _, moved, change),) = drifted(before, now)
    assert moved > 0 and change == np.inf
