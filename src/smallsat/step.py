"""A computing step of a study: what it is given, and what it returns.

A step is a module of ``smallsat.studies.<study>.steps`` with one function, ``run``: it takes a
`Step` and returns the tables that it makes, by file name. Each lies in a module of its own, so that
a rule's sources are what its step imports and no more.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np
import pandas as pd

from smallsat.errors import InputError
from smallsat.quantities import Part

# A step that takes a part of a section can be given the whole of it.
Section = TypeVar("Section", bound=Part, covariant=True)
Tables = Mapping[str, pd.DataFrame]


@dataclass(frozen=True)
class Shard:
    """One of several equal shares of the units of a step, numbered from 1."""

    number: int
    count: int

    @classmethod
    def parse(cls, text: str) -> "Shard":
        """Read ``2-of-4``.

        Raises
        ------
        InputError
            If the text is no such share.
        """
        found = re.fullmatch(r"([1-9]\d*)-of-([1-9]\d*)", text)
        if not found or int(found[1]) > int(found[2]):
            raise InputError(f"shard {text!r}: not allowed; from 1-of-N to N-of-N")
        return cls(int(found[1]), int(found[2]))

    @classmethod
    def all(cls, count: int) -> "list[Shard]":
        """Every shard of so many."""
        return [cls(number, count) for number in range(1, count + 1)]

    def __str__(self) -> str:
        return f"{self.number}-of-{self.count}"

    def units(self, total: int) -> np.ndarray:
        """Numbers of its units, from 0: every so-manieth, so that shards take equally long."""
        return np.arange(self.number - 1, total, self.count)


@dataclass(frozen=True)
class Step(Generic[Section]):
    """What a step is given.

    Attributes
    ----------
    section
        The study's section of the configuration, or what the step depends on of it; the type is
        that of the argument of ``run``.
    results
        Folder of the study's results, for the tables of earlier steps.
    published
        Folder of the study's published values.
    accepted
        Folder of what the study has accepted of earlier builds.
    part
        Which part of a step that runs in parts, such as a scenario; else empty.
    shard
        Which share of a step that is shared out; else everything.
    """

    section: Section
    results: Path
    published: Path
    accepted: Path = Path()
    part: str = ""
    shard: Shard = Shard(1, 1)
