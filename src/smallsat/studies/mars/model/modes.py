"""The mission's state machine (mars, Tables 1 and 7) and the timeline that it makes."""

from math import cos

import numpy as np
import pandas as pd

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.circular_orbits import position
from smallsat.dynamics.vectors import dot

SUN, NADIR, GMO = 0, 1, 2
MODE_NAMES = ("sun", "nadir", "gmo")

# Sunlit: the position's component towards the Sun is larger than this, m.
SUNLIT_ABOVE = 0.0


@compiled
def pointing_mode(lmo, gmo, time, visibility):
    """Mode at a time: SUN on the sunlit side, else GMO if it is visible, else NADIR.

    Parameters
    ----------
    lmo, gmo : CircularOrbit
    time : float
        Seconds.
    visibility : float
        Largest angle between the two position vectors at which the mothercraft is visible, rad.
    """
    r_lmo, r_gmo = position(lmo, time), position(gmo, time)
    if r_lmo[1] > SUNLIT_ABOVE:
        return SUN
    if dot(r_lmo, r_gmo) >= cos(visibility) * lmo.radius * gmo.radius:
        return GMO
    return NADIR


def timeline(time: np.ndarray, mode: np.ndarray) -> pd.DataFrame:
    """Intervals of constant mode: ``start_s``, ``end_s``, ``duration_s``, ``mode``.

    Parameters
    ----------
    time, mode
        Shape (n,): sample times, s, and the mode that holds from each of them to the next.
    """
    # The last sample only ends the last interval.
    starts = np.flatnonzero(np.r_[True, np.diff(mode[:-1]) != 0])
    ends = np.r_[starts[1:], len(time) - 1]
    return pd.DataFrame(
        {
            "start_s": time[starts],
            "end_s": time[ends],
            "duration_s": time[ends] - time[starts],
            "mode": [MODE_NAMES[code] for code in mode[starts]],
        }
    )


def shares(intervals: pd.DataFrame) -> pd.DataFrame:
    """Share of each mode: ``mode``, ``intervals``, ``seconds``, ``share_percent``."""
    grouped = intervals.groupby("mode")["duration_s"]
    seconds = grouped.sum().reindex(MODE_NAMES, fill_value=0.0)
    return pd.DataFrame(
        {
            "mode": MODE_NAMES,
            "intervals": grouped.size().reindex(MODE_NAMES, fill_value=0).to_numpy(),
            "seconds": seconds.to_numpy(),
            "share_percent": 100.0 * (seconds / seconds.sum()).to_numpy(),
        }
    )
