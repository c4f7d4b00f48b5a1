"""The Mars mission: the compiled loop, the same steps in plain NumPy, and Basilisk."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
from contender import Contender, Problem

from smallsat.config import default_config
from smallsat.studies.mars.methods.simulation import AUTOMATIC, run
from smallsat.studies.mars.parameters import Parameters

ROOT = Path(__file__).parents[2]
REFERENCES = ROOT / "tests/references"
# Both Basilisk's and the document's steps of 1 s are that far from the reference (its README).
REQUIRED = 1e-7
SECTION = default_config(ROOT).mars
PARAMETERS = Parameters.from_section(SECTION)
DURATION, STEP = SECTION.durations_s.mission, SECTION.step_s
SWITCH = SECTION.mrp_switch.mission


def problem() -> Problem:
    """The mission of the document, with its steps."""
    reference = pd.read_csv(REFERENCES / "basilisk-attitude.csv").query("run == 'mission'")

    def error(states: pd.DataFrame) -> float:
        """Largest difference of the MRPs, whatever set they are of, at the reference's times."""
        ours = states.set_index("time_s").loc[reference["time_s"]].to_numpy()[:, :3]
        other = reference[["sigma_1", "sigma_2", "sigma_3"]].to_numpy()
        return float(np.max(np.abs(_short(ours) - _short(other))))

    return Problem(
        "mars: the mission, 1 s steps",
        "largest MRP error against Basilisk's own run with steps 200 times as fine",
        REQUIRED,
        error,
        (
            Contender("compiled loop", "smallsat", _ours),
            Contender("NumPy loop", "numpy", _numpy),
            # Its orbits are integrated too, and its law is in Python.
            Contender("Basilisk, orbits included", "bsk", _basilisk),
        ),
        3,
    )


def _short(sigma: np.ndarray) -> np.ndarray:
    squared = np.sum(sigma**2, axis=1, keepdims=True)
    return np.where(squared > 1.0, -sigma / squared, sigma)


def _table(times: np.ndarray, sigma: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame({"time_s": times.round(6), **{f"s{i}": sigma[:, i] for i in range(3)}})


def _ours():
    arguments = (PARAMETERS, AUTOMATIC, DURATION, STEP, STEP, SWITCH)
    run(*arguments)

    def solve() -> pd.DataFrame:
        rows = run(*arguments)
        return _table(rows[:, 0], rows[:, 1:4])

    return solve


def _numpy():
    def solve() -> pd.DataFrame:
        states = plain_mission(PARAMETERS, DURATION, STEP, SWITCH)
        return _table(STEP * np.arange(len(states)), states[:, :3])

    return solve


def _basilisk():
    sys.path.insert(0, str(REFERENCES))
    import basilisk_attitude

    # The reference takes finer steps of the dynamics; a peer takes those of the document.
    basilisk_attitude.DYNAMICS_STEP_S = STEP

    def solve() -> pd.DataFrame:
        rows = np.asarray(
            basilisk_attitude.simulate(
                DURATION, control=("mission", basilisk_attitude.document_law)
            )
        )
        return _table(rows[:, 0], rows[:, 1:4])

    return solve


def plain_mission(
    parameters: Parameters, duration: float, step: float, switch: float
) -> np.ndarray:
    """States of the mission, shape (steps + 1, 6), a NumPy expression at a time."""
    state = parameters.initial_state.copy()
    states = [state]
    inertia, inverse = np.diag(parameters.inertia), np.diag(1.0 / parameters.inertia)

    def rate_of(state: np.ndarray, torque: np.ndarray) -> np.ndarray:
        sigma, rate = state[:3], state[3:]
        matrix = (1 - sigma @ sigma) * np.eye(3) + 2 * _tilde(sigma) + 2 * np.outer(sigma, sigma)
        return np.r_[matrix @ rate / 4, inverse @ (torque - _tilde(rate) @ inertia @ rate)]

    for k in range(round(duration / step)):
        frame, frame_rate = _reference(parameters, k * step, step)
        body = _dcm(state[:3])
        sigma = _mrp(body @ frame.T)
        torque = -parameters.gains.k * sigma - parameters.gains.p * (state[3:] - body @ frame_rate)
        k1 = step * rate_of(state, torque)
        k2 = step * rate_of(state + k1 / 2, torque)
        k3 = step * rate_of(state + k2 / 2, torque)
        k4 = step * rate_of(state + k3, torque)
        state = state + (k1 + 2 * k2 + 2 * k3 + k4) / 6
        if np.linalg.norm(state[:3]) > switch:
            state[:3] = -state[:3] / (state[:3] @ state[:3])
        states.append(state)
    return np.array(states)


def _reference(parameters: Parameters, time: float, difference: float):
    lmo, gmo = _orbit_frame(parameters.lmo, time), _orbit_frame(parameters.gmo, time)
    if lmo[0, 1] > 0:
        return np.array([[-1.0, 0, 0], [0, 0, 1], [0, 1, 0]]), np.zeros(3)
    if np.arccos(lmo[0] @ gmo[0]) <= parameters.visibility:
        now, later = _gmo_frame(parameters, time), _gmo_frame(parameters, time + difference)
        tilde = -(later - now) / difference @ now.T
        return now, now.T @ np.array([-tilde[1, 2], tilde[0, 2], -tilde[0, 1]])
    return np.diag([-1.0, 1.0, -1.0]) @ lmo, parameters.lmo.rate * lmo[2]


def _gmo_frame(parameters: Parameters, time: float) -> np.ndarray:
    sight = (
        parameters.gmo.radius * _orbit_frame(parameters.gmo, time)[0]
        - parameters.lmo.radius * _orbit_frame(parameters.lmo, time)[0]
    )
    first = -sight / np.linalg.norm(sight)
    second = np.cross(sight, [0.0, 0.0, 1.0])
    second /= np.linalg.norm(second)
    return np.array([first, second, np.cross(first, second)])


def _orbit_frame(orbit, time: float) -> np.ndarray:
    def about_3(angle):
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])

    c, s = np.cos(orbit.inclination), np.sin(orbit.inclination)
    about_1 = np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    return about_3(orbit.argument_of_latitude + orbit.rate * time) @ about_1 @ about_3(orbit.raan)


def _tilde(v: np.ndarray) -> np.ndarray:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _dcm(sigma: np.ndarray) -> np.ndarray:
    squared, tilde = sigma @ sigma, _tilde(sigma)
    return np.eye(3) + (8 * tilde @ tilde - 4 * (1 - squared) * tilde) / (1 + squared) ** 2


def _mrp(dcm: np.ndarray) -> np.ndarray:
    root = np.sqrt(np.trace(dcm) + 1)
    skew = np.array([dcm[1, 2] - dcm[2, 1], dcm[2, 0] - dcm[0, 2], dcm[0, 1] - dcm[1, 0]])
    sigma = skew / (root * (root + 2))
    squared = sigma @ sigma
    return sigma if squared <= 1 else -sigma / squared
