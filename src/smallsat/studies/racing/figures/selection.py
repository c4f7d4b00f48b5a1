"""Which figures there are: segments of the courses, which may have fewer rings."""

from collections.abc import Mapping
from typing import Any

from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.parameters import Parameters


def is_drawn(
    section: Configuration, notebook: str, what: Any, parameters: Mapping[str, Any]
) -> bool:
    """Whether the courses have what a figure shows."""
    if notebook != "segments":
        return True
    return what <= Parameters.from_section(section).races[parameters["scenario"]].course.rings
