"""Which figures there are: sweeps of the horizons that are flown."""

from collections.abc import Mapping
from typing import Any

from smallsat.studies.rendezvous.configuration import Configuration


def is_drawn(
    section: Configuration, notebook: str, what: Any, parameters: Mapping[str, Any]
) -> bool:
    """Whether the configuration has what a figure shows."""
    return notebook != "sweep" or what in section.studies[parameters["phase"]].horizons
