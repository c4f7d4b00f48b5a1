"""Parameter sets that give what is printed; the part is the search, a reading at an option."""

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.search import search
from smallsat.studies.rendezvous.model.columns import STATE


def run(step: Step[Cases]) -> Tables:
    """Search them, from those that the project keeps of a longer search."""
    ledger = Ledger.read(step.published / "values.csv")
    kept = read_table(step.accepted / "sets.csv")
    states = read_table(step.results / "studies/initial-states.parquet")
    starts = states[STATE].to_numpy()[: step.section.inference.starts]
    return {f"search-{step.part}.parquet": search(step.section, step.part, kept, starts, ledger)}
