"""Values of ours that printed inputs feed and that are no single key of the configuration."""

import numpy as np

from smallsat.config import Config
from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES, COMPARED
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.parameters import start_state


def number_of_phases(config: Config) -> int:
    """Phases of the guidance law."""
    return len(PHASES)


def number_of_cases(config: Config) -> int:
    """Cases with a table of their own."""
    return len(CASE_TABLES)


def number_of_compared(config: Config) -> int:
    """Manoeuvres that Section 3.6.4 compares."""
    return len(COMPARED)


def thruster_mN(config: Config) -> float:
    """Force of a thruster, mN."""
    return 1000.0 * config["rendezvous"]["spacecraft"]["thruster_N"]


def start_distance_km(config: Config) -> float:
    """Distance of the start, km."""
    return float(np.linalg.norm(start_state(config["rendezvous"])[:3])) / 1000.0


def far_state_weight(config: Config) -> np.ndarray:
    """Q of the far range, (6, 6)."""
    return np.diag(config["rendezvous"]["phases"]["far"]["state_weights"])


def mean_accelerations(config: Config) -> dict[str, float]:
    """What the control bounds are in the printed unit, m/s^2: velocity change over sample time."""
    return {
        name: phase["control_bound_m_s"] / phase["sample_time_s"]
        for name, phase in config["rendezvous"]["phases"].items()
    }
