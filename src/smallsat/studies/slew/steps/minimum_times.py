"""Least times from rest to rest, by two methods, and a bound below them."""

from itertools import product

import pandas as pd

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods import minimum_time
from smallsat.studies.slew.methods.bound import bound_time
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Find them."""
    parameters = Parameters.from_section(step.section)
    tables, missing = minimum_time.tables(step.section, parameters)
    bounds = [
        {
            "model": name,
            "gravity_gradient": gradient,
            "bound_s": bound_time(parameters, gradient, carried=carried),
        }
        for (name, carried), gradient in product(MODELS.items(), (False, True))
    ]
    return {f"{name}.csv": table for name, table in tables.items()} | {
        "bound.csv": pd.DataFrame(bounds),
        "minimum-times-not-converged.csv": not_converged_table(missing),
    }
