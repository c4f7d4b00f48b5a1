"""What holding the printed axes costs: the set that the search for it found, and the configured."""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.axes import axes
from smallsat.studies.rendezvous.inference.axes_search import excesses
from smallsat.studies.rendezvous.inference.misfit import KINDS
from smallsat.studies.rendezvous.inference.parameter_set import ParameterSet
from smallsat.studies.rendezvous.inference.search import parts_without_axes

CONFIGURED, FOUND = "configured", "nearest to the axes"


def compared(
    section: Cases, searched: pd.DataFrame, states: np.ndarray, ledger: Ledger
) -> dict[str, pd.DataFrame]:
    """Both sets against the axes, from all states, and against everything else.

    Parameters
    ----------
    section
        With the configured set.
    searched
        Rounds of `axes_search.search_axes`; the set is that with the least excess from all states,
        and among equal ones with the least misfit.
    states
        Initial states of chapter 4, (n, 6), m and m/s.
    ledger
        What the document prints.

    Returns
    -------
    dict
        ``axes-ends``, a row an end of an axis: ``printed`` and where each set's data end.
        ``axes-sets``, a row a set: its excess over the axes, in squares of assumed errors, how many
        starts it loses before, and its misfit without the axes with the parts of it.
    """
    row: Any = searched.sort_values(["axes_of_all", "misfit"]).iloc[0].to_dict()
    readings = {CONFIGURED: section.inferred.readings.delta_v, FOUND: row["delta_v"]}
    sections = {CONFIGURED: section, FOUND: ParameterSet.of_row(row).put_into(section)}
    parts: Any = parts_without_axes(list(sections.values()), ledger)
    ends, sets = pd.DataFrame(), list[dict[str, Any]]()
    for place, (name, own) in enumerate(sections.items()):
        found, reading = axes(own, states, ledger), readings[name]
        if ends.empty:
            ends = found[["cell", "printed"]].copy()
        ends[name] = found[f"computed {reading}"]
        sets.append(
            {
                "set": name,
                "axes": excesses(found, ledger)[reading],
                "lost": int(found["lost"].max()),
                "misfit": parts["all"].loc[place, reading],
                **{kind: parts[kind].loc[place, reading] for kind in KINDS[:-1]},
            }
        )
    return {"axes-ends": ends, "axes-sets": pd.DataFrame(sets)}
