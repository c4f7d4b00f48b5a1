"""Direct shooting as the document did it; the part is the number of intervals."""

from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.experiments import as_published


def run(step: Step[Configuration]) -> Tables:
    """Solve from the document's guess, converged or not, and keep the iterates."""
    name = f"as-published-k{step.part}"
    solved, path = as_published(step.section, int(step.part))
    return solved.tables(name) | {f"{name}-path.csv": path}
