"""Starts near and far: which find the optimum, and how they are counted."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.transfer.methods import basin


def test_every_method_finds_the_optimum_from_itself_and_from_nearby(config, monkeypatch):
    """No noise and an eighth of it, for each method; a start has all unknowns of its method."""
    monkeypatch.setattr(basin, "SPREADS", (0.0, 0.125))
    numerics = config.transfer.numerics.with_(basin=1)
    table = basin.basin(config.transfer.with_(numerics=numerics))
    assert set(table["unknowns"]) == {6, 36, 20 * (4 * 6 + 5) + 1}
    assert table["final_time"].to_numpy() == pytest.approx(1.0, abs=1e-6)


def test_shares_tell_the_optimum_from_other_ends():
    """One at the optimum, one slower, two that end nowhere: a quarter, a quarter elsewhere."""
    table = pd.DataFrame(
        {
            "method": "m",
            "unknowns": 6,
            "spread": 0.5,
            "start": range(4),
            "final_time": [1.0 + 1e-8, 1.1, np.nan, np.nan],
        }
    )
    row = basin.shares(table).iloc[0]
    assert (row["optimum"], row["elsewhere"], row["starts"]) == (0.25, 0.25, 4)
    # Wilson's interval of 1 in 4 at 95 %, by its formula.
    z, n, p = 1.959964, 4, 0.25
    middle = (p + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    assert (row["low"], row["high"]) == pytest.approx((middle - half, middle + half), abs=1e-5)
