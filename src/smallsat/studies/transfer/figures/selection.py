"""Which figures there are: those of the degrees and numbers of intervals that are solved."""

from collections.abc import Mapping
from typing import Any

from smallsat.studies.transfer.configuration import Configuration


def is_drawn(
    section: Configuration, notebook: str, what: Any, parameters: Mapping[str, Any]
) -> bool:
    """Whether the configuration has what a figure shows."""
    if notebook != "case":
        return True
    degree, intervals = parameters["degree"], parameters["intervals"]
    return degree in (0, *section.degrees) and intervals in (1, *section.intervals)
