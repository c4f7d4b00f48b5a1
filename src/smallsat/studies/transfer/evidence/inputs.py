"""Inputs of the document that we derive from others: what a printed one is compared with."""

import numpy as np

from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.model.problem import TransferProblem

# lambda_theta, lambda_m and the Hamiltonian at the end (equations 35, 36, 37).
TRANSVERSALITY = (0.0, 1.0, 0.0)


def initial_state(section: Configuration) -> np.ndarray:
    """State (5,) on the initial orbit."""
    return TransferProblem.of(section.problem).initial_state


def final_state(section: Configuration) -> np.ndarray:
    """Radius, radial speed and circular speed on the final orbit (3,)."""
    problem = TransferProblem.of(section.problem)
    return np.array([problem.final_radius, 0.0, problem.final_speed])


def case_count(section: Configuration) -> int:
    """Number of direct multiple shooting cases."""
    return len(section.degrees) * len(section.intervals)
