"""The Mars mission to turn and play."""

from pathlib import Path

import numpy as np

from smallsat.drawing.interactive import Scene, Track, sphere
from smallsat.drawing.style import BLUE, GREEN, ORANGE, VERMILION
from smallsat.dynamics.attitude.mrp import mrp_to_dcm
from smallsat.dynamics.orbits.circular_orbits import position
from smallsat.dynamics.units import KM
from smallsat.results import read_table
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.parameters import Parameters

SIGMA = ["sigma_1", "sigma_2", "sigma_3"]
# Of the rows, one a second.
THINNED = 20
# Length of the body axes, in radii of the nano-satellite's orbit, so that they can be seen.
ARM = 0.5
ARMS = {"antenna, -b1": (-1.0, 0, VERMILION), "solar panel, b3": (1.0, 2, GREEN)}


def scenes(section: Configuration, results: Path) -> list[Scene]:
    """The mission: both spacecraft, and where the antenna and the solar panel point."""
    parameters = Parameters.from_section(section)
    flown = read_table(results / "trajectories.parquet")
    own = flown[flown["run"] == "mission"].iloc[::THINNED]
    times = own["time_s"].to_numpy()
    lmo, gmo = (
        np.array([position(orbit, time) for time in times]) / KM
        for orbit in (parameters.lmo, parameters.gmo)
    )
    axes = np.array([mrp_to_dcm(tuple(sigma)) for sigma in own[SIGMA].to_numpy()])
    radius = float(np.linalg.norm(lmo[0]))
    tips = [
        Track(name, colour, times, lmo + sign * ARM * radius * axes[:, row])
        for name, (sign, row, colour) in ARMS.items()
    ]
    return [
        Scene(
            "mission",
            "The mission: where antenna and solar panel point",
            "Mars, the orbits of the nano-satellite and of the mothercraft, and the paths of the "
            "tips of the antenna axis and of the solar panel axis, drawn long.",
            "figures/mars/fig-13",
            "km",
            [
                Track("nano-satellite", BLUE, times, lmo),
                Track("mothercraft", ORANGE, times, gmo),
                *tips,
            ],
            [sphere(parameters.mars_radius / KM, "#b5532a", "Mars", 1.0)],
        )
    ]
