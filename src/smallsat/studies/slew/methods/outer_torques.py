"""The most that each torque of the environment could give to a turn, at the best attitude."""

from itertools import product

import numpy as np
import pandas as pd

from smallsat.dynamics.environment.torques import panel_drag
from smallsat.dynamics.units import KM
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.bound import largest_disturbance
from smallsat.studies.slew.methods.environment_study import AIR
from smallsat.studies.slew.methods.one_axis import eigenaxis_cost
from smallsat.studies.slew.parameters import Parameters

# Directions of the wind that are tried, by polar angle and azimuth.
POLAR, AROUND = 91, 180


def outer_torques(
    section: Configuration, parameters: Parameters, air: pd.DataFrame
) -> pd.DataFrame:
    """Largest torque of each source, in shares of a wheel's, and of the smaller turn's cost.

    At perigee, and at the attitude where it is largest all the time: a bound of what a guidance
    that knew it could save. Drag is that of MSIS-86 (``air`` is the table of densities by altitude
    and solar flux) at the highest solar flux, with the lever of Table 5. The magnetic field is a
    dipole's over the equator, and acts on the dipoles of the configuration, which the document does
    not print.
    """
    radius = parameters.orbit.semi_major_axis * (1.0 - parameters.orbit.eccentricity)
    magnetic = section.beyond.magnetic
    field = magnetic.field_T * (parameters.gravity.radius / radius) ** 3
    largest = {
        "gravity gradient": largest_disturbance(parameters, 1.0),
        f"drag, {AIR[0]}": _largest_drag(parameters, radius, air),
        f"residual dipole, {magnetic.residual_A_m2:g} A m²": magnetic.residual_A_m2 * field,
        f"magnetic torquer, {magnetic.torquer_A_m2:g} A m²": magnetic.torquer_A_m2 * field,
    }
    cost = eigenaxis_cost(parameters, "quarter", parameters.duration)
    return pd.DataFrame(
        [
            {
                "source": source,
                "largest_torque_N_m": torque,
                "share_of_wheel_pct": 100.0 * torque / parameters.torque,
                "share_of_cost_pct": 100.0 * torque * parameters.duration / cost,
            }
            for source, torque in largest.items()
        ]
    )


def _largest_drag(parameters: Parameters, radius: float, air: pd.DataFrame) -> float:
    """N m, over all directions of the wind; not a number where the air is not known."""
    altitude = (radius - parameters.gravity.radius) / KM
    profile = air[air["solar_flux"] == air["solar_flux"].max()]
    rho = np.exp(
        np.interp(
            altitude, profile["altitude_km"], np.log(profile["msis_86_kg_m3"]), np.nan, np.nan
        )
    )
    # At perigee, where it is fastest.
    speed = np.sqrt(parameters.gravity.mu * (2.0 / radius - 1.0 / parameters.orbit.semi_major_axis))
    polar, around = np.linspace(0.0, np.pi, POLAR), np.linspace(0.0, 2.0 * np.pi, AROUND)
    return float(
        max(
            np.linalg.norm(
                panel_drag(parameters.panels, speed * direction, rho, parameters.drag_coefficient)
            )
            for direction in (
                np.array([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)])
                for p, a in product(polar, around)
            )
        )
    )
