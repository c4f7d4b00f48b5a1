"""Chapter 6 measured on an emulator: done only when asked for, by `make flight`."""

import tempfile
from pathlib import Path

from smallsat.errors import InputError
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.flight_computer import emulator, link
from smallsat.studies.rendezvous.flight_computer.measurement import measure


def run(step: Step[Configuration]) -> Tables:
    """Count instructions, and fly a rendezvous over a socket."""
    lacking = emulator.missing(*emulator.MEASURING, *link.FLYING, str(emulator.GENERATOR))
    if lacking:
        raise InputError(f"not there: {', '.join(lacking)}; `make flight` installs what it may")
    with tempfile.TemporaryDirectory() as folder:
        tables = measure(step.section) | {"link.csv": link.fly(step.section, Path(folder))}
    return {f"flight/measured/{name}": table for name, table in tables.items()}
