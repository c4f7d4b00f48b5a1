"""What the proofs of errata and the predicates of claims rest on."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic

import pandas as pd

from smallsat.evidence.ledger import Ledger, read_artefacts
from smallsat.quantities import Section
from smallsat.results import read_table


@dataclass(frozen=True)
class Grounds(Generic[Section]):
    """The grounds on which one study is judged.

    Attributes
    ----------
    section
        The study's section of the configuration.
    results
        Folder with the results of the study.
    ledger
        The printed numbers of its document.
    captions
        Captions of the document's tables and figures, by their names such as ``Figure A.3``.
    read
        Tables that were read already, by their paths: dozens of claims rest on the same few.
    """

    section: Section
    results: Path
    ledger: Ledger
    captions: Mapping[str, str]
    read: dict[Path, pd.DataFrame] = field(default_factory=dict, repr=False, compare=False)

    def table(self, name: str) -> pd.DataFrame:
        """A table of the results by its file's name; errors as from `read_table`."""
        path = self.results / name
        if path not in self.read:
            self.read[path] = read_table(path)
        # What is written into it is the caller's own.
        return self.read[path].copy(deep=False)

    def rows(self, name: str, **columns: object) -> pd.DataFrame:
        """Rows of a table of the results that have these values in their columns.

        A LookupError where there are none: a what-if run may leave out the case that is asked for.
        """
        table = self.table(name)
        for column, value in columns.items():
            table = table[table[column] == value]
        if table.empty:
            raise LookupError(f"{name}: no rows with {columns}")
        return table


def read_grounds(section: Section, published: Path, results: Path) -> Grounds[Section]:
    """The grounds of a study, with the ledger and captions of its folder of published values."""
    captions = {row["id"]: row["caption"] for row in read_artefacts(published / "artefacts.csv")}
    return Grounds(section, results, Ledger.read(published / "values.csv"), captions)
