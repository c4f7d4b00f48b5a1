"""The table of what one waits for keeps what was measured before."""

import pandas as pd

from benchmarks.waiting import with_row
from benchmarks.yardstick import oscillator

ROWS = pd.DataFrame(
    {"wait": ["full", "tests"], "commit": ["a", "a"], "seconds": [900.0, 800.0], "yardstick_s": 0.2}
)


def test_a_later_commit_adds_a_row_at_the_end():
    found = with_row(ROWS, {"wait": "full", "commit": "b", "seconds": 700.0, "yardstick_s": 0.1})
    assert found["seconds"].tolist() == [900.0, 800.0, 700.0]
    assert [*found.columns] == [*ROWS.columns]


def test_the_same_commit_measured_again_counts_once():
    found = with_row(ROWS, {"wait": "full", "commit": "a", "seconds": 700.0, "yardstick_s": 0.1})
    assert found["seconds"].tolist() == [800.0, 700.0]


def test_the_yardstick_solves_its_program():
    """Its steps meet to 1e-8, and its control is within 1 but for 1e-7, as IPOPT promises."""
    solver, bounds = oscillator()
    found = solver(**bounds)
    assert solver.stats()["success"]
    assert abs(found["g"].full()).max() < 1e-8
    states = 2 * (len(bounds["lbg"]) // 2 + 1)
    assert abs(found["x"].full()[states:]).max() <= 1 + 1e-7
