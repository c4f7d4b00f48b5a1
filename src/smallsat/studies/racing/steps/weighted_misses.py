"""What weights of a miss do, around the multipliers of the rings."""

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.weighted_misses import multiplier_table, weight_sweep
from smallsat.studies.racing.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Fly it."""
    parameters = Parameters.from_section(step.section)
    weights, missing = weight_sweep(parameters, step.section)
    return {
        "ring-multipliers.csv": multiplier_table(parameters, step.section),
        "miss-weights.csv": weights,
        "miss-weights-not-converged.csv": not_converged_table(missing),
    }
