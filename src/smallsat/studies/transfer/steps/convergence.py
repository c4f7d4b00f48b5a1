"""How fast the direct transcriptions approach the optimum."""

from smallsat.step import Step, Tables
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.convergence import convergence


def run(step: Step[Configuration]) -> Tables:
    """Solve on ever finer meshes and with ever higher degrees."""
    return {"convergence.csv": convergence(step.section)}
