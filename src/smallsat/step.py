"""A computing step of a study: what it is given, and what it returns.

A step is a module of ``smallsat.studies.<study>.steps`` with one function, ``run``: it takes a
`Step` and returns the tables that it makes, by file name. Each lies in a module of its own, so that
a rule's sources are what its step imports and no more.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import pandas as pd

from smallsat.quantities import Part
from smallsat.shard import WHOLE, Shard

# A step that takes a part of a section can be given the whole of it.
Section = TypeVar("Section", bound=Part, covariant=True)
Tables = Mapping[str, pd.DataFrame]


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
    shard: Shard = WHOLE
