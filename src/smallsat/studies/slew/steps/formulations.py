"""What the document says of its formulation, tried: points, angles and numbers of points."""

from dataclasses import asdict
from itertools import product

import pandas as pd

from smallsat.optimal_control.collocation_schemes import SCHEMES, Errors, errors
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.gradient_forms import compared_forms
from smallsat.studies.slew.methods.node_sweep import node_sweep
from smallsat.studies.slew.parameters import Parameters

# Points of collocation of the problem whose solution is known.
POINTS = (5, 10, 15, 20)


def run(step: Step[Configuration]) -> Tables:
    """Try them."""
    section, parameters = step.section, Parameters.from_section(step.section)
    schemes = [
        {"scheme": scheme, "points": count} | rounded(errors(scheme, count))
        for count, scheme in product(POINTS, SCHEMES)
    ]
    return {
        "collocation.csv": pd.DataFrame(schemes),
        "gradient-forms.csv": compared_forms(section, parameters),
        "nodes.csv": node_sweep(section, parameters),
    }


def rounded(found: Errors) -> dict:
    """As a row of a table, to the digits that rounding leaves alike."""
    return {
        name: value if name == "converged" else float(f"{value:.1e}")
        for name, value in asdict(found).items()
    }
