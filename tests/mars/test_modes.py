"""The state machine and its timeline."""

import numpy as np
import pytest

from smallsat.dynamics.orbits.circular_orbits import CircularOrbit
from smallsat.studies.mars.model.modes import GMO, NADIR, SUN, pointing_mode, shares, timeline

LIMIT = np.radians(35.0)


def at_angle(degrees, radius):
    """A resting spacecraft in the equatorial plane, so many degrees from the first axis."""
    return CircularOrbit(radius, 0.0, 0.0, np.radians(degrees), 0.0)


@pytest.mark.parametrize(
    ("lmo_deg", "gmo_deg", "mode"),
    [
        (90.0, 90.0, SUN),  # sunlit, whatever is visible
        (1.0, -20.0, SUN),
        (-90.0, -90.0, GMO),
        (-90.0, -124.99, GMO),  # just inside the limit, either side
        (-90.0, -55.01, GMO),
        (-90.0, -125.01, NADIR),  # just outside
        (-90.0, -54.99, NADIR),
        (-90.0, 90.0, NADIR),
        (-1.0, 34.5, NADIR),  # the mothercraft's own place in the Sun does not count
        (-1.0, 33.5, GMO),
    ],
)
def test_transitions_of_table_7(lmo_deg, gmo_deg, mode):
    """Every branch of Table 7, just to either side of both conditions."""
    assert pointing_mode(at_angle(lmo_deg, 4e6), at_angle(gmo_deg, 2e7), 0.0, LIMIT) == mode


def test_a_position_in_the_terminator_is_not_sunlit():
    """Table 7 asks for more than zero: on the first axis the night side begins."""
    assert pointing_mode(at_angle(0.0, 4e6), at_angle(0.0, 2e7), 0.0, LIMIT) == GMO


def test_mission_modes(runs):
    """Modes at the document's five answer times, in the order sun, nadir, GMO, nadir, sun."""
    modes = runs["mission"][[300, 2100, 3400, 4400, 5600], 16].tolist()
    assert modes == [SUN, NADIR, GMO, NADIR, SUN]


def test_timeline_covers_the_run_without_gaps():
    """A made-up history: intervals in order, shares that add up; the last sample opens none."""
    time = np.arange(8.0)
    mode = np.array([SUN, SUN, NADIR, GMO, GMO, GMO, SUN, NADIR])
    intervals = timeline(time, mode)
    assert intervals["mode"].tolist() == ["sun", "nadir", "gmo", "sun"]
    assert intervals["duration_s"].tolist() == [2.0, 1.0, 3.0, 1.0]
    assert intervals["start_s"].tolist()[1:] == intervals["end_s"].tolist()[:-1]
    table = shares(intervals).set_index("mode")
    assert table["intervals"].to_dict() == {"sun": 2, "nadir": 1, "gmo": 1}
    assert table["share_percent"].sum() == pytest.approx(100.0)


def test_a_mode_that_never_holds_has_no_share():
    """A run in one mode: the others are listed with zero."""
    table = shares(timeline(np.arange(3.0), np.full(3, SUN))).set_index("mode")
    assert table.loc["gmo", ["intervals", "seconds", "share_percent"]].tolist() == [0, 0.0, 0.0]
