"""Which digits move between two builds."""

import numpy as np
import pandas as pd

from smallsat.results import write_table
from tests.determinism.bytes_compared import Moved, moved_digits


def test_what_moves_and_what_does_not(tmp_path):
    """Numbers against the largest of their column, texts as a whole; not where both are empty."""
    table = pd.DataFrame(
        {
            "same": [1.0, np.nan, np.inf],
            "moved": [1.0, -4.0, np.nan],
            "empty": [np.nan, np.nan, np.nan],
            "text": ["a", None, "c"],
        }
    )
    write_table(table, tmp_path / "one/t.csv")
    write_table(
        table.assign(moved=[1.0, -4.2, np.nan], text=["a", None, "d"]), tmp_path / "other/t.csv"
    )
    found = {
        move.column: move for move in moved_digits(tmp_path / "one", tmp_path / "other", "t.csv")
    }
    assert set(found) == {"moved", "text"}
    assert (found["text"].cells, found["text"].of) == (1, 3)
    assert abs(found["moved"].relative - 0.05) < 1e-12
    gone = list(moved_digits(tmp_path / "one", tmp_path / "one", "none.csv"))
    assert gone == [Moved("none.csv", "(the table is missing)", 1, 1, float("inf"))]
