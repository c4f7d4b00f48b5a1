"""Parameter sets that give the printed tables; the part is the side of the R-bar."""

from smallsat.evidence.ledger import Ledger
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.search import search


def run(step: Step[Cases]) -> Tables:
    """Search them."""
    ledger = Ledger.read(step.published / "values.csv")
    return {f"search-{step.part}.parquet": search(step.section, step.part, ledger)}
