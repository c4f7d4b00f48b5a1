"""Light and link over the Mars day: the document's conditions, and those of geometry."""

import numpy as np
import pandas as pd

from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.model.light import conditions
from smallsat.studies.mars.parameters import Parameters

# Each by how it follows from the conditions at a time; the document's own first of its kind.
NIGHT, SHADOW = "night side", "shadow of Mars"
LINK, SIGHT_AT_NIGHT = "link by Table 1", "line of sight at night"
SIGHT, SIGHT_IN_SHADOW = "line of sight", "line of sight in the shadow"
RULES = {
    NIGHT: lambda c: c["night"],
    SHADOW: lambda c: c["shadow"],
    LINK: lambda c: c["night"] & c["visible"],
    SIGHT_AT_NIGHT: lambda c: c["night"] & c["sight"],
    SIGHT_IN_SHADOW: lambda c: c["shadow"] & c["sight"],
    SIGHT: lambda c: c["sight"],
}


def day_conditions(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """Intervals of each of `RULES` over the day: ``condition``, ``start_s``, ``end_s``.

    A condition holds from the step at which it is found to hold to the next.
    """
    count = round(section.durations_s.day / section.step_s)
    times = section.step_s * np.arange(count + 1)
    found = conditions(parameters, times)
    tables = []
    for name, rule in RULES.items():
        holds = rule(found).to_numpy()[:-1]
        edges = np.flatnonzero(np.diff(np.r_[False, holds, False].astype(int)))
        tables.append(
            pd.DataFrame(
                {"condition": name, "start_s": times[edges[::2]], "end_s": times[edges[1::2]]}
            )
        )
    return pd.concat(tables, ignore_index=True)


def summary(section: Configuration, intervals: pd.DataFrame) -> pd.DataFrame:
    """Share of the day, number of intervals, the longest of them and the longest time without.

    Columns ``condition``, ``share_percent``, ``intervals``, ``longest_s``, ``longest_without_s``.
    """
    day = section.durations_s.day
    rows = []
    for name in RULES:
        chosen = intervals[intervals["condition"] == name]
        lengths = (chosen["end_s"] - chosen["start_s"]).to_numpy()
        gaps = np.r_[chosen["start_s"], day] - np.r_[0.0, chosen["end_s"]]
        rows.append(
            {
                "condition": name,
                "share_percent": 100.0 * lengths.sum() / day,
                "intervals": len(chosen),
                "longest_s": lengths.max(initial=0.0),
                "longest_without_s": gaps.max(),
            }
        )
    return pd.DataFrame(rows)
