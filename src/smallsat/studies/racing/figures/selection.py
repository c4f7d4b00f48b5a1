"""Which figures there are: segments of the courses, which may have fewer rings."""

from collections.abc import Mapping
from typing import Any

from smallsat.config import Config
from smallsat.studies.racing.parameters import parameters as racing_parameters


def is_drawn(section: Config, notebook: str, what: Any, parameters: Mapping[str, Any]) -> bool:
    """Whether the courses have what a figure shows."""
    if notebook != "segments":
        return True
    return what <= racing_parameters(section).races[parameters["scenario"]].course.rings
