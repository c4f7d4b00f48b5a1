"""The attitude runs: no torque, fixed torque, one pointing mode, and the mission.

The control is computed once at the start of a step and held over it, as the document's flight
program does; the classical Runge-Kutta method integrates the step.
"""

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.mrp import dcm_to_mrp, mrp_to_dcm
from smallsat.dynamics.attitude.rigid_body import runge_kutta_step
from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, scaled, times, times_transposed
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.model.frames import (
    SUN_FRAME,
    SUN_FRAME_RATE,
    gmo_frame,
    gmo_frame_rate,
    nadir_frame,
    nadir_frame_rate,
)
from smallsat.studies.mars.model.gains import Gains
from smallsat.studies.mars.model.modes import GMO, NADIR, SUN, pointing_mode
from smallsat.studies.mars.parameters import Parameters

START = 0.0  # s
NO_TORQUE = np.zeros(3)  # N m

# What commands the torque: a pointing mode, the state machine, or nothing but a constant.
AUTOMATIC = -1
OPEN_LOOP = -2

POINTING_RUNS = {"sun": SUN, "nadir": NADIR, "gmo": GMO}

COLUMNS = (
    "time_s",
    *(
        f"{name}_{axis}"
        for name in ("sigma", "omega", "u", "sigma_ref", "omega_ref")
        for axis in "123"
    ),
    "mode",
)


@compiled
def reference(mode, lmo, gmo, time, difference):
    """Reference frame [RN], shape (3, 3), and its rate, shape (3,), of a pointing mode."""
    if mode == SUN:
        return SUN_FRAME, SUN_FRAME_RATE
    if mode == NADIR:
        return nadir_frame(lmo, time), nadir_frame_rate(lmo, time)
    return gmo_frame(lmo, gmo, time), gmo_frame_rate(lmo, gmo, time, difference)


@compiled
def tracking_error(sigma, rate, frame, frame_rate):
    """Attitude and rate of the body relative to a reference frame (mars, Section VIII.A).

    Parameters
    ----------
    sigma, rate : shape (3,)
        MRPs relative to inertial, body rate in rad/s.
    frame : shape (3, 3)
        [RN].
    frame_rate : shape (3,)
        Rate of the frame in inertial components, rad/s.

    Returns
    -------
    sigma, rate : tuple, shape (3,)
        Short MRP set of B relative to R, and the relative rate in body components, rad/s.
    """
    body = mrp_to_dcm(sigma)
    return (
        dcm_to_mrp(times_transposed(body, frame)),
        axpy(-1.0, times(body, frame_rate), rate),
    )


@compiled
def integrate(
    initial_state,
    inertia,
    gains,
    lmo,
    gmo,
    visibility,
    command,
    open_loop_torque,
    steps,
    step,
    difference,
    switch_norm,
):
    """Integrate a run and record it at the start of every step and at the end.

    Parameters
    ----------
    initial_state : ndarray, shape (6,)
    inertia : ndarray, shape (3,)
        kg m^2.
    gains : Gains
    lmo, gmo : CircularOrbit
    visibility : float
        rad.
    command : int
        A pointing mode, AUTOMATIC or OPEN_LOOP.
    open_loop_torque : ndarray, shape (3,)
        Torque of an OPEN_LOOP run, N m.
    steps : int
    step, difference : float
        Step and finite difference for the GMO frame's rate, s.
    switch_norm : float
        Norm of the MRPs above which they go over to the shadow set after a step.

    Returns
    -------
    ndarray, shape (steps + 1, 17)
        Columns as in `COLUMNS`; both rates are in body components. Torque, reference and mode are
        those computed at the row's time and held until the next row; an open-loop run has no
        reference, and its mode is OPEN_LOOP.
    """
    out = np.empty((steps + 1, 17))
    sigma = (initial_state[0], initial_state[1], initial_state[2])
    rate = (initial_state[3], initial_state[4], initial_state[5])
    torque = (open_loop_torque[0], open_loop_torque[1], open_loop_torque[2])
    moments = (inertia[0], inertia[1], inertia[2])
    nothing = (np.nan, np.nan, np.nan)
    for k in range(steps + 1):
        time = START + k * step
        mode = command
        sigma_reference, rate_reference = nothing, nothing
        if command != OPEN_LOOP:
            if command == AUTOMATIC:
                mode = pointing_mode(lmo, gmo, time, visibility)
            frame, frame_rate = reference(mode, lmo, gmo, time, difference)
            sigma_reference = dcm_to_mrp(frame)
            sigma_error, rate_error = tracking_error(sigma, rate, frame, frame_rate)
            rate_reference = axpy(-1.0, rate_error, rate)
            torque = axpy(-gains.p, rate_error, scaled(-gains.k, sigma_error))
        out[k, 0] = time
        for i in range(3):
            out[k, 1 + i] = sigma[i]
            out[k, 4 + i] = rate[i]
            out[k, 7 + i] = torque[i]
            out[k, 10 + i] = sigma_reference[i]
            out[k, 13 + i] = rate_reference[i]
        out[k, 16] = mode
        sigma, rate = runge_kutta_step(sigma, rate, moments, torque, step, switch_norm)
    return out


def run(
    parameters: Parameters,
    command: int,
    duration: float,
    step: float,
    difference: float,
    switch_norm: float,
    open_loop_torque: np.ndarray = NO_TORQUE,
    gains: Gains | None = None,
) -> np.ndarray:
    """Integrate one run; see `integrate` for the meaning and the columns."""
    return integrate(
        parameters.initial_state,
        parameters.inertia,
        gains or parameters.gains,
        parameters.lmo,
        parameters.gmo,
        parameters.visibility,
        command,
        np.asarray(open_loop_torque, dtype=float),
        round(duration / step),
        float(step),
        float(difference),
        float(switch_norm),
    )


def document_runs(section: Configuration, parameters: Parameters) -> dict[str, np.ndarray]:
    """The document's six runs as in its own settings, by name."""
    durations, switch = section.durations_s, section.mrp_switch
    step, difference = section.step_s, section.frame_difference_s.control

    def one(command: int, duration: str, threshold: str, torque: np.ndarray = NO_TORQUE):
        return run(
            parameters, command, durations[duration], step, difference, switch[threshold], torque
        )

    return {
        "no torque": one(OPEN_LOOP, "response", "torque"),
        "fixed torque": one(OPEN_LOOP, "response", "torque", np.array(section.fixed_torque_N_m)),
        **{name: one(mode, "response", name) for name, mode in POINTING_RUNS.items()},
        "mission": one(AUTOMATIC, "mission", "mission"),
    }


def day_run(section: Configuration, parameters: Parameters) -> np.ndarray:
    """The mission over a Mars day."""
    return run(
        parameters,
        AUTOMATIC,
        section.durations_s.day,
        section.step_s,
        section.frame_difference_s.control,
        section.mrp_switch.mission,
    )


def finite(record: np.ndarray) -> bool:
    """Whether a run's attitude and rate are numbers from its start to its end."""
    return bool(np.isfinite(record[:, 1:7]).all())


def as_table(record: np.ndarray) -> pd.DataFrame:
    """A run as a tidy table with the columns of `COLUMNS`."""
    table = pd.DataFrame(record, columns=list(COLUMNS))
    return table.astype({"mode": int})
