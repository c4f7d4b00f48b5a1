"""Sets within the printed axes: searched only when asked for, by the rule's name."""

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.axes_search import search_axes
from smallsat.studies.rendezvous.model.columns import STATE


def run(step: Step[Cases]) -> Tables:
    """Search them, from the sets that the project keeps of its long search."""
    ledger = Ledger.read(step.published / "values.csv")
    kept = read_table(step.accepted / "sets.csv")
    states = read_table(step.results / "studies/initial-states.parquet")[STATE].to_numpy()
    return {"searched-axes.csv": search_axes(step.section, kept, states, ledger)}
