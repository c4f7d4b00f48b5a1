"""Races through rings that drift."""

import pandas as pd

from smallsat.evidence.not_converged import not_converged_table
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.drifting_rings import drifting_races
from smallsat.studies.racing.parameters import SCENARIOS, Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly them."""
    parameters = Parameters.from_section(step.section)
    fixed = pd.concat(
        [read_table(step.results / f"optima-{scenario}-races.csv") for scenario in SCENARIOS]
    )
    races, missing = drifting_races(parameters, step.section, fixed)
    return {
        "drifting-rings.csv": races,
        "drifting-rings-not-converged.csv": not_converged_table(missing),
    }
