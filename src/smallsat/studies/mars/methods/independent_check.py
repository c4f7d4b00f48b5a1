"""The runs once more by other means: quaternions, scipy's rotations, an adaptive integrator.

No function of `smallsat.dynamics` is used. What is shared is the definition of the problem: a
torque computed at the start of each control step and held over it, with the GMO frame's rate by the
same finite difference.
"""

import numpy as np
import pandas as pd
from scipy.integrate import ode
from scipy.spatial.transform import Rotation

from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.simulation import AUTOMATIC, NO_TORQUE, OPEN_LOOP, POINTING_RUNS
from smallsat.studies.mars.model.modes import GMO, NADIR, SUN, SUNLIT_ABOVE
from smallsat.studies.mars.parameters import Parameters

RELATIVE_TOLERANCE = 1e-10
ABSOLUTE_TOLERANCE = 1e-12


def integrate_again(
    parameters: Parameters,
    command: int,
    duration: float,
    step: float,
    difference: float,
    open_loop_torque: np.ndarray,
) -> pd.DataFrame:
    """One run by quaternions and the adaptive Dormand-Prince method of order 8.

    Parameters
    ----------
    parameters
        The study's parameters.
    command
        A pointing mode, AUTOMATIC or OPEN_LOOP.
    duration, step, difference
        Seconds; ``step`` is the time for which a torque is held, not an integration step.
    open_loop_torque
        N m, shape (3,).

    Returns
    -------
    DataFrame
        ``time_s``, ``sigma_1..3`` (short set), ``omega_1..3`` (rad/s), one row a control step; not
        a number from where the motion is too fast for the integrator.
    """
    times = step * np.arange(round(duration / step) + 1)
    to_inertial, frame_rate = _references(parameters, command, times, difference)
    inertia = parameters.inertia.tolist()
    rotation = Rotation.from_mrp(parameters.initial_state[:3])
    state = np.r_[rotation.as_quat(), parameters.initial_state[3:]]
    torque = np.asarray(open_loop_torque, dtype=float)

    solver = ode(_state_rate).set_integrator(
        "dop853", rtol=RELATIVE_TOLERANCE, atol=ABSOLUTE_TOLERANCE, nsteps=10_000
    )
    record = np.full((len(times), 7), np.nan)
    record[0] = state
    for k, time in enumerate(times[:-1]):
        if command != OPEN_LOOP:
            body = Rotation.from_quat(state[:4])
            sigma = (Rotation.from_quat(to_inertial[k]).inv() * body).as_mrp()
            rate = state[4:] - body.apply(frame_rate[k], inverse=True)
            torque = -parameters.gains.k * sigma - parameters.gains.p * rate
        solver.set_initial_value(state, time).set_f_params(inertia, torque.tolist())
        state = solver.integrate(times[k + 1])
        if not solver.successful():
            break
        state[:4] /= np.linalg.norm(state[:4])
        record[k + 1] = state

    sigma = np.full((len(times), 3), np.nan)
    reached = np.isfinite(record).all(axis=1)
    sigma[reached] = Rotation.from_quat(record[reached, :4]).as_mrp()
    table = np.column_stack([times, sigma, record[:, 4:]])
    names = [f"{name}_{axis}" for name in ("sigma", "omega") for axis in "123"]
    return pd.DataFrame(table, columns=["time_s", *names])


def check_runs(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """All of the document's runs by `integrate_again`, with a column ``run``."""
    durations = section.durations_s
    fixed_torque = np.array(section.fixed_torque_N_m, dtype=float)
    runs = {
        "no torque": (OPEN_LOOP, durations.response, NO_TORQUE),
        "fixed torque": (OPEN_LOOP, durations.response, fixed_torque),
        **{n: (mode, durations.response, NO_TORQUE) for n, mode in POINTING_RUNS.items()},
        "mission": (AUTOMATIC, durations.mission, NO_TORQUE),
    }
    step, difference = section.step_s, section.frame_difference_s.control
    return pd.concat(
        [
            integrate_again(parameters, command, duration, step, difference, torque).assign(
                run=name
            )
            for name, (command, duration, torque) in runs.items()
        ],
        ignore_index=True,
    )


def attitude_angle(sigma: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Angle of the rotation between attitudes given as MRPs of either set, shape (n, 3), in rad."""
    # scipy asks for writable arrays; columns of a table are not.
    first, second = Rotation.from_mrp(np.array(sigma)), Rotation.from_mrp(np.array(other))
    return (first.inv() * second).magnitude()


def inertial_momentum(inertia: np.ndarray, sigma: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Angular momentum in inertial components, shape (n, 3), kg m^2/s."""
    return Rotation.from_mrp(np.array(sigma)).apply(inertia * rate)


def _state_rate(time: float, y: np.ndarray, inertia: list[float], torque: list[float]):
    """Quaternion (scalar last) of the body relative to inertial, then body rate."""
    q1, q2, q3, q0, w1, w2, w3 = y.tolist()
    i1, i2, i3 = inertia
    return [
        0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
        0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
        0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
        -0.5 * (q1 * w1 + q2 * w2 + q3 * w3),
        (torque[0] - (i3 - i2) * w2 * w3) / i1,
        (torque[1] - (i1 - i3) * w3 * w1) / i2,
        (torque[2] - (i2 - i1) * w1 * w2) / i3,
    ]


def _references(parameters: Parameters, command: int, times: np.ndarray, difference: float):
    """Quaternions from reference to inertial, (n, 4), and rates, (n, 3), at all times."""
    lmo, normal = _orbit(parameters.lmo, times)
    gmo, _ = _orbit(parameters.gmo, times)
    separation = np.arccos(np.clip(np.sum(_unit(lmo) * _unit(gmo), axis=1), -1.0, 1.0))
    mode = np.where(
        lmo[:, 1] > SUNLIT_ABOVE, SUN, np.where(separation <= parameters.visibility, GMO, NADIR)
    )
    if command != AUTOMATIC:
        mode[:] = command

    # Columns are the axes of a frame in inertial components.
    sun = np.broadcast_to([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]], (len(times), 3, 3))
    nadir = np.stack([-_unit(lmo), np.cross(normal, _unit(lmo)), -normal], axis=2)
    gmo_now = _to_mothercraft(lmo, gmo)
    gmo_then = _to_mothercraft(
        _orbit(parameters.lmo, times + difference)[0], _orbit(parameters.gmo, times + difference)[0]
    )
    # dR/dt R' = [~w] in inertial components; its frame components as the document reads them off.
    change = np.swapaxes(gmo_then - gmo_now, 1, 2) / difference @ gmo_now
    in_frame = np.stack([change[:, 1, 2], -change[:, 0, 2], change[:, 0, 1]], axis=1)
    choice = (mode == SUN)[:, None], (mode == NADIR)[:, None]
    frame = np.where(choice[0][..., None], sun, np.where(choice[1][..., None], nadir, gmo_now))
    rate = np.where(
        choice[0],
        0.0,
        np.where(
            choice[1], parameters.lmo.rate * normal, np.einsum("nij,nj->ni", gmo_now, in_frame)
        ),
    )
    return Rotation.from_matrix(frame).as_quat(), rate


def _orbit(orbit, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions, (n, 3), and orbit normals, (n, 3)."""
    angles = np.column_stack(
        [
            np.full_like(times, orbit.raan),
            np.full_like(times, orbit.inclination),
            orbit.argument_of_latitude + orbit.rate * times,
        ]
    )
    rotation = Rotation.from_euler("ZXZ", angles)
    return orbit.radius * rotation.apply([1.0, 0.0, 0.0]), rotation.apply([0.0, 0.0, 1.0])


def _to_mothercraft(lmo: np.ndarray, gmo: np.ndarray) -> np.ndarray:
    first = _unit(lmo - gmo)
    second = _unit(np.cross(gmo - lmo, [0.0, 0.0, 1.0]))
    return np.stack([first, second, np.cross(first, second)], axis=2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
