"""Manoeuvres of chapter 4 by initial state, and effects over them with their intervals."""

from collections.abc import Callable

import numpy as np
import pandas as pd
from scipy import stats

from smallsat.evidence.grounds import Grounds
from smallsat.statistics.bootstrap import Bootstrap, Effect, Statistic, effect
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.monte_carlo.cases import sweep_case
from smallsat.studies.rendezvous.monte_carlo.tables import column, totals

DELTA_V, TIME, STEPS = "delta_v_m_s", "time_s", "steps"
WORDS = {DELTA_V: "delta-v", TIME: "time", STEPS: "actuations"}
# A horizon and a sample time, s.
Case = tuple[int, float]


def bootstrap(grounds: Grounds[Configuration]) -> Bootstrap:
    """How intervals are drawn, from the configuration."""
    return Bootstrap(**dict(grounds.section.studies.bootstrap))


def mean(values: np.ndarray) -> Statistic:
    """Statistic: the mean of resampled values."""
    return lambda drawn: values[drawn].mean(axis=1)


def median(values: np.ndarray) -> Statistic:
    """Statistic: the median of resampled values."""
    return lambda drawn: np.median(values[drawn], axis=1)


class Sweep:
    """Results of one phase's sweep: a quantity of each case by initial state."""

    def __init__(self, grounds: Grounds[Configuration], phase: str):
        self.phase = phase
        sweep = grounds.section.studies[phase]
        self.horizons: tuple[int, ...] = sweep.horizons
        self.sample_times: tuple[float, ...] = sweep.sample_times_s
        self.table = grounds.table(f"studies/{phase}-sweep.parquet")
        self.bootstrap = bootstrap(grounds)

    def rows(self, horizon: int, sample_time: float) -> pd.DataFrame:
        """All manoeuvres of a case, by initial state."""
        name = sweep_case(horizon, sample_time)
        found = self.table[self.table["case"] == name].set_index("sample")
        if found.empty:
            raise LookupError(name)
        return found

    def values(self, quantity: str, *cases: Case) -> list[np.ndarray]:
        """A quantity in each case, over the initial states that complete in all of them."""
        tables = [self.rows(*case) for case in cases]
        done = pd.concat([table["completed"] for table in tables], axis=1).fillna(False)
        common = done.index[done.all(axis=1).astype(bool)]
        return [
            table.loc[common, column(self.phase, quantity)].to_numpy(dtype=float)
            for table in tables
        ]

    def effect(self, name: str, statistic: Statistic, units: int, count: int = 1) -> Effect:
        """A statistic over resampled initial states, one of ``count`` that hold together."""
        return effect(name, statistic, units, self.bootstrap, count)

    def change(self, quantity: str, first: Case, second: Case, count: int) -> Effect:
        """Median relative change from one case to another."""
        a, b = self.values(quantity, first, second)
        name = _change_name(quantity, first, second)
        return self.effect(name, median(b / a - 1.0), len(a), count)

    def mean_change(self, quantity: str, first: Case, second: Case, count: int) -> Effect:
        """Relative change of the mean from one case to another."""

        def average(values: np.ndarray) -> np.ndarray:
            return values.mean(axis=1)

        return self._relative("mean", average, quantity, first, second, count)

    def widening(self, quantity: str, first: Case, second: Case, count: int) -> Effect:
        """Relative change of the spread, from the 5 % to the 95 % quantile."""
        return self._relative("spread", _spread, quantity, first, second, count)

    def shift(self, quantity: str, level: float, first: Case, second: Case, count: int) -> Effect:
        """Relative change of a quantile."""

        def quantile(values: np.ndarray) -> np.ndarray:
            return np.quantile(values, level, axis=1)

        name = f"{100 * level:.0f} % quantile"
        return self._relative(name, quantile, quantity, first, second, count)

    def _relative(
        self,
        name: str,
        of: Callable[[np.ndarray], np.ndarray],
        quantity: str,
        first: Case,
        second: Case,
        count: int,
    ) -> Effect:
        a, b = self.values(quantity, first, second)
        name = f"{name} of {_change_name(quantity, first, second)}"
        return self.effect(name, lambda drawn: of(b[drawn]) / of(a[drawn]) - 1.0, len(a), count)


def _change_name(quantity: str, first: Case, second: Case) -> str:
    (n, t), (m, s) = first, second
    if n == m:
        return f"{WORDS[quantity]}, N {n}, {t:g} to {s:g} s"
    return f"{WORDS[quantity]}, {t:g} s, N {n} to {m}"


def _spread(values: np.ndarray) -> np.ndarray:
    low, high = np.quantile(values, [0.05, 0.95], axis=1)
    return high - low


def infeasible_share(rows: pd.DataFrame, phase: str) -> np.ndarray:
    """1 where a manoeuvre met an infeasible program in a phase or did not complete it, else 0."""
    met = ~rows["completed"]
    for kind in ("softened", "outside", "failed"):
        met = met | (rows[column(phase, kind)] > 0)
    return met.to_numpy(dtype=float)


class Domain:
    """The baseline from every initial state, with where it begins."""

    def __init__(self, grounds: Grounds):
        rows = grounds.rows("studies/domain.parquet", case="baseline", completed=True)
        rows = rows.set_index("sample")
        states = grounds.table("studies/initial-states.parquet").set_index("sample")
        states = states.loc[rows.index]
        self.delta_v = totals(rows, DELTA_V).to_numpy()
        self.time = totals(rows, TIME).to_numpy()
        self.quadrant = states["quadrant"].to_numpy()
        # Quadrants 3 and 4 lie behind the target, on the side without the port.
        self.behind = states["quadrant"].isin([3, 4]).to_numpy()
        distance = states["distance_m"].to_numpy()
        low, high = np.quantile(distance, [1 / 3, 2 / 3])
        self.near, self.far = distance <= low, distance >= high
        self.bootstrap = bootstrap(grounds)

    def effect(self, name: str, statistic: Statistic, count: int = 1) -> Effect:
        """A statistic over resampled initial states, one of ``count`` that hold together."""
        return effect(name, statistic, len(self.time), self.bootstrap, count)


def group_difference(
    values: np.ndarray, second: np.ndarray, first: np.ndarray, level: float
) -> Statistic:
    """Statistic: a quantile in the second group of initial states less that in the first one."""

    def statistic(drawn: np.ndarray) -> np.ndarray:
        a, b = (np.where(group[drawn], values[drawn], np.nan) for group in (first, second))
        of_a, of_b = (stats.quantile(drew, level, axis=1, nan_policy="omit") for drew in (a, b))
        return of_b - of_a

    return statistic
