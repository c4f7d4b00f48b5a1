"""Canonical units of a transfer: those of the initial orbit and of the initial mass."""

from dataclasses import dataclass

import numpy as np

from smallsat.studies.transfer.model.problem import TransferProblem


@dataclass(frozen=True)
class Units:
    """What one canonical unit is in the units of the configuration.

    In canonical units mu, the initial radius and the initial mass are 1, so that every solver sees
    numbers of moderate size. The document's own problem is canonical already: its units are 1.
    """

    length: float
    time: float
    mass: float

    @property
    def speed(self) -> float:
        """Circular speed on the initial orbit."""
        return self.length / self.time

    @property
    def state(self) -> np.ndarray:
        """Units of the state (5,)."""
        return np.array([self.length, 1.0, self.speed, self.speed, self.mass])

    @property
    def costate(self) -> np.ndarray:
        """Units of the costate (5,): the final mass, which is maximised, by the state."""
        return self.mass / self.state


def units_of(problem: TransferProblem) -> Units:
    """Canonical units of a problem."""
    length = problem.initial_radius
    return Units(length, float(np.sqrt(length**3 / problem.mu)), problem.initial_mass)


def canonical(problem: TransferProblem) -> TransferProblem:
    """The same problem in its canonical units."""
    units = units_of(problem)
    return TransferProblem(
        mu=1.0,
        thrust=problem.thrust * units.length**2 / (units.mass * problem.mu),
        exhaust_speed=problem.exhaust_speed / units.speed,
        initial_radius=1.0,
        final_radius=problem.final_radius / units.length,
        initial_mass=1.0,
    )
