"""Prose claims: a place in a document, a paraphrase, and a predicate over the results."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import pandas as pd

from smallsat.evidence.grounds import Grounds
from smallsat.evidence.reference import resolve

CLAIM_COLUMNS = ("id", "locator", "claim", "outcome", "evidence")
Outcome = Literal["holds", "fails", "undecided"]


@dataclass(frozen=True)
class Judgement:
    """What the results say of a claim, and the figures it rests on."""

    outcome: Outcome
    evidence: str

    def remarked(self, remark: str) -> "Judgement":
        """The same outcome, with a remark after its evidence."""
        return Judgement(self.outcome, f"{self.evidence}; {remark}")


Predicate = Callable[[Grounds], Judgement]


def judged(condition: bool | np.bool, evidence: str) -> Judgement:
    """A claim that either holds or fails."""
    return Judgement("holds" if condition else "fails", evidence)


def judge_claims(entries: list[dict[str, Any]], grounds: Grounds, path: str) -> pd.DataFrame:
    """Apply every predicate to the results; one row a claim.

    ``entries`` are those of ``claims.yaml``, and ``path`` names that file in messages.
    """
    rows = []
    for entry in entries:
        predicate: Predicate = resolve(entry["predicate"], path)
        try:
            judgement = predicate(grounds)
        except LookupError:
            # A what-if run may leave out the case that a predicate needs.
            judgement = Judgement("undecided", "this run leaves out a case that it needs")
        row = {name: entry[name] for name in CLAIM_COLUMNS[:3]}
        rows.append(row | {"outcome": judgement.outcome, "evidence": judgement.evidence})
    return pd.DataFrame(rows, columns=list(CLAIM_COLUMNS))
