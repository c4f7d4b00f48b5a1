"""Is the optimum one: finer meshes, other starts, thrusts and places."""

import pandas as pd

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.methods import checks
from smallsat.studies.racing.parameters import SCENARIOS, parameters


def run(step: Step) -> Tables:
    """Check the optima."""
    section, given = step.section, parameters(step.section)
    parts: dict[str, list[checks.Checked]] = {
        "meshes": [checks.mesh_refinement(given, section, name) for name in SCENARIOS],
        "other-starts": [(checks.other_starts(given, section, name), []) for name in SCENARIOS],
        "thrust-sweep": [checks.thrust_sweep(given, section, SCENARIOS[0])],
        "random-positions": [checks.start_positions(given, section, SCENARIOS[1])],
    }
    missing = [case for found in parts.values() for part in found for case in part[1]]
    return {
        f"{name}.csv": pd.concat([part[0] for part in found], ignore_index=True)
        for name, found in parts.items()
    } | {"checks-not-converged.csv": not_converged_table(missing)}
