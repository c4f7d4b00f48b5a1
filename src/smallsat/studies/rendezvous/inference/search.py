"""Searches for what the document never prints, one for each option of each reading.

Every search holds one reading at one option and lets all numbers and all other readings go free,
so that the options of a reading are compared at their best. Each begins with sets of the long
search that the project keeps (see `data/accepted/rendezvous`), the reading put in where they have
another, and random ones. All evaluated sets are kept.

An inference explains what it was fitted to. Equal digits are no reproduction, and with nearly as
many parameters and readings as printed cells some agreement is to be had for nothing.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import differential_evolution

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.axes import axes, missed_axes
from smallsat.studies.rendezvous.inference.misfit import (
    KINDS,
    misfits,
    residuals,
    simulate_sets,
)
from smallsat.studies.rendezvous.inference.parameter_set import (
    FITTED,
    OPTIONS,
    SEARCHES,
    ParameterSet,
    fixed_reading,
)
from smallsat.studies.rendezvous.simulation.delta_v import READINGS

# Of a search's first sets, so many come from the long search.
KEPT_SHARE = 0.5


def evaluate(
    section: Cases, sets: Sequence[ParameterSet], starts: np.ndarray, ledger: Ledger
) -> pd.DataFrame:
    """Misfits of parameter sets: a row a set.

    Columns: `FITTED`, `OPTIONS`, ``delta_v`` (its best sum of `READINGS`), ``misfit``, its part of
    each of `KINDS`, and ``misfit <r>`` of cells, feasibility and text for each of `READINGS`.

    The axes are looked at only where the rest is below the configured ``axes_below``; elsewhere
    they count as missed in all, so that no set gains by not being looked at.
    """
    sections = [one.put_into(section) for one in sets]
    table = residuals(sections, simulate_sets(sections), ledger)
    sums: Any = misfits(table)
    kinds = {kind: misfits(table[table["kind"] == kind]).reindex(sums.index) for kind in KINDS[:-1]}
    rows: list[dict[str, Any]] = []
    for place, one in enumerate(sets):
        best = str(sums.loc[place].idxmin())
        missed = missed_axes(ledger)
        if sums.loc[place, best] < section.inference.axes_below:
            found = axes(sections[place], starts, ledger)
            missed = float((found[f"residual {best}"].to_numpy() ** 2).sum())
        rows.append(
            {
                **one.row,
                "delta_v": best,
                "misfit": sums.loc[place, best] + missed,
                **{kind: kinds[kind].loc[place, best] for kind in KINDS[:-1]},
                "axes": missed,
                **{f"misfit {reading}": sums.loc[place, reading] for reading in READINGS},
            }
        )
    return pd.DataFrame(rows)


def search(
    section: Cases, name: str, kept: pd.DataFrame, starts: np.ndarray, ledger: Ledger
) -> pd.DataFrame:
    """Search with one reading held; a row an evaluated set, as from `evaluate`.

    Parameters
    ----------
    section
        With the search's settings.
    name
        One of `SEARCHES`.
    kept
        Sets to begin with, best first.
    starts
        Initial states for the axes, (n, 6), m and m/s.
    ledger
        What the document prints.
    """
    settings = section.inference
    reading, option = fixed_reading(name)
    low, high = np.array([settings.bounds[number] for number in FITTED], dtype=float).T
    random = np.random.default_rng([settings.seed, SEARCHES.index(name)])
    evaluated: list[pd.DataFrame] = []

    def decoded(place: np.ndarray) -> ParameterSet:
        place = np.clip(place, 0.0, 1.0)
        values = low + place[: len(FITTED)] * (high - low)
        readings = {
            question: options[min(int(part * len(options)), len(options) - 1)]
            for (question, options), part in zip(OPTIONS.items(), place[len(FITTED) :], strict=True)
        }
        return ParameterSet(
            dict(zip(FITTED, values.tolist(), strict=True)), {**readings, reading: option}
        )

    def encoded(one: ParameterSet) -> np.ndarray:
        numbers = (np.array([one.values[number] for number in FITTED]) - low) / (high - low)
        picks = [
            (options.index(one.readings[question]) + 0.5) / len(options)
            for question, options in OPTIONS.items()
        ]
        return np.clip(np.r_[numbers, picks], 0.0, 1.0)

    def misfit(places: np.ndarray) -> np.ndarray:
        """Misfits (sets,) of a population, shape (parameters, sets) as the optimiser has it."""
        sets = [decoded(place) for place in np.atleast_2d(places.T)]
        evaluated.append(evaluate(section, sets, starts, ledger))
        return evaluated[-1]["misfit"].to_numpy()

    first = random.random((settings.population, len(FITTED) + len(OPTIONS)))
    known = [ParameterSet.configured(section), *_begin_with(kept, reading, option)]
    for place, one in enumerate(known[: round(KEPT_SHARE * settings.population)]):
        first[place] = encoded(one)
    differential_evolution(
        misfit, [(0.0, 1.0)] * first.shape[1], init=first, maxiter=settings.generations,
        seed=random, polish=False, vectorized=True, updating="deferred", tol=0.0,
        mutation=(0.4, 0.9), recombination=0.8,
    )  # fmt: skip
    return pd.concat(evaluated, ignore_index=True).assign(search=name)


def _begin_with(kept: pd.DataFrame, reading: str, option: Any) -> list[ParameterSet]:
    """Kept sets in turn: one that has the option already, one that has another."""
    own = kept[reading].astype(str) == str(option)
    order = pd.concat([own[own].reset_index(), own[~own].reset_index()]).groupby(level=0)
    rows = [kept.loc[number] for _, pair in order for number in pair["index"]]
    return [ParameterSet.of_row(row.to_dict()) for row in rows]
