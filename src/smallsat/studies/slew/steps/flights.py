"""Eigenaxis turns, the on-board propagation and the environment's torques."""

from smallsat.step import Step, Tables
from smallsat.studies.slew.methods.environment_study import torque_table
from smallsat.studies.slew.methods.flights import eigenaxis_flights
from smallsat.studies.slew.model.onboard import final_orbit_states
from smallsat.studies.slew.parameters import parameters


def run(step: Step) -> Tables:
    """Simulate what needs no plan."""
    section, given = step.section, parameters(step.section)
    return {
        "flights.parquet": eigenaxis_flights(section, given),
        "orbit.csv": final_orbit_states(section, given),
        "environment.csv": torque_table(section, given),
    }
