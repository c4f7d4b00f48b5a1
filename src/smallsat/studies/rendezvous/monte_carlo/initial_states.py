"""Random initial states of the chaser (chapter 4's introduction and section 5.4)."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.configuration import Flown, MonteCarlo
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.monte_carlo.cases import base

# How the direction is drawn, which the thesis does not say. What it says of the positions is in
# terms of the orbit's plane alone: quadrants, the half-plane of the docking port, and a plot of x
# and y. `in-plane` is therefore what we run; `isotropic` is the same set lifted out of the plane.
IN_PLANE, ISOTROPIC = "in-plane", "isotropic"


class Distribution(NamedTuple):
    """How the initial states are distributed.

    Attributes
    ----------
    nearest, farthest
        Bounds of the distance, m, uniform between them.
    velocity_deviation
        Standard deviation of the velocity about the stable ellipse's, m/s, along each axis.
    direction
        `IN_PLANE` or `ISOTROPIC`.
    """

    nearest: float
    farthest: float
    velocity_deviation: float
    direction: str


def stable_velocity(position: np.ndarray, mean_motion: float) -> np.ndarray:
    """Velocity (..., 3), m/s, at a position (..., 3), m, that keeps a centred ellipse.

    (n y/2, -2 n x, 0): the chaser comes back to where it is after an orbit, by the linear
    equations. Table 3.2 has it to its digits for mean motions of 0.001133 to 0.001145 rad/s.
    """
    x, y = position[..., 0], position[..., 1]
    velocity = np.stack([0.5 * y, -2.0 * x, np.zeros_like(x)], axis=-1)
    return mean_motion * velocity


def initial_state(
    sample: int, seed: int, distribution: Distribution, mean_motion: float
) -> np.ndarray:
    """Relative position, m, and velocity, m/s, of one sample, shape (6,).

    It depends on the seed and the sample's number only, not on how many are drawn.
    """
    random = stream(seed, sample)
    distance = random.uniform(distribution.nearest, distribution.farthest)
    angle = random.uniform(0.0, 2.0 * np.pi)
    error = distribution.velocity_deviation * random.standard_normal(3)
    height = random.uniform(-1.0, 1.0) if distribution.direction == ISOTROPIC else 0.0
    level = np.sqrt(1.0 - height * height)
    position = distance * np.array([level * np.cos(angle), level * np.sin(angle), height])
    return np.concatenate([position, stable_velocity(position, mean_motion) + error])


def initial_states(
    count: int, seed: int, distribution: Distribution, mean_motion: float
) -> np.ndarray:
    """The first samples of a study, shape (count, 6)."""
    return np.array([initial_state(k, seed, distribution, mean_motion) for k in range(count)])


def quadrant(states: np.ndarray) -> np.ndarray:
    """Quadrant, 1 to 4, of each state (n, 6) in the plane of x and y, shape (n,).

    Counted from x towards y, so that 3 and 4 are the half-plane y < 0, away from a docking port on
    the positive y axis, as section 4.1 has it.
    """
    angle = np.arctan2(states[:, 1], states[:, 0]) % (2.0 * np.pi)
    return np.minimum((angle // (0.5 * np.pi)).astype(int), 3) + 1


def distribution(studies: Flown) -> Distribution:
    """The distribution that the configuration describes."""
    nearest, farthest = (1e3 * distance for distance in studies.distance_km)
    return Distribution(nearest, farthest, studies.velocity_deviation_m_s, IN_PLANE)


def states_table(section: MonteCarlo, count: int, seed: int) -> pd.DataFrame:
    """Initial states of a study, one a row, with distance, m, and quadrant."""
    drawn = initial_states(count, seed, distribution(section.studies), base(section).mean_motion)
    table = pd.DataFrame({"sample": np.arange(count, dtype=np.int32)})
    table[STATE] = drawn
    table["distance_m"] = np.linalg.norm(drawn[:, :3], axis=1)
    table["quadrant"] = quadrant(drawn).astype(np.int8)
    return table
