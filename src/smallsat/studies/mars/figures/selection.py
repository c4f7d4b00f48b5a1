"""Which figures there are: scenes of the mission's answer times."""

from collections.abc import Mapping
from typing import Any

from smallsat.studies.mars.configuration import Configuration


def is_drawn(
    section: Configuration, notebook: str, what: Any, parameters: Mapping[str, Any]
) -> bool:
    """Whether the configuration has what a figure shows."""
    return notebook != "scenes" or what < len(section.answer_times_s.mission)
