"""Eigenaxis turns, the on-board propagation and the environment's torques."""

import numpy as np

from smallsat.dynamics.units import KM
from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.environment_study import torque_table, with_density
from smallsat.studies.slew.methods.flights import eigenaxis_flights
from smallsat.studies.slew.methods.outer_torques import outer_torques
from smallsat.studies.slew.model.onboard import final_orbit_states
from smallsat.studies.slew.parameters import Parameters


def run(step: Step[Configuration]) -> Tables:
    """Simulate what needs no plan."""
    section, parameters = step.section, Parameters.from_section(step.section)
    ledger = Ledger.read(step.published / "values.csv")
    position, velocity = (ledger.values(f"table-2/{name}") for name in ("r-0", "v-0"))
    start = KM * np.array([*position, *velocity], dtype=float)
    environment = torque_table(section, parameters)
    air = read_table(step.accepted / "density.csv")
    return {
        "flights.parquet": eigenaxis_flights(section, parameters),
        "orbit.csv": final_orbit_states(section, parameters, start),
        "environment.csv": environment,
        "atmospheres.csv": with_density(section, environment, air),
        "outer-torques.csv": outer_torques(section, parameters, air),
    }
