"""Statistical claims: the outcome that effects with their intervals decide."""

from collections.abc import Sequence

import numpy as np

from smallsat.evidence.claims import Judgement, Outcome
from smallsat.statistics.bootstrap import Effect

# Fewer units than this decide nothing: their resamples hardly differ.
FEWEST = 10


def above(effects: Sequence[Effect], threshold: float = 0.0) -> Outcome:
    """Holds if all intervals lie above the threshold, fails if one lies below it."""
    if _too_few(effects):
        return "undecided"
    if all(one.low > threshold for one in effects):
        return "holds"
    return "fails" if any(one.high < threshold for one in effects) else "undecided"


def below(effects: Sequence[Effect], threshold: float) -> Outcome:
    """Holds if all intervals lie below the threshold, fails if one lies above it."""
    return above(negative(effects), -threshold)


def negative(effects: Sequence[Effect]) -> list[Effect]:
    """The effects with their signs turned, for a claim of a decrease."""
    return [Effect(e.name, -e.value, -e.high, -e.low, e.units) for e in effects]


def within(effects: Sequence[Effect], margin: float) -> Outcome:
    """Holds if all intervals lie within the margin of zero, fails if one lies outside."""
    if _too_few(effects):
        return "undecided"
    if all(-margin < one.low and one.high < margin for one in effects):
        return "holds"
    outside = any(one.low > margin or one.high < -margin for one in effects)
    return "fails" if outside else "undecided"


def together(*outcomes: Outcome) -> Outcome:
    """A claim of several parts holds if all of them do, and fails if one does."""
    if "fails" in outcomes:
        return "fails"
    return "undecided" if "undecided" in outcomes else "holds"


def judgement(outcome: Outcome, reading: str, effects: Sequence[Effect]) -> Judgement:
    """The outcome with how the claim was read and the effects that decide it."""
    fewest = min((one.units for one in effects), default=0)
    few = f"; only {fewest} units" if fewest < FEWEST else ""
    return Judgement(outcome, f"{reading}: {', '.join(str(one) for one in effects)}{few}")


def _too_few(effects: Sequence[Effect]) -> bool:
    return not effects or any(one.units < FEWEST or np.isnan(one.value) for one in effects)
