"""Chapter 6 from the tracked tables of what was measured; no emulator is needed."""

import pandas as pd

from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.flight_computer.cycles import bounded
from smallsat.studies.rendezvous.flight_computer.provenance import fingerprint

TAKEN = ("runs.csv", "classes.csv", "memory.csv", "answers.csv", "link.csv")


def run(step: Step[Configuration]) -> Tables:
    """Take the tables, bound the cycles, and say whether this run would measure the same."""
    folder = step.accepted / "flight"
    tables = {name: read_table(folder / name) for name in TAKEN}
    tables["cycles.csv"] = bounded(tables["classes.csv"], step.section.flight_computer)
    tables["provenance.csv"] = _compared(read_table(folder / "provenance.csv"), step.section)
    return {f"flight/{name}": table for name, table in tables.items()}


def _compared(provenance: pd.DataFrame, section: Configuration) -> pd.DataFrame:
    """The provenance with what this run has in place of each digest."""
    here = provenance["item"].map(fingerprint(section))
    return provenance.assign(
        here=[
            "" if pd.isna(own) else "the same" if own == value else "another: taken all the same"
            for own, value in zip(here, provenance["value"], strict=True)
        ]
    )
