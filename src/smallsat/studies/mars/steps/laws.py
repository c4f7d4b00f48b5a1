"""Control laws compared in the mission, and from random attitudes."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.laws import missions, monte_carlo, robustness
from smallsat.studies.mars.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly the mission by every law, and every mode from random starts."""
    parameters = Parameters.from_section(step.section)
    summary, errors, missing = missions(step.section, parameters)
    runs, lost = monte_carlo(step.section, parameters)
    return {
        "laws.csv": summary,
        "laws-missions.parquet": errors,
        "laws-runs.parquet": runs,
        "laws-robustness.csv": robustness(runs),
        "laws-not-converged.csv": not_converged_table([*missing, *lost]),
    }
