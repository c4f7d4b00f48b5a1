"""Is the optimum one: finer meshes, other starts, thrusts and places."""

import pandas as pd

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods import checks
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Check the optima."""
    section, parameters = step.section, Parameters.from_section(step.section)
    parts: dict[str, list[checks.Checked]] = {
        "meshes": [checks.mesh_refinement(parameters, section, name) for name in SCENARIOS],
        "other-starts": [
            (checks.other_starts(parameters, section, name), []) for name in SCENARIOS
        ],
        "thrust-sweep": [checks.thrust_sweep(parameters, section, SCENARIOS[0])],
        "random-positions": [checks.start_positions(parameters, section, SCENARIOS[1])],
    }
    missing = [case for found in parts.values() for part in found for case in part[1]]
    return {
        f"{name}.csv": pd.concat([part[0] for part in found], ignore_index=True)
        for name, found in parts.items()
    } | {"checks-not-converged.csv": not_converged_table(missing)}
