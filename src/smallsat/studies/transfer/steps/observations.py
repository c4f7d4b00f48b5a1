"""What is computed for every published value of the orbit transfer."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import joined
from smallsat.evidence.observation import observations_table
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.evidence.observations import observe, seconds

# Experiments whose cases we must solve; what the document's own method leaves unsolved is a result.
OURS = ("indirect", "converged", "unbounded", "continuous", "multistart", "collocation")


def run(step: Step[Configuration]) -> Tables:
    """Observe, list what did not converge, and find our seconds for the printed ones."""
    rows = Ledger.read(step.published / "values.csv").rows
    measured = [
        read_table(step.results / f"{name}-seconds.csv") for name in ("indirect", "as-published")
    ]
    return {
        "observations.csv": observations_table(observe(rows, step.results)),
        "not-converged.csv": joined(step.results, OURS),
        "timings.csv": seconds(rows, step.results, pd.concat(measured)),
    }
