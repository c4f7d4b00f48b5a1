"""What this study computes for every published result, in the printed units."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from math import isnan

import numpy as np

from smallsat.dynamics.attitude.mrp import dcm_to_mrp, mrp_to_dcm, shadow
from smallsat.dynamics.attitude.rigid_body import angular_momentum, kinetic_energy
from smallsat.dynamics.orbits.circular_orbits import hill_frame, position, velocity
from smallsat.dynamics.units import KM
from smallsat.errors import InputError
from smallsat.evidence.observation import Observation
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.simulation import POINTING_RUNS, START, reference, tracking_error
from smallsat.studies.mars.model.frames import (
    SUN_FRAME,
    SUN_FRAME_RATE,
    gmo_frame,
    gmo_frame_rate,
    nadir_frame,
    nadir_frame_rate,
)
from smallsat.studies.mars.parameters import Parameters

# Places in the document, by run; the times stand in the ids.
POINTING_TABLES = {"sun": "table-4", "nadir": "table-5", "gmo": "table-6"}
POINTING_TIMES = ("15", "100", "200", "400")
OVERFLOW = "not converged: its run overflows"
MISSION_TIMES = ("300", "2100", "3400", "4400", "5600")


def observations(
    section: Configuration, parameters: Parameters, runs: Mapping[str, np.ndarray]
) -> list[Observation]:
    """All observations.

    Parameters
    ----------
    section
        The section of the configuration.
    parameters
        The same in SI units.
    runs
        Records of the document's runs, from
        `smallsat.studies.mars.methods.simulation.document_runs`; not a number where one overflowed.
    """
    found = [
        *_orbits(section, parameters),
        *_frames(section, parameters),
        *_initial_tracking_errors(section, parameters),
        *_torque_runs(section, parameters, runs),
        *_gains(parameters),
        *_pointing_runs(section, runs),
    ]
    return [replace(one, note=OVERFLOW) if isnan(one.computed) else one for one in found]


def row_at(record: np.ndarray, time: float, key: str) -> np.ndarray:
    """The row of a run at an answer time; ``key`` names the time in the configuration."""
    index = int(np.argmin(np.abs(record[:, 0] - time)))
    if not np.isclose(record[index, 0], time, rtol=0.0, atol=1e-6):
        raise InputError(
            f"config key 'mars.answer_times_s.{key}': {time:g} is not allowed; "
            f"must be a multiple of step_s within the run's {record[-1, 0]:g} s"
        )
    return record[index]


def _vector(stem: str, axes: Iterable[str], values: Iterable[float]) -> Iterator[Observation]:
    for axis, value in zip(axes, values, strict=True):
        yield Observation(f"mars/{stem}/{axis}", float(value))


def _matrix(stem: str, values) -> Iterator[Observation]:
    entries = [f"{i}{j}" for i in "123" for j in "123"]
    yield from _vector(stem, entries, np.ravel(values))


def _orbits(section: Configuration, parameters: Parameters) -> Iterator[Observation]:
    times = section.answer_times_s
    for name, orbit, label in (("lmo", parameters.lmo, "450"), ("gmo", parameters.gmo, "1150")):
        time = float(times[f"position_{name}"])
        r, v = np.array(position(orbit, time)), np.array(velocity(orbit, time))
        where = "section-iii-c/inertial"
        yield from _vector(f"{where}-position-r-{name}-{label}-s/{name}", "xyz", r / KM)
        yield from _vector(f"{where}-velocity-rdot-{name}-{label}-s/{name}", "xyz", v / KM)
    time = float(times.hill_frame)
    frame = hill_frame(position(parameters.lmo, time), velocity(parameters.lmo, time))
    yield from _matrix("section-iv-c/dcm-hn-300-s/lmo", frame)


def _frames(section: Configuration, parameters: Parameters) -> Iterator[Observation]:
    time = float(section.answer_times_s.reference_frames)
    difference = float(section.frame_difference_s.tracking_error)
    yield from _matrix("equation-19/dcm-rsn", SUN_FRAME)
    for number, axis in enumerate(SUN_FRAME, start=1):
        yield from _vector(f"section-v-a/r-{number}-in-n", "xyz", axis)
    yield from _vector("section-v-d/omega-rs-n", "xyz", SUN_FRAME_RATE)
    yield from _matrix("section-vi-d/dcm-rnn-330-s/lmo", nadir_frame(parameters.lmo, time))
    rate = nadir_frame_rate(parameters.lmo, time)
    yield from _vector("section-vi-e/omega-rn-n-330-s/lmo", "xyz", rate)
    frame = gmo_frame(parameters.lmo, parameters.gmo, time)
    yield from _matrix("section-vii-d/dcm-rcn-330-s/lmo-gmo", frame)
    rate = gmo_frame_rate(parameters.lmo, parameters.gmo, time, difference)
    yield from _vector("section-vii-e/omega-rc-n-330-s/lmo-gmo", "xyz", rate)


def _initial_tracking_errors(
    section: Configuration, parameters: Parameters
) -> Iterator[Observation]:
    difference = float(section.frame_difference_s.tracking_error)
    state = parameters.initial_state
    for name, mode in POINTING_RUNS.items():
        frame, frame_rate = reference(mode, parameters.lmo, parameters.gmo, START, difference)
        sigma, rate = tracking_error(state[:3], state[3:], frame, frame_rate)
        yield from _vector(f"table-3/sigma-b-r-t0/{name}-pointing", "123", sigma)
        yield from _vector(f"table-3/omega-b-r-t0/{name}-pointing", "123", rate)


def _torque_runs(
    section: Configuration, parameters: Parameters, runs: Mapping[str, np.ndarray]
) -> Iterator[Observation]:
    times = section.answer_times_s
    row = row_at(runs["no torque"], times.no_torque, "no_torque")
    sigma, rate = row[1:4], row[4:7]
    momentum = np.array(angular_momentum(parameters.inertia, rate))
    where = "section-ix-b/angular-momentum"
    yield from _vector(f"{where}-body-frame-h-500-s/no-torque", "123", momentum)
    inertial = np.array(mrp_to_dcm(sigma)).T @ momentum
    yield from _vector(f"{where}-inertial-frame-h-500-s/no-torque", "123", inertial)
    yield Observation(
        "mars/section-ix-b/kinetic-energy-t-500-s/no-torque",
        kinetic_energy(parameters.inertia, rate),
    )
    row = row_at(runs["fixed torque"], times.fixed_torque, "fixed_torque")
    yield from _vector("section-ix-c/sigma-b-n-100-s/fixed-torque", "123", row[1:4])


def _gains(parameters: Parameters) -> Iterator[Observation]:
    k, p = parameters.gains
    # The document sums up with two gains, both called K; the first value is P's.
    values = {
        "p-2-i-1-t-max": p,
        "k-p-2-xi-max-2-i-2": k,
        "k-intermediate-fraction": k,
        "gain-1-6-in-summary-sentence": k,
        "gain-p-decimal": p,
        "gain-k": k,
        "gain-k-decimal": k,
    }
    for name, value in values.items():
        yield Observation(f"mars/section-x-b/{name}", value)


def _pointing_runs(section: Configuration, runs: Mapping[str, np.ndarray]) -> Iterator[Observation]:
    times = section.answer_times_s
    # A what-if configuration may ask for fewer times than the document has.
    for name, table in POINTING_TABLES.items():
        for label, time in zip(POINTING_TIMES, times.pointing, strict=False):
            sigma = row_at(runs[name], time, "pointing")[1:4]
            yield from _vector(f"{table}/sigma-b-n-at-t-{label}-s/{name}-pointing", "123", sigma)
    for label, time in zip(MISSION_TIMES, times.mission, strict=False):
        sigma = row_at(runs["mission"], time, "mission")[1:4]
        yield from _vector(f"table-8/sigma-b-n-at-t-{label}-s/full-mission", "123", sigma)

    # Near a half turn both sets of an attitude have a norm near 1; take the reference's side.
    last, target = runs["sun"][-1, 1:4], np.array(dcm_to_mrp(SUN_FRAME))
    other = np.array(shadow(last))
    nearer = min(last, other, key=lambda sigma: float(np.linalg.norm(sigma - target)))
    yield from _vector("section-x-c/converged-sigma-b-n/sun-pointing", "123", nearer)
