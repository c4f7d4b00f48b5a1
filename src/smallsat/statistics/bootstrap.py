"""Effects with bootstrap intervals: percentiles over resampled units."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

# Smaller figures are shown as zero.
NOTHING = 5e-5

Statistic = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Bootstrap:
    """How intervals are drawn.

    Attributes
    ----------
    resamples
        Number of resamples.
    confidence
        Probability with which all intervals of one claim hold together.
    seed
        Seed of the resampling.
    """

    resamples: int
    confidence: float
    seed: int


@dataclass(frozen=True)
class Effect:
    """A quantity with its interval; ``name`` says of what, for a reader."""

    name: str
    value: float
    low: float
    high: float
    units: int

    def __str__(self) -> str:
        value, low, high = (_text(one) for one in (self.value, self.low, self.high))
        return f"{self.name} {value} ({low} to {high})"


def effect(
    name: str, statistic: Statistic, units: int, bootstrap: Bootstrap, comparisons: int = 1
) -> Effect:
    """A statistic and its percentile interval over resampled units.

    Parameters
    ----------
    name
        For the evidence text.
    statistic
        Maps index arrays (resamples, units) to values (resamples,). Quantities of the same units,
        such as two cases from one initial state, are resampled together by indexing both.
    units
        Number of units that are resampled.
    bootstrap
        How the interval is drawn.
    comparisons
        Number of intervals that must hold together; each gets its share of the error (Bonferroni).
    """
    if units == 0:
        return Effect(name, np.nan, np.nan, np.nan, 0)
    everyone = np.arange(units)[None, :]
    tail = 0.5 * (1.0 - bootstrap.confidence) / comparisons
    drawn = _drawn(bootstrap.seed, bootstrap.resamples, units)
    low, high = np.quantile(statistic(drawn), [tail, 1.0 - tail])
    return Effect(name, float(statistic(everyone)[0]), float(low), float(high), units)


# A study asks for the same few numbers of units thousands of times.
@lru_cache(maxsize=8)
def _drawn(seed: int, resamples: int, units: int) -> np.ndarray:
    """Index arrays (resamples, units), read-only, the same at each call."""
    generator = np.random.Generator(np.random.Philox(key=seed))
    drawn = generator.integers(0, units, size=(resamples, units))
    drawn.setflags(write=False)
    return drawn


def _text(value: float) -> str:
    # What rounding leaves of nothing is nothing.
    return "0" if abs(value) < NOTHING else f"{value:.3g}"
