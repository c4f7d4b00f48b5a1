"""A search for sets whose data end within the printed axes of Figures 4.7 and 4.10, whatever else.

Its objective is the excess over the axes alone; only between sets without any does the misfit of
the rest decide. The axes hold for all initial states of chapter 4, far too many for each set, so
that the search is an exchange method, as for semi-infinite programs: it looks at a few states,
checks its best set on all of them, and takes on the states from which that exceeds an axis most.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.axes import axes, missed_axes
from smallsat.studies.rendezvous.inference.misfit import KINDS
from smallsat.studies.rendezvous.inference.parameter_set import ParameterSet
from smallsat.studies.rendezvous.inference.search import evolve, parts_without_axes
from smallsat.studies.rendezvous.simulation.delta_v import READINGS

# Larger than any misfit: a set beyond an axis is worse than one within all of them.
BEYOND_AXES = 1e6
# States that a round takes on at most.
TAKEN_ON = 3


def excesses(found: pd.DataFrame, ledger: Ledger) -> pd.Series:
    """Sum of squares of what `axes` has beyond the axes, by `READINGS`.

    A set from which a start is lost before the phases that the figures show is taken to miss all.
    """
    if found["lost"].any():
        return pd.Series(missed_axes(ledger), list(READINGS))
    squares = {reading: (found[f"residual {reading}"] ** 2).sum() for reading in READINGS}
    return pd.Series(squares)


def evaluate(
    section: Cases, sets: Sequence[ParameterSet], starts: np.ndarray, ledger: Ledger
) -> pd.DataFrame:
    """Parameter sets by their excess over the axes from some starts, (n, 6): a row a set.

    Columns: those of a set, ``delta_v``, the sum of `READINGS` with the least excess, ``axes``, the
    excess, and where there is none ``misfit`` and its parts, of everything but the axes.
    """
    rows: list[dict[str, Any]] = []
    for one in sets:
        own = one.put_into(section)
        beyond = excesses(axes(own, starts, ledger), ledger)
        best, row = str(beyond.idxmin()), dict[str, Any]()
        if beyond.min() == 0.0:
            parts: Any = parts_without_axes([own], ledger)
            best = str(parts["all"].loc[0, beyond == 0.0].idxmin())
            row = {kind: parts[kind].loc[0, best] for kind in KINDS[:-1]}
            row["misfit"] = parts["all"].loc[0, best]
        rows.append({**one.row, "delta_v": best, "axes": beyond[best], **row})
    columns = [*sets[0].row, "delta_v", "axes", "misfit", *KINDS[:-1]]
    return pd.DataFrame(rows).reindex(columns=columns)


def search_axes(
    section: Cases, kept: pd.DataFrame, states: np.ndarray, ledger: Ledger
) -> pd.DataFrame:
    """Search in rounds; a row a round, its best set as from `evaluate`.

    Parameters
    ----------
    section
        With the search's settings.
    kept
        Sets to begin with, best first.
    states
        All initial states, (n, 6), m and m/s.
    ledger
        What the document prints.

    Returns
    -------
    pandas.DataFrame
        With ``round``, ``starts``, how many it looked at, ``sets``, how many it evaluated, and
        ``axes_of_all``, the excess over the axes from all states.
    """
    settings = section.inference.axes_search
    looked_at = list(range(min(settings.starts, len(states))))
    known = [ParameterSet.of_row(row) for row in kept.to_dict("records")]
    rounds: list[dict[str, Any]] = []
    for number in range(settings.rounds):
        table = _round(section, known, states[looked_at], ledger, number)
        known = [ParameterSet.of_row(row) for row in table.to_dict("records")]
        best: Any = table.iloc[0].to_dict()
        found = axes(known[0].put_into(section), states, ledger)
        reading = best["delta_v"]
        rounds.append(
            {"round": number + 1, "starts": len(looked_at), "sets": len(table), **best}
            | {"axes_of_all": excesses(found, ledger)[reading]}
        )
        hardest = found.sort_values(f"residual {reading}", ascending=False)
        beyond = hardest.loc[hardest[f"residual {reading}"] > 0.0, f"start {reading}"]
        looked_at += [place for place in dict.fromkeys(beyond) if place not in looked_at][:TAKEN_ON]
    return pd.DataFrame(rounds)


def _round(
    section: Cases,
    known: Sequence[ParameterSet],
    starts: np.ndarray,
    ledger: Ledger,
    number: int,
) -> pd.DataFrame:
    """All sets that one round evaluates, best first."""
    settings, evaluated = section.inference.axes_search, list[pd.DataFrame]()

    def objective(sets: Sequence[ParameterSet]) -> np.ndarray:
        found = evaluate(section, sets, starts, ledger)
        evaluated.append(found)
        return np.where(found["axes"] > 0.0, BEYOND_AXES + found["axes"], found["misfit"])

    random = np.random.default_rng([settings.seed, number])
    evolve(
        objective, section.inference.bounds, known, settings.population, settings.generations,
        random, {},
    )  # fmt: skip
    return pd.concat(evaluated, ignore_index=True).sort_values(
        ["axes", "misfit"], ignore_index=True
    )
