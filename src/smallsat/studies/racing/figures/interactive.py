"""The races to turn and play."""

from pathlib import Path

import numpy as np

from smallsat.drawing.interactive import Scene, Track, line
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.figures.drawing import (
    COLOURS,
    ENLARGED,
    OPTIMAL,
    RING,
    positions,
    read_course,
    read_paths,
    ring_curve,
)

FALLBACKS = dict(zip(SCENARIOS, ("fig-02", "fig-08"), strict=True))


def scenes(section: Configuration, results: Path) -> list[Scene]:
    """Each scenario: rings, larger than they are, and the optimal flights through them."""
    found = []
    for scenario, fallback in FALLBACKS.items():
        course = read_course(str(results), scenario)
        paths = read_paths(str(results), scenario)
        optimal = paths[paths["solution"] == OPTIMAL]
        tracks = [
            Track(str(name), COLOURS[str(name)], _clock(own["time_s"].to_numpy()), positions(own))
            for name, own in optimal.groupby("cubesat", sort=False)
        ]
        rings = [line(ring_curve(course, k, ENLARGED), RING) for k in range(len(course.centres))]
        title = f"Scenario {scenario[-1]}: the optimal flights through all rings"
        if tracks:
            found.append(
                Scene(
                    scenario,
                    title,
                    f"{len(rings)} rings in space and the paths of {len(tracks)} CubeSats "
                    "through them, in the Hill frame; rings are drawn larger than they are.",
                    f"figures/racing/{fallback}",
                    "m",
                    tracks,
                    rings,
                )
            )
    return found


def _clock(times: np.ndarray) -> np.ndarray:
    """Times since the start, s, where each segment may count from its own."""
    steps = np.diff(times, prepend=times[0])
    return np.cumsum(np.where(steps < 0.0, 0.0, steps))
