"""Claims over the ensemble: what rests on inferred parameters is judged with many sets of them."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import wraps

from smallsat.evidence.claims import Judgement, Outcome
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.inference.parameter_set import member

Predicate = Callable[[Grounds[Configuration]], Judgement]


def members(grounds: Grounds[Configuration]) -> list[Grounds[Configuration]]:
    """The grounds of each set of the ensemble that is acceptable, of its own results."""
    found = []
    for number in range(1, grounds.section.inference.ensemble.sets + 1):
        folder = f"ensemble/{number:02d}"
        row = grounds.table(f"{folder}/set.csv").to_dict("records")[0]
        if row["acceptable"]:
            found.append(
                replace(
                    grounds,
                    section=member(grounds.section, row),
                    results=grounds.results / folder,
                )
            )
    return found


def over_ensemble(predicate: Predicate) -> Predicate:
    """Judge by the configured set at full size, and by every set of the ensemble at a smaller one.

    A claim holds, or fails, where the configured set and the stated share of the ensemble's sets
    say so; sets that cannot tell, for want of samples or of a manoeuvre that ends, do not count
    towards either, and at least half of them must be able to tell.
    """

    @wraps(predicate)
    def judged(grounds: Grounds[Configuration]) -> Judgement:
        own = predicate(grounds)
        outcomes: Counter[Outcome] = Counter()
        sets = members(grounds)
        for one in sets:
            try:
                outcomes[predicate(one).outcome] += 1
            except LookupError:
                outcomes["undecided"] += 1
        told = outcomes["holds"] + outcomes["fails"]
        agree = grounds.section.inference.ensemble.agree
        agreed = own.outcome != "undecided" and outcomes[own.outcome] >= agree * max(told, 1)
        outcome: Outcome = own.outcome if agreed and 2 * told >= len(sets) else "undecided"
        return Judgement(
            outcome,
            f"configured set: {own.outcome}; {own.evidence}. Of {len(sets)} acceptable sets it "
            f"holds with {outcomes['holds']}, fails with {outcomes['fails']}, and "
            f"{outcomes['undecided']} cannot tell",
        )

    return judged
