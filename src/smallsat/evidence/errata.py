"""Errata: printed values and formulas that are wrong, each with a proof that runs."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from smallsat.config import Config
from smallsat.evidence.reference import resolve

ERRATA_COLUMNS = (
    "key",
    "locator",
    "printed",
    "correct",
    "explanation",
    "as_printed",
    "as_corrected",
    "statement",
    "holds",
)


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
    """

    holds: bool
    as_printed: str
    as_corrected: str
    statement: str


ProofFunction = Callable[[Config, Path], Proof]


def prove_errata(
    entries: list[dict[str, Any]], config: Config, results: Path, path: str
) -> pd.DataFrame:
    """Run every proof; one row an erratum with what the proof found.

    Parameters
    ----------
    entries
        Entries of ``errata.yaml``.
    config
        The configuration, at least its section for this study.
    results
        Folder with the results of the study, which proofs may read.
    path
        Name of the file the entries come from, for messages.
    """
    rows = []
    for entry in entries:
        prove: ProofFunction = resolve(entry["proof"], path)
        try:
            proof = prove(config, results)
        except LookupError:
            # A what-if run may leave out the case that a proof needs.
            proof = Proof(False, "", "", "not computed: this run leaves out a case that it needs")
        row = {name: entry.get(name, "") for name in ERRATA_COLUMNS[:5]}
        row |= {
            "as_printed": proof.as_printed,
            "as_corrected": proof.as_corrected,
            "statement": proof.statement,
            "holds": bool(proof.holds),
        }
        rows.append(row)
    return pd.DataFrame(rows, columns=list(ERRATA_COLUMNS))
