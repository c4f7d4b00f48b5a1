"""Errata: printed values and formulas that are wrong, each with a proof that runs."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from smallsat.errors import InputError
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.printed import parse_printed
from smallsat.evidence.reference import resolve

# What an entry says of an erratum, and what its proof finds.
ENTRY_COLUMNS = ("key", "locator", "printed", "correct", "explanation")
PROOF_COLUMNS = ("as_printed", "as_corrected", "statement", "holds")
ERRATA_COLUMNS = (*ENTRY_COLUMNS, *PROOF_COLUMNS)
_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?(e[+-]?\d+)?", re.IGNORECASE)


@dataclass(frozen=True)
class Proof:
    """The outcome of recomputing a quantity both ways.

    Attributes
    ----------
    holds
        Whether the recomputation proves the erratum.
    as_printed, as_corrected
        What follows from the printed and from the corrected value, in words or figures.
    statement
        One sentence that a reader can check: what was computed, and what it shows.
    correct
        What would have to be printed: a number in the printed unit, or words. The entry's own
        ``correct`` is held to it; an entry that has none gets the words. Empty where a formula or a
        sentence is corrected, which the entry alone can say.
    """

    holds: bool | np.bool
    as_printed: str
    as_corrected: str
    statement: str
    correct: float | str = ""


ProofFunction = Callable[[Grounds], Proof]


def prove_errata(entries: list[dict[str, Any]], grounds: Grounds, path: str) -> pd.DataFrame:
    """Run every proof; one row an erratum with what the proof found.

    An erratum whose entry corrects to another number than its proof computes does not hold.

    Parameters
    ----------
    entries
        Entries of ``errata.yaml``.
    grounds
        What the proofs rest on.
    path
        Name of the file the entries come from, for messages.
    """
    rows = []
    for entry in entries:
        prove: ProofFunction = resolve(entry["proof"], path)
        try:
            proof = prove(grounds)
        except LookupError:
            # A what-if run may leave out the case that a proof needs.
            proof = Proof(False, "", "", "not computed: this run leaves out a case that it needs")
        row = {name: entry.get(name, "") for name in ENTRY_COLUMNS}
        row |= {name: getattr(proof, name) for name in PROOF_COLUMNS} | {"holds": bool(proof.holds)}
        if "correct" not in entry and isinstance(proof.correct, str):
            row["correct"] = proof.correct
        elif not _corrects_to(row["correct"], proof.correct, f"{path}: '{entry['key']}'"):
            found = proof.correct if isinstance(proof.correct, str) else f"{proof.correct:.7g}"
            row["holds"] = False
            row["statement"] = (
                f"the correction '{row['correct']}' is not what the proof finds, '{found}'. "
                f"{proof.statement}"
            )
        rows.append(row)
    return pd.DataFrame(rows, columns=list(ERRATA_COLUMNS))


def _corrects_to(correct: float | str, found: float | str, where: str) -> bool:
    """Whether a correction is what a proof found: the same words, or a number to its own digits.

    In a correction with more words than a number the first number counts.
    """
    text = str(correct)
    if isinstance(found, str):
        return found in ("", text)
    first = _NUMBER.search(text)
    number = parse_printed(text) or (parse_printed(first[0]) if first else None)
    if number is None:
        raise InputError(f"{where}: 'correct' is {text!r}; needed: the number that its proof finds")
    return number.matches(found)
