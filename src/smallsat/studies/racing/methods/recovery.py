"""Start positions recomputed from a seed: what the seeds of both races must give.

After the course, each CubeSat's place is drawn from a normal distribution around the start: three
numbers a CubeSat, of which the one along the track has no variance.
"""

from datetime import date

import numpy as np
import pandas as pd

from smallsat.studies.racing.model.course import generate
from smallsat.studies.racing.model.matlab_random import MatlabStream
from smallsat.studies.racing.parameters import Parameters

# MATLAB counts days from the year 0, Python from the year 1.
DAY_OFFSET = 366


def start_positions(parameters: Parameters, seed: int, cubesats: int) -> tuple[int, np.ndarray]:
    """Number of rings of a seed's course, and the places (cubesats, 3), m, that it draws next."""
    stream = MatlabStream(seed)
    course = generate(stream, parameters.ranges)
    draws = np.array([[stream.normal() for _ in range(3)] for _ in range(cubesats)])
    return course.rings, course.start + parameters.scatter * draws * np.array([1.0, 0.0, 1.0])


def recovered(parameters: Parameters, seeds: dict[str, int]) -> pd.DataFrame:
    """Places from the seeds beside the printed ones, by scenario and CubeSat."""
    rows = []
    for scenario, race in parameters.races.items():
        _, places = start_positions(parameters, seeds[scenario], len(race.cubesats))
        for cubesat, place in zip(race.cubesats, places, strict=True):
            for axis, computed, printed in zip("xyz", place, cubesat.position, strict=True):
                rows.append(
                    {
                        "scenario": scenario,
                        "seed": seeds[scenario],
                        "cubesat": cubesat.name,
                        "axis": axis,
                        "printed_m": printed,
                        "computed_m": computed,
                    }
                )
    return pd.DataFrame(rows)


def search_days(
    parameters: Parameters, scenario: str, first_year: int, last_year: int
) -> pd.DataFrame:
    """Every serial day number of some years as a seed: how far the printed places are from it.

    The largest difference over the places, m; infinite where the number of rings is another.
    """
    race = parameters.races[scenario]
    printed = np.array([cubesat.position for cubesat in race.cubesats])
    first = date(first_year, 1, 1).toordinal() + DAY_OFFSET
    last = date(last_year + 1, 1, 1).toordinal() + DAY_OFFSET
    rows = []
    for seed in range(first, last):
        rings, places = start_positions(parameters, seed, len(printed))
        same = rings == race.course.rings
        difference = float(np.abs(places - printed).max()) if same else np.inf
        rows.append(
            {
                "seed": seed,
                "day": date.fromordinal(seed - DAY_OFFSET).isoformat(),
                "rings": rings,
                "largest_difference_m": difference,
            }
        )
    return pd.DataFrame(rows)
