"""Figure 2: gravity gradient against drag over altitude, with the assumptions as a band."""

from itertools import product
from math import nan

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from smallsat.dynamics.environment.torques import ATMOSPHERE, density, gravity_gradient, panel_drag
from smallsat.dynamics.orbits.kepler_orbits import perifocal_frame
from smallsat.dynamics.units import DAY, KM
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.model.simulation import EARTH_RATE
from smallsat.studies.slew.parameters import Parameters, panels

SAMPLE_S = 60.0
# Models of the air in the table of densities. The document's own is a fit of the first.
AIR = ("MSIS-86", "NRLMSISE-00")
AIR_COLUMNS = (
    "atmosphere",
    "solar_flux",
    "altitude_km",
    "density_kg_m3",
    "gravity_gradient_N_m",
    "drag_N_m",
    "equal_lever_mm",
)


def torque_table(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """Mean torques, N m, on a body at rest in inertial space over the study's time.

    Circular orbits in the plane of the document's. One row an altitude, offset of the centre of
    pressure and factor of the density.
    """
    entry = section.environment
    roll, pitch, yaw = entry.attitude_deg
    # Rows are the body axes in the inertial frame.
    dcm = Rotation.from_euler("ZYX", [yaw, pitch, roll], degrees=True).as_matrix().T
    frame = perifocal_frame(parameters.orbit)
    times = np.arange(0.0, entry.duration_days * DAY, SAMPLE_S)
    by_offset = {mm: panels(section.spacecraft, offset=mm / KM) for mm in entry.offsets_mm}
    rows = []
    for altitude in entry.altitudes_km:
        radius = parameters.gravity.radius + altitude * KM
        rate = np.sqrt(parameters.gravity.mu / radius**3)
        gradient: list[float] = []
        drags: dict[float, list[float]] = {mm: [] for mm in by_offset}
        rho = density(altitude * KM, ATMOSPHERE)
        for angle in rate * times:
            r = radius * (np.cos(angle) * frame[0] + np.sin(angle) * frame[1])
            v = radius * rate * (np.cos(angle) * frame[1] - np.sin(angle) * frame[0])
            wind = dcm @ (v - np.cross([0.0, 0.0, EARTH_RATE], r))
            gradient.append(
                float(
                    np.linalg.norm(
                        gravity_gradient(parameters.inertia, dcm @ r, parameters.gravity.mu)
                    )
                )
            )
            for mm, shape in by_offset.items():
                drag = panel_drag(shape, wind, rho, parameters.drag_coefficient)
                drags[mm].append(float(np.linalg.norm(drag)))
        for mm, found in drags.items():
            for factor in entry.density_factors:
                rows.append(
                    {
                        "altitude_km": altitude,
                        "offset_mm": mm,
                        "density_factor": factor,
                        "gravity_gradient_N_m": float(np.mean(gradient)),
                        "drag_N_m": factor * float(np.mean(found)),
                    }
                )
    return pd.DataFrame(rows)


def with_density(
    section: Configuration, table: pd.DataFrame, densities: pd.DataFrame
) -> pd.DataFrame:
    """Drag with the lever of Table 5 in other air, by altitude, solar flux and model of the air.

    Drag is proportional to the density, so that the torques of `torque_table` need no second
    computation. It is proportional to the lever too, since the panels are symmetric but for that:
    the last column is the lever, mm, with which drag and gradient would be equal.

    Parameters
    ----------
    section
        The study's section.
    table
        That of `torque_table`.
    densities
        Altitude, km, solar flux, and density, kg/m^3, by model; logarithms are linear in between.
    """
    lever = printed_lever_mm(section)
    known = table[np.isclose(table["offset_mm"], lever) & np.isclose(table["density_factor"], 1.0)]
    models = {name: f"{name.lower().replace('-', '_')}_kg_m3" for name in AIR}
    rows = []
    for flux, profile in densities.groupby("solar_flux"):
        heights = profile["altitude_km"].to_numpy()
        within = known[known["altitude_km"].between(heights.min(), heights.max())]
        for (name, column), row in product(models.items(), within.to_dict("records")):
            altitude = row["altitude_km"]
            rho = float(np.exp(np.interp(altitude, heights, np.log(profile[column]))))
            drag = row["drag_N_m"] * rho / float(density(altitude * KM, ATMOSPHERE))
            rows.append(
                {
                    "atmosphere": name,
                    "solar_flux": flux,
                    "altitude_km": altitude,
                    "density_kg_m3": rho,
                    "gravity_gradient_N_m": row["gravity_gradient_N_m"],
                    "drag_N_m": drag,
                    "equal_lever_mm": lever * row["gravity_gradient_N_m"] / drag,
                }
            )
    return pd.DataFrame(rows, columns=list(AIR_COLUMNS))


def printed_lever_mm(section: Configuration) -> float:
    """How far Table 5 has the centre of pressure of the long panels off the centre, mm."""
    return abs(float(panels(section.spacecraft)[0, 5])) * KM


def crossover_km(table: pd.DataFrame, offset_mm: float, factor: float = 1.0) -> float:
    """Altitude above which the gravity gradient is the larger; the lowest one if it always is.

    Not a number if it is not at the highest.
    """
    rows = table[
        np.isclose(table["offset_mm"], offset_mm) & np.isclose(table["density_factor"], factor)
    ]
    rows = rows.sort_values("altitude_km")
    ratio = np.log(rows["gravity_gradient_N_m"].to_numpy() / rows["drag_N_m"].to_numpy())
    altitude = rows["altitude_km"].to_numpy()
    if ratio[0] >= 0.0:
        return float(altitude[0])
    if ratio[-1] < 0.0:
        return nan
    last = int(np.flatnonzero(ratio < 0.0)[-1])
    return float(np.interp(0.0, ratio[last : last + 2], altitude[last : last + 2]))
