"""The on-board propagator: the orbit with J2, and the closed-form attitude transition."""

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.attitude_propagator import propagate
from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.kepler_orbits import acceleration, propagate_orbit
from smallsat.dynamics.units import KM
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.parameters import START, Parameters

# The highest zonal harmonic that the propagator knows.
GRAVITY_ORDER = 2
STEPS_S = (4.0, 2.0, 1.0, 0.5, 0.2)


@compiled
def third_order(state, mu, radius, j2, steps, step):
    """Orbit state (6,) after equal steps of the third-order method of Bogacki and Shampine."""
    y = state.copy()
    for _ in range(steps):
        k1 = _rate(y, mu, radius, j2)
        k2 = _rate(y + 0.5 * step * k1, mu, radius, j2)
        k3 = _rate(y + 0.75 * step * k2, mu, radius, j2)
        y = y + step / 9.0 * (2.0 * k1 + 3.0 * k2 + 4.0 * k3)
    return y


@compiled
def _rate(y, mu, radius, j2):
    a = acceleration((y[0], y[1], y[2]), mu, radius, j2)
    return np.array([y[3], y[4], y[5], a[0], a[1], a[2]])


def final_orbit_states(
    section: Configuration, parameters: Parameters, printed_start: np.ndarray
) -> pd.DataFrame:
    """State at the end of the manoeuvre, km and km/s, by start, gravity and integrator.

    ``printed_start`` is the start of its propagation that the document prints, (6,), m and m/s; the
    printed end follows from these rounded numbers.
    """
    starts = {
        "the orbital elements": np.concatenate(parameters.state),
        "the printed initial state": printed_start,
    }
    step = section.onboard.step_s
    steps = round(parameters.duration / step)
    rows = []
    for name, start in starts.items():
        for gravity, j2 in (("two-body", 0.0), (f"J{GRAVITY_ORDER}", parameters.gravity.j2)):
            field = parameters.gravity._replace(j2=j2)
            found = {
                "order 8": propagate_orbit(
                    start[:3], start[3:], field, np.array([START, parameters.duration])
                )[-1],
                "order 3, fixed step": third_order(
                    start, *field, steps, parameters.duration / steps
                ),
            }
            for method, state in found.items():
                row = {"start": name, "gravity": gravity, "integrator": method}
                names = ("x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s")
                rows.append(row | dict(zip(names, state / KM, strict=True)))
    return pd.DataFrame(rows)


def transition_errors(flights: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Attitude error, deg, of the closed-form transition at the end, for several steps.

    The rates are those of a flight, read at the step; the reference is the flight's own attitude.
    """
    rows = []
    for name, flight in flights.items():
        times = flight["time_s"].to_numpy()
        spacing = times[1] - times[0]
        q = flight[["q_1", "q_2", "q_3", "q_4"]].to_numpy()
        rates = flight[["omega_x", "omega_y", "omega_z"]].to_numpy()
        for step in STEPS_S:
            every = max(1, round(step / spacing))
            found = propagate(q[0], np.ascontiguousarray(rates[::every]), step)
            last = (len(rates) - 1) // every * every
            error = turn_angle(error_quaternion(tuple(found[-1]), tuple(q[last])))
            length = float(np.linalg.norm(found[-1]))
            rows.append(
                {
                    "flight": name,
                    "step_s": step,
                    "error_deg": float(f"{np.degrees(error):.2g}"),
                    "length_error": float(f"{abs(length - 1.0):.1g}"),
                }
            )
    return pd.DataFrame(rows)
