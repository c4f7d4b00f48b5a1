"""The orbit-transfer problem: parameters, equations of motion, boundary conditions.

A spacecraft with constant thrust goes from one circular orbit to another in the plane, in least
time. Polar coordinates, canonical units (document `transfer`, sections 1 and 2). The state is
``(r, theta, v_r, v_theta, m)``; the control is the angle ``beta`` of the thrust above the local
horizontal. Expressions are written for any array library: numbers, NumPy arrays and CasADi symbols.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from smallsat.studies.transfer.configuration import Problem

STATES = ("r", "theta", "v_r", "v_theta", "m")
COSTATES = ("lambda_r", "lambda_theta", "lambda_vr", "lambda_vtheta", "lambda_m")


@dataclass(frozen=True)
class TransferProblem:
    """Parameters of the transfer in canonical units.

    Attributes
    ----------
    mu
        Gravitational parameter of the Sun.
    thrust
        Thrust force T.
    exhaust_speed
        Exhaust speed v_e, which sets the mass flow T / v_e.
    initial_radius, final_radius
        Radii of the two circular orbits.
    initial_mass
        Mass at the start.
    """

    mu: float
    thrust: float
    exhaust_speed: float
    initial_radius: float
    final_radius: float
    initial_mass: float

    @classmethod
    def of(cls, problem: Problem) -> "TransferProblem":
        """The configured problem."""
        return cls(**dict(problem))

    @property
    def initial_state(self) -> np.ndarray:
        """State (5,) on the initial circular orbit (section 2.1)."""
        speed = np.sqrt(self.mu / self.initial_radius)
        return np.array([self.initial_radius, 0.0, 0.0, speed, self.initial_mass])

    @property
    def final_speed(self) -> float:
        """Circular speed at the final radius (section 2.1)."""
        return float(np.sqrt(self.mu / self.final_radius))

    @property
    def longest_time(self) -> float:
        """Time at which all mass would be spent; a transfer must end before it."""
        return self.initial_mass * self.exhaust_speed / self.thrust

    def final_mass(self, final_time: float) -> float:
        """Mass at the end, from the constant mass flow (equation 27)."""
        return self.initial_mass - self.thrust / self.exhaust_speed * final_time

    def state_rate(self, state: Any, sine: Any, cosine: Any) -> list[Any]:
        """Time derivative of the state (equations 21, 22, 25, 26, 27).

        The control enters by the sine and cosine of beta, so any array library will do.
        """
        r, _, v_r, v_theta, m = (state[i] for i in range(5))
        acceleration = self.thrust / m
        return [
            v_r,
            v_theta / r,
            v_theta**2 / r - self.mu / r**2 + acceleration * sine,
            -v_theta * v_r / r + acceleration * cosine,
            -self.thrust / self.exhaust_speed + 0.0 * r,
        ]

    def terminal_error(self, state: Any) -> list[Any]:
        """Errors of r, v_r and v_theta at the end; zero on the final circular orbit."""
        return [
            state[0] - self.final_radius,
            state[2],
            state[3] - self.final_speed,
        ]

    def hamiltonian(self, state: Any, costate: Any) -> Any:
        """Hamiltonian lambda . f on an extremal (equation 28; there is no running cost)."""
        rate = self.extremal_rate(state, costate)
        return sum(costate[i] * rate[i] for i in range(5))

    def extremal_rate(self, state: Any, costate: Any, smoothing: Any = 0.0) -> list[Any]:
        """Time derivative of state and costate along an extremal (equations 29-34).

        The thrust points along the velocity costate (primer vector), which maximises the
        Hamiltonian for a final mass to be maximised. With a ``smoothing`` the thrust fades where
        the primer vector is not long against it, instead of turning about at once.
        """
        r, _, v_r, v_theta, m = (state[i] for i in range(5))
        l_r, l_theta, l_vr, l_vtheta, _ = (costate[i] for i in range(5))
        primer = (l_vr**2 + l_vtheta**2 + smoothing**2) ** 0.5
        costate_rate = [
            l_theta * v_theta / r**2
            + l_vr * (v_theta**2 / r**2 - 2 * self.mu / r**3)
            - l_vtheta * v_theta * v_r / r**2,
            0.0 * r,
            -l_r + l_vtheta * v_theta / r,
            -l_theta / r - 2 * l_vr * v_theta / r + l_vtheta * v_r / r,
            primer * self.thrust / m**2,
        ]
        return self.state_rate(state, l_vr / primer, l_vtheta / primer) + costate_rate
