"""Values of ours that printed inputs feed and that are no single key of the configuration."""

import numpy as np

from smallsat.dynamics.units import MINUTE
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES, COMPARED
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.parameters import start_state


def number_of_phases(section: Configuration) -> int:
    """Phases of the guidance law."""
    return len(PHASES)


def number_of_cases(section: Configuration) -> int:
    """Cases with a table of their own."""
    return len(CASE_TABLES)


def number_of_compared(section: Configuration) -> int:
    """Manoeuvres that Section 3.6.4 compares."""
    return len(COMPARED)


def thruster_mN(section: Configuration) -> float:
    """Force of a thruster, mN."""
    return 1000.0 * section.spacecraft.thruster_N


def start_distance_km(section: Configuration) -> float:
    """Distance of the start, km."""
    return float(np.linalg.norm(start_state(section)[:3])) / 1000.0


def far_state_weight(section: Configuration) -> np.ndarray:
    """Q of the far range, (6, 6)."""
    return np.diag(section.phases.far.state_weights)


def mean_accelerations(section: Configuration) -> dict[str, float]:
    """What the control bounds are in the printed unit, m/s^2: velocity change over sample time."""
    return {name: phase.control_bound_m_s / phase.sample_time_s for name, phase in section.phases}


def docking_look_ahead_min(section: Configuration) -> float:
    """How far the docking phase predicts, min."""
    final = section.phases.final
    return final.horizon * final.sample_time_s / MINUTE
