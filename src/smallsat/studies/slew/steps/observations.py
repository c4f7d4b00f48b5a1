"""What is computed for every published value of the slews."""

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import joined
from smallsat.evidence.observation import observations_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.observations import observations, timings
from smallsat.studies.slew.parameters import Parameters

# Steps that solve, and list what they did not solve in a table of their own.
SOLVING = (
    "minimum-times",
    "plans",
    "trade-off",
    "degradation",
    "tracking",
    "models",
    "savings",
    "wheel-states",
)


def run(step: Step[Configuration]) -> Tables:
    """Observe, list what did not converge, and find our seconds for the printed ones."""
    section, parameters, results = step.section, Parameters.from_section(step.section), step.results
    ledger = Ledger.read(step.published / "values.csv")
    return {
        "observations.csv": observations_table(observations(section, parameters, results, ledger)),
        "not-converged.csv": joined(results, SOLVING),
        "timings.csv": timings(parameters, results),
    }
