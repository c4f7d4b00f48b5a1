"""Searches for what the document never prints, one for each option of each reading.

Every search holds one reading at one option and lets all numbers and all other readings go free,
so that the options of a reading are compared at their best. Each begins with sets of the long
search that the project keeps (see `data/accepted/rendezvous`), the reading put in where they have
another, and random ones. All evaluated sets are kept.

An inference explains what it was fitted to. Equal digits are no reproduction, and with nearly as
many parameters and readings as printed cells some agreement is to be had for nothing.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import differential_evolution

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Bounds, Cases
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

# Of parameter sets, to be made least: a number a set.
Objective = Callable[[Sequence[ParameterSet]], np.ndarray]


def parts_without_axes(sections: Sequence[Cases], ledger: Ledger) -> dict[str, pd.DataFrame]:
    """Misfits of sets by `READINGS`, a row a set: ``all``, and its part of each kind but axes."""
    table = residuals(sections, simulate_sets(sections), ledger)
    sums = misfits(table)
    kinds = {kind: misfits(table[table["kind"] == kind]).reindex(sums.index) for kind in KINDS[:-1]}
    return {"all": sums, **kinds}


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
    kinds: Any = parts_without_axes(sections, ledger)
    sums = kinds["all"]
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
    evaluated: list[pd.DataFrame] = []

    def misfit(sets: Sequence[ParameterSet]) -> np.ndarray:
        evaluated.append(evaluate(section, sets, starts, ledger))
        return evaluated[-1]["misfit"].to_numpy()

    known = [ParameterSet.configured(section), *_begin_with(kept, reading, option)]
    evolve(
        misfit, settings.bounds, known, settings.population, settings.generations,
        np.random.default_rng([settings.seed, SEARCHES.index(name)]), {reading: option},
    )  # fmt: skip
    return pd.concat(evaluated, ignore_index=True).assign(search=name)


def evolve(
    objective: Objective,
    bounds: Bounds,
    known: Sequence[ParameterSet],
    population: int,
    generations: int,
    random: np.random.Generator,
    held: Mapping[str, Any],
) -> None:
    """Make an objective of parameter sets less by differential evolution.

    Nothing is returned: what was evaluated is the objective's to keep.

    Parameters
    ----------
    objective, bounds
        Of sets, and of their numbers.
    known
        Sets to begin with, of which `KEPT_SHARE` of the population is taken; the others are random.
    population, generations
        Sets a generation, and generations after the first.
    random
        Source of the random numbers.
    held
        Readings that are held, with their options.
    """
    low, high = np.array([bounds[number] for number in FITTED], dtype=float).T

    def decoded(place: np.ndarray) -> ParameterSet:
        place = np.clip(place, 0.0, 1.0)
        values = low + place[: len(FITTED)] * (high - low)
        readings = {
            question: options[min(int(part * len(options)), len(options) - 1)]
            for (question, options), part in zip(OPTIONS.items(), place[len(FITTED) :], strict=True)
        }
        return ParameterSet(dict(zip(FITTED, values.tolist(), strict=True)), {**readings, **held})

    def encoded(one: ParameterSet) -> np.ndarray:
        numbers = (np.array([one.values[number] for number in FITTED]) - low) / (high - low)
        picks = [
            (options.index(one.readings[question]) + 0.5) / len(options)
            for question, options in OPTIONS.items()
        ]
        return np.clip(np.r_[numbers, picks], 0.0, 1.0)

    def of_places(places: np.ndarray) -> np.ndarray:
        """The objective of a population, shape (parameters, sets) as the optimiser has it."""
        return objective([decoded(place) for place in np.atleast_2d(places.T)])

    first = random.random((population, len(FITTED) + len(OPTIONS)))
    for place, one in enumerate(known[: round(KEPT_SHARE * population)]):
        first[place] = encoded(one)
    differential_evolution(
        of_places, [(0.0, 1.0)] * first.shape[1], init=first, maxiter=generations,
        seed=random, polish=False, vectorized=True, updating="deferred", tol=0.0,
        mutation=(0.4, 0.9), recombination=0.8,
    )  # fmt: skip


def _begin_with(kept: pd.DataFrame, reading: str, option: Any) -> list[ParameterSet]:
    """Kept sets in turn: one that has the option already, one that has another."""
    own = kept[reading].astype(str) == str(option)
    order = pd.concat([own[own].reset_index(), own[~own].reset_index()]).groupby(level=0)
    rows = [kept.loc[number] for _, pair in order for number in pair["index"]]
    return [ParameterSet.of_row(row.to_dict()) for row in rows]
