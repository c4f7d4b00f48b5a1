"""How far ahead linear models predict near an elliptic orbit."""

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.methods import elliptic_prediction


def run(step: Step[Configuration]) -> Tables:
    """Compare them with two-body motion."""
    found = elliptic_prediction.errors(step.section)
    return {
        "elliptic.csv": found,
        "elliptic-horizons.csv": elliptic_prediction.at_horizons(step.section, found),
    }
