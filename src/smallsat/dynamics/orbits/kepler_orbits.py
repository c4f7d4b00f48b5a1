"""Orbits around an oblate planet: elements to state, acceleration, propagation."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from smallsat.dynamics.compiled import compiled


class Gravity(NamedTuple):
    """A planet's gravity: mu in m^3/s^2, equatorial radius in m, and the zonal coefficient J2."""

    mu: float
    radius: float
    j2: float


class Elements(NamedTuple):
    """Keplerian elements, in m and rad."""

    semi_major_axis: float
    eccentricity: float
    inclination: float
    raan: float
    argument_of_perigee: float
    true_anomaly: float


def perifocal_frame(elements: Elements) -> np.ndarray:
    """Rows: towards perigee, along the motion at perigee, orbit normal; inertial components."""
    cn, sn = np.cos(elements.raan), np.sin(elements.raan)
    ci, si = np.cos(elements.inclination), np.sin(elements.inclination)
    angle = elements.argument_of_perigee
    cp, sp = np.cos(angle), np.sin(angle)
    return np.array(
        [
            [cn * cp - sn * sp * ci, sn * cp + cn * sp * ci, sp * si],
            [-cn * sp - sn * cp * ci, -sn * sp + cn * cp * ci, cp * si],
            [sn * si, -cn * si, ci],
        ]
    )


def state_of(elements: Elements, mu: float) -> tuple[np.ndarray, np.ndarray]:
    """Inertial position, m, and velocity, m/s, shape (3,) each."""
    e, nu = elements.eccentricity, elements.true_anomaly
    semilatus = elements.semi_major_axis * (1.0 - e * e)
    frame = perifocal_frame(elements)
    radius = semilatus / (1.0 + e * np.cos(nu))
    position = radius * np.array([np.cos(nu), np.sin(nu), 0.0])
    velocity = np.sqrt(mu / semilatus) * np.array([-np.sin(nu), e + np.cos(nu), 0.0])
    return position @ frame, velocity @ frame


@compiled
def acceleration(r, mu, radius, j2):
    """Two-body gravity and that of the oblateness, m/s^2; ``j2 = 0`` leaves the first alone."""
    x, y, z = r[0], r[1], r[2]
    squared = x * x + y * y + z * z
    central = mu / (squared * squared**0.5)
    factor = 1.5 * j2 * radius * radius / squared
    height = 5.0 * z * z / squared
    flat = -central * (1.0 + factor * (1.0 - height))
    return (flat * x, flat * y, -central * (1.0 + factor * (3.0 - height)) * z)


def propagate_orbit(
    position: np.ndarray, velocity: np.ndarray, gravity: Gravity, times: np.ndarray
) -> np.ndarray:
    """States (n, 6) at times, s, from a state at the first; relative error about 1e-12 an orbit.

    Not a number from where the integration ends before its time, as in a fall into the centre.
    """
    solution = solve_ivp(
        lambda t, y: np.r_[y[3:], acceleration(y[:3], *gravity)],
        (times[0], times[-1]),
        np.r_[position, velocity],
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-6,
    )
    states = np.full((len(times), 6), np.nan)
    states[: len(solution.t)] = solution.y.T
    return states


def period(semi_major_axis: float, mu: float) -> float:
    """Period of the two-body orbit, s."""
    return float(2.0 * np.pi * np.sqrt(semi_major_axis**3 / mu))
