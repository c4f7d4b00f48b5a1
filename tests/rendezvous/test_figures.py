"""What the study's figures show: data where they are, and nothing drawn over them."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.figures.cases import manoeuvre
from smallsat.studies.rendezvous.figures.robustness import bounce_map, variants
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.parameters import law


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_a_chaser_on_the_turning_axis_stays_on_it(section):
    """Along the axis its distance, across it nothing, however far the axis has turned."""
    given = law(section, "rotating")
    times = np.linspace(0.0, 1500.0, 6)
    places = np.array([100.0 * given.axis_at(time) for time in times])
    path = pd.DataFrame(places, columns=STATE[:3]).assign(time_s=times, flight="rotating")
    path["phase"] = ["far", "far", "mid", "mid", "final", "final"]
    flight = path.assign(**dict.fromkeys(CHANGE, 0.01))
    _, drawn = manoeuvre(section, "rotating", flight, path)
    way = drawn[drawn["drawn"] == "path"]
    assert way["along_m"].to_numpy() == pytest.approx(100.0)
    assert way["across_m"].to_numpy() == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(way["x_m"]) > 1.0


def test_lines_of_the_bounces_run_between_cells():
    """Every end of a line is at a corner of cells, where no digits stand; the level is crossed."""
    rows = [
        {"end_distance_m": d, "time_limit_min": t, "deviation_delta_v_m_s": d * t,
         "deviation_time_min": d * t, "docked_share": 0.5}
        for d in (0.1, 0.2, 0.3) for t in (10.0, 20.0)
    ]  # fmt: skip
    figure, _ = bounce_map(pd.DataFrame(rows), 0.2, {"deviation_delta_v_m_s": 3.5})
    lines = [line for line in figure.axes[0].lines if line.get_marker() == "None"]
    ends = np.array([np.ravel(line.get_data()) for line in lines])
    assert len(ends) == 3
    assert (np.abs(ends % 1.0) == 0.5).all()
    # A level that nothing is compared with has no line.
    assert not [line for line in figure.axes[2].lines if line.get_marker() == "None"]


def test_a_variant_that_would_squeeze_the_others_is_shown_whole():
    """The axis becomes logarithmic, and its ends lie beyond all intervals."""
    table = pd.DataFrame({"variant": list("abc")})
    for name in ("delta_v", "time"):
        table[f"{name}_low_pct"] = [-1.0, -2.0, 0.0]
        table[f"{name}_median_pct"] = [0.0, 0.5, 1.0]
        table[f"{name}_high_pct"] = [1.0, 2.0, 1.5 if name == "time" else 200.0]
    figure, _ = variants(table)
    squeezed, plain = figure.axes
    assert (squeezed.get_xscale(), plain.get_xscale()) == ("symlog", "linear")
    assert squeezed.get_xlim()[0] < -2.0 and squeezed.get_xlim()[1] > 200.0
