"""Light and sight: the planet's shadow, and whether it stands between the two spacecraft."""

import numpy as np
import pandas as pd

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.circular_orbits import position
from smallsat.dynamics.vectors import axpy, dot
from smallsat.studies.mars.model.frames import SUN_FRAME
from smallsat.studies.mars.model.modes import SUNLIT_ABOVE
from smallsat.studies.mars.parameters import Parameters

TO_SUN = SUN_FRAME[2]
CONDITIONS = ("night", "shadow", "sight", "visible")


@compiled
def in_shadow(place, radius):
    """Whether a position, m, lies in the planet's shadow, a cylinder away from the Sun."""
    along = dot(place, TO_SUN)
    across = axpy(-along, TO_SUN, place)
    return along < 0.0 and dot(across, across) < radius * radius


@compiled
def in_sight(one, other, radius):
    """Whether the line between two positions, m, passes the planet."""
    line = axpy(-1.0, one, other)
    share = min(max(-dot(one, line) / dot(line, line), 0.0), 1.0)
    nearest = axpy(share, line, one)
    return dot(nearest, nearest) >= radius * radius


@compiled
def _conditions(lmo, gmo, radius, visibility, times):
    found = np.empty((len(times), 4), np.bool_)
    for k in range(len(times)):
        nano, mothercraft = position(lmo, times[k]), position(gmo, times[k])
        found[k, 0] = nano[1] <= SUNLIT_ABOVE
        found[k, 1] = in_shadow(nano, radius)
        found[k, 2] = in_sight(nano, mothercraft, radius)
        limit = np.cos(visibility) * lmo.radius * gmo.radius
        found[k, 3] = dot(nano, mothercraft) >= limit
    return found


def conditions(parameters: Parameters, times: np.ndarray) -> pd.DataFrame:
    """What holds for the nano-satellite at times, s, (n,): columns ``time_s`` and `CONDITIONS`.

    ``night``: not on the sunlit side, as Table 1 has it; ``shadow``: in the planet's shadow;
    ``sight``: the planet leaves the line to the mothercraft free; ``visible``: the two positions
    are no further apart than the angle of Table 1.
    """
    found = _conditions(
        parameters.lmo, parameters.gmo, parameters.mars_radius, parameters.visibility, times
    )
    table = pd.DataFrame(found, columns=list(CONDITIONS))
    table.insert(0, "time_s", times)
    return table
