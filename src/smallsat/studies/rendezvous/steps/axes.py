"""Whether a set holds the printed axes, from the tracked rounds of the search for one."""

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.axes_held import compared
from smallsat.studies.rendezvous.model.columns import STATE


def run(step: Step[Cases]) -> Tables:
    """Hold its set against the axes, and the configured one."""
    ledger = Ledger.read(step.published / "values.csv")
    searched = read_table(step.accepted / "axes-search.csv")
    states = read_table(step.results / "studies/initial-states.parquet")[STATE].to_numpy()
    found = compared(step.section, searched, states, ledger)
    return {
        "axes-search.csv": searched,
        **{f"{name}.csv": table for name, table in found.items()},
    }
