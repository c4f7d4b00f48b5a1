"""The slews to turn and play: where the body axes point."""

import re
from pathlib import Path

import numpy as np

from smallsat.drawing.interactive import Scene, Track, sphere
from smallsat.drawing.style import BLUE, GREEN, GREY, VERMILION
from smallsat.dynamics.attitude.quaternions import quaternion_to_dcm
from smallsat.results import read_table
from smallsat.studies.slew.configuration import Configuration

QUATERNION = ["q_1", "q_2", "q_3", "q_4"]
AXES = {"x": VERMILION, "y": GREEN, "z": BLUE}
# Of the table's rows; between them the axes hardly move.
THINNED = 10
FALLBACKS = {"quarter": "fig-12", "half": "fig-16"}


def scenes(section: Configuration, results: Path) -> list[Scene]:
    """Each plan of a turn: paths of the tips of the body axes on the unit sphere."""
    replays = read_table(results / "replays.parquet")
    found = []
    for name, flown in replays.groupby("flight", sort=False):
        own = flown.iloc[::THINNED]
        tips = np.array([quaternion_to_dcm(tuple(q)) for q in own[QUATERNION].to_numpy()])
        times = own["time_s"].to_numpy()
        tracks = [
            Track(f"body {axis}", colour, times, tips[:, place])
            for place, (axis, colour) in enumerate(AXES.items())
        ]
        turn = "half" if str(name).startswith("180") else "quarter"
        found.append(
            Scene(
                re.sub(r"[^a-z0-9]+", "-", str(name).lower()),
                f"The body axes in the turn: {name}",
                "Paths of the tips of the three body axes on the unit sphere, inertial frame.",
                f"figures/slew/{FALLBACKS[turn]}",
                "",
                tracks,
                [sphere(1.0, GREY, "unit sphere", 0.12)],
            )
        )
    return found
