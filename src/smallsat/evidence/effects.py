"""Statistical claims: effects with bootstrap intervals, and the outcome that they decide."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from smallsat.evidence.claims import Judgement, Outcome

# Fewer units than this decide nothing: their resamples hardly differ.
FEWEST = 10
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
        Of all intervals of one claim together.
    seed
        Of the resampling.
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
    generator = np.random.Generator(np.random.Philox(key=bootstrap.seed))
    drawn = generator.integers(0, units, size=(bootstrap.resamples, units))
    tail = 0.5 * (1.0 - bootstrap.confidence) / comparisons
    low, high = np.quantile(statistic(drawn), [tail, 1.0 - tail])
    return Effect(name, float(statistic(everyone)[0]), float(low), float(high), units)


def above(effects: Sequence[Effect], threshold: float = 0.0) -> Outcome:
    """Holds if all intervals lie above the threshold, fails if one lies below it."""
    if _too_few(effects):
        return "undecided"
    if all(one.low > threshold for one in effects):
        return "holds"
    return "fails" if any(one.high < threshold for one in effects) else "undecided"


def within(effects: Sequence[Effect], margin: float) -> Outcome:
    """Holds if all intervals lie within the margin of zero, fails if one lies outside."""
    if _too_few(effects):
        return "undecided"
    if all(-margin < one.low and one.high < margin for one in effects):
        return "holds"
    outside = any(one.low > margin or one.high < -margin for one in effects)
    return "fails" if outside else "undecided"


def together(*outcomes: Outcome) -> Outcome:
    """Of several parts of one claim: holds if all do, fails if one does."""
    if "fails" in outcomes:
        return "fails"
    return "undecided" if "undecided" in outcomes else "holds"


def judgement(outcome: Outcome, reading: str, effects: Sequence[Effect]) -> Judgement:
    """The outcome with how the claim was read and the effects that decide it."""
    fewest = min((one.units for one in effects), default=0)
    few = f"; only {fewest} units" if fewest < FEWEST else ""
    return Judgement(outcome, f"{reading}: {', '.join(str(one) for one in effects)}{few}")


def _text(value: float) -> str:
    # What rounding leaves of nothing is nothing.
    return "0" if abs(value) < NOTHING else f"{value:.3g}"


def _too_few(effects: Sequence[Effect]) -> bool:
    return not effects or any(one.units < FEWEST or np.isnan(one.value) for one in effects)
