"""What differs between two builds, and which digits move."""

import numpy as np
import pandas as pd

from smallsat.results import write_table
from tests.determinism.bytes_compared import Moved, compared, moved_digits


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


def test_a_text_that_differs_in_numbers_alone_has_the_same_words(tmp_path):
    """Two of a kind, seconds; and a verdict that came out otherwise, which is no number."""
    texts = {
        "page.html": ("<p>solved in 0.31 s</p>", "<p>solved in 1.2e-01 s</p>"),
        "power.html": ("<td>0.0001010329</td>", "<td>8.46044×10<sup>-5</sup></td>"),
        "verdict.csv": ("a,0.31,ours is faster", "a,0.12,ours is slower"),
        "same.json": ("{}", "{}"),
    }
    for k, build in enumerate(("one", "other")):
        (tmp_path / build / "figures").mkdir(parents=True)
        for name, versions in texts.items():
            (tmp_path / build / "figures" / name).write_text(versions[k])
    found = {file.name: file for file in compared(tmp_path / "one", tmp_path / "other")}
    assert [(file.same, file.words) for file in found.values()] == [
        (False, True),
        (False, True),
        (True, True),
        (False, False),
    ]
