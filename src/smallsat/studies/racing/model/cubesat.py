"""A CubeSat of the race."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CubeSat:
    """Name, thrust and place at the start.

    Attributes
    ----------
    name
        As printed.
    thrust
        Largest acceleration, m/s^2; of axial thrusters the norm of all axes together, which the
        document's guess and minimum cost use.
    axis_thrust
        Largest acceleration by axis, m/s^2, of a CubeSat with axial thrusters; empty for one that
        may thrust in any direction.
    position
        At the start (3,), m, where it rests.
    """

    name: str
    thrust: float
    axis_thrust: tuple[float, ...]
    position: np.ndarray


def cubesat(name: str, thrust: float, position: np.ndarray, axial: bool = False) -> CubeSat:
    """A CubeSat; ``thrust`` is that of an axis where it is axial."""
    axes = (thrust,) * 3 if axial else ()
    norm = float(np.linalg.norm(axes)) if axial else thrust
    return CubeSat(name, norm, axes, np.array(position, dtype=float))
