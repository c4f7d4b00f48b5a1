"""What is computed for every published value of the rendezvous."""

from smallsat.evidence.grounds import Grounds
from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import not_converged_table
from smallsat.evidence.observation import observations_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.flight_observations import flight_observations
from smallsat.studies.rendezvous.evidence.monte_carlo_observations import study_observations
from smallsat.studies.rendezvous.evidence.observations import observations, undocked


def run(step: Step[Configuration]) -> Tables:
    """Observe, and list the manoeuvres that did not dock."""
    section, results = step.section, step.results
    ledger = Ledger.read(step.published / "values.csv")
    grounds = Grounds(section, results, ledger, {})
    found = [
        *observations(section, results),
        *study_observations(grounds),
        *flight_observations(grounds),
    ]
    return {
        "observations.csv": observations_table(found),
        "not-converged.csv": not_converged_table(undocked(results)),
    }
