"""Predicates of the document's prose claims."""

from itertools import pairwise

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.mrp import dcm_to_mrp, mrp_rate
from smallsat.dynamics.attitude.rigid_body import angular_acceleration
from smallsat.dynamics.orbits.circular_orbits import hill_frame, orbit_frame, position, velocity
from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.independent_check import attitude_angle, inertial_momentum
from smallsat.studies.mars.methods.simulation import OPEN_LOOP, run
from smallsat.studies.mars.model.frames import (
    SUN_FRAME,
    gmo_frame,
    gmo_frame_rate,
    nadir_frame,
    nadir_frame_rate,
)
from smallsat.studies.mars.model.gains import damping_ratios, decay_times
from smallsat.studies.mars.parameters import Parameters

SIGMA = ["sigma_1", "sigma_2", "sigma_3"]
OMEGA = ["omega_1", "omega_2", "omega_3"]
SIGMA_REFERENCE = ["sigma_ref_1", "sigma_ref_2", "sigma_ref_3"]

# Id of the Mars day, s.
MARS_DAY = "section-xiii-b/mars-day-simulation-length-animation/full-mission"
ROUNDING = 1e-12
# A pointing error below this at the end of a run counts as having converged, deg.
CONVERGED_DEG = 0.1
# Decay times after a start by which the error must have followed the required decay.
DECAY_TIMES = 5.0
# A time history differs visibly in a plot of attitudes from this angle on, deg.
VISIBLE_DEG = 1.0


def velocity_is_radius_times_rate(grounds: Grounds[Configuration]) -> Judgement:
    """Eq. 6 is compared with a central difference of the position."""
    parameters = Parameters.from_section(grounds.section)
    worst = 0.0
    for orbit in (parameters.lmo, parameters.gmo):
        for time in np.linspace(0.0, grounds.section.durations_s.mission, 50):
            ahead, behind = position(orbit, time + 1.0), position(orbit, time - 1.0)
            by_difference = np.subtract(ahead, behind) / 2.0
            speed = orbit.radius * orbit.rate
            error = np.linalg.norm(by_difference - np.array(velocity(orbit, time))) / speed
            worst = max(worst, float(error))
    return judged(
        worst < 1e-6,
        f"a central difference of the position over 2 s differs from Eq. 6 by at most {worst:.1e} "
        f"of the speed, on both orbits",
    )


def rates_follow_from_one_gravity(grounds: Grounds[Configuration]) -> Judgement:
    """Constant rate sqrt(mu / r^3): both rates of Table 2 must belong to one mu."""
    parameters = Parameters.from_section(grounds.section)
    mu = [orbit.rate**2 * orbit.radius**3 / 1e9 for orbit in (parameters.lmo, parameters.gmo)]
    apart = abs(mu[0] / mu[1] - 1.0)
    # The rates have six significant digits, and mu goes with their square.
    return judged(
        apart < 2e-5,
        f"the rates and radii of Table 2 make mu = {mu[0]:.1f} and {mu[1]:.1f} km^3/s^2, "
        f"{apart:.1e} apart: {'equal' if apart < 2e-5 else 'not equal'} to the digits printed",
    )


def areosynchronous(grounds: Grounds[Configuration]) -> Judgement:
    """The mothercraft's period is compared with the Mars day of Section XIII.B."""
    period = 2.0 * np.pi / grounds.section.orbits.gmo.rate_rad_s
    day = grounds.ledger.value(MARS_DAY).value
    return judged(
        abs(period - day) < 1.0,
        f"its period is {period:.1f} s, the Mars day given is {day:g} s",
    )


def euler_angle_rates(grounds: Grounds[Configuration]) -> Judgement:
    """Eq. 11 is taken with the orbit's rate about its normal only."""
    parameters = Parameters.from_section(grounds.section)
    lmo = parameters.lmo
    s, c = np.sin(lmo.inclination), np.cos(lmo.inclination)
    angle = lmo.argument_of_latitude
    matrix = np.array(
        [
            [np.sin(angle), np.cos(angle), 0.0],
            [np.cos(angle) * s, -np.sin(angle) * s, 0.0],
            [-np.sin(angle) * c, -np.cos(angle) * c, s],
        ]
    )
    if s == 0.0:
        return Judgement("undecided", "Eq. 11 divides by sin i, which is 0 on the LMO orbit")
    rates = matrix @ np.array([0.0, 0.0, lmo.rate]) / s
    gmo_sine = np.sin(parameters.gmo.inclination)
    note = " (Eq. 11 divides by sin i = 0 on the GMO orbit, where only the limit holds)"
    return judged(
        np.allclose(rates, [0.0, 0.0, lmo.rate], rtol=ROUNDING, atol=0.0),
        f"on the LMO orbit Eq. 11 gives node, inclination and angle the rates {rates[0]:.0f}, "
        f"{rates[1]:.0f} and {rates[2]:.6g} rad/s{note if gmo_sine == 0.0 else ''}",
    )


def hill_frame_is_orbit_frame(grounds: Grounds[Configuration]) -> Judgement:
    """[HN] from position and velocity is compared with [ON] from the Euler angles."""
    parameters = Parameters.from_section(grounds.section)
    worst = 0.0
    for orbit in (parameters.lmo, parameters.gmo):
        for time in np.linspace(0.0, grounds.section.durations_s.mission, 200):
            hill = np.array(hill_frame(position(orbit, time), velocity(orbit, time)))
            worst = max(worst, float(np.max(np.abs(hill - np.array(orbit_frame(orbit, time))))))
    return judged(
        worst < ROUNDING, f"over the mission no entry differs by more than {worst:.1e}, both orbits"
    )


def nadir_frame_is_flipped_orbit_frame(grounds: Grounds[Configuration]) -> Judgement:
    """[RnN] is compared with [ON], its first and third rows negated."""
    lmo = Parameters.from_section(grounds.section).lmo
    flip = np.array([[-1.0], [1.0], [-1.0]])
    times = np.linspace(0.0, grounds.section.durations_s.mission, 200)
    worst = max(
        float(np.max(np.abs(np.array(nadir_frame(lmo, t)) - flip * np.array(orbit_frame(lmo, t)))))
        for t in times
    )
    return judged(worst < ROUNDING, f"over the mission no entry differs by more than {worst:.1e}")


def nadir_rate_is_orbit_rate(grounds: Grounds[Configuration]) -> Judgement:
    """Eq. 26 is compared with a central difference of [RnN]."""
    lmo = Parameters.from_section(grounds.section).lmo
    times = np.linspace(0.0, grounds.section.durations_s.mission, 50)
    worst = max(
        float(np.linalg.norm(frame_rate(lambda t: nadir_frame(lmo, t), time) - np.array(rate)))
        for time, rate in ((time, nadir_frame_rate(lmo, time)) for time in times)
    )
    return judged(
        worst < 1e-6 * lmo.rate,
        f"a central difference of [RnN] gives this vector to {worst / lmo.rate:.1e} of its size",
    )


def finite_difference_converges(grounds: Grounds[Configuration]) -> Judgement:
    """The forward difference of [RcN] must come nearer to a far more accurate one as dt shrinks."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    time = float(section.answer_times_s.reference_frames)
    exact = frame_rate(lambda t: gmo_frame(parameters.lmo, parameters.gmo, t), time)
    spans = [section.frame_difference_s.control / 10**n for n in range(4)]
    errors = [
        float(
            np.linalg.norm(
                np.array(gmo_frame_rate(parameters.lmo, parameters.gmo, time, dt)) - exact
            )
        )
        for dt in spans
    ]
    # A difference of entries of size one cannot be better than their rounding over its span.
    floor = [np.finfo(float).eps / dt for dt in spans[1:]]
    falls = all(
        later < max(0.2 * earlier, least)
        for (earlier, later), least in zip(pairwise(errors), floor, strict=True)
    )
    listed = ", ".join(f"{error:.1e} at {dt:g} s" for error, dt in zip(errors, spans, strict=True))
    return judged(falls, f"error of omega_Rc/N in rad/s: {listed}: it falls in proportion to dt")


def torque_free_invariants(grounds: Grounds[Configuration]) -> Judgement:
    """The run without torque must keep momentum and energy, and agree with another integration."""
    inertia = Parameters.from_section(grounds.section).inertia
    ours, again = _both(grounds, "no torque")
    if not ours[OMEGA].to_numpy().any():
        return Judgement("undecided", "the body rests: nothing moves that could be conserved")
    momentum = inertial_momentum(inertia, ours[SIGMA].to_numpy(), ours[OMEGA].to_numpy())
    energy = 0.5 * np.sum(inertia * ours[OMEGA].to_numpy() ** 2, axis=1)
    drift = np.linalg.norm(momentum - momentum[0], axis=1).max() / np.linalg.norm(momentum[0])
    loss = np.max(np.abs(energy / energy[0] - 1.0))
    apart = np.degrees(_apart(ours, again)).max()
    return judged(
        max(drift, loss) < 1e-6 and apart < 1e-3,
        f"over {ours['time_s'].max():g} s the inertial momentum drifts by {drift:.1e} and the "
        f"energy by {loss:.1e} of their size; an adaptive integration stays within {apart:.1e} deg",
    )


def rates_oscillate_about_zero(grounds: Grounds) -> Judgement:
    """Sign changes of the rates are counted in the first and last quarter of the run."""
    _, accurate = _both(grounds, "fixed torque")
    rate = accurate[OMEGA].to_numpy()
    quarter = len(rate) // 4
    first, last = _sign_changes(rate[:quarter]), _sign_changes(rate[-quarter:])
    mean = rate[-quarter:].mean(axis=0)
    listed = "; ".join(
        f"omega_{i + 1}: {first[i]} sign changes in the first quarter, {last[i]} in the last"
        for i in range(3)
    )
    return judged(
        np.all(last > first),
        f"{listed}; means in the last quarter {vector(mean, 3)} rad/s: a component far from zero "
        f"spins up and does not oscillate about it. The listing's panel of omega_2 shows omega_1, "
        f"which hides this",
    )


def attitude_oscillation_speeds_up(grounds: Grounds) -> Judgement:
    """The attitude must turn faster and change sign more often from quarter to quarter."""
    _, accurate = _both(grounds, "fixed torque")
    speed = np.linalg.norm(accurate[OMEGA].to_numpy(), axis=1)
    quarter = len(speed) // 4
    means = [speed[k * quarter : (k + 1) * quarter].mean() for k in range(4)]
    changes = [
        int(_sign_changes(accurate[SIGMA].to_numpy()[k * quarter : (k + 1) * quarter]).sum())
        for k in (0, 3)
    ]
    return judged(
        np.all(np.diff(means) > 0) and changes[1] > changes[0],
        f"mean rate by quarters: {', '.join(f'{m:.2f}' for m in means)} rad/s; the MRPs change "
        f"sign {changes[0]} times in the first quarter and {changes[1]} times in the last",
    )


def turns_faster_than_a_step(grounds: Grounds[Configuration]) -> Judgement:
    """The fastest rate of the fixed-torque run: a step must turn the body by half a turn or more.

    Up to two samples a turn an oscillation can be told from a slower one.
    """
    _, accurate = _both(grounds, "fixed torque")
    fastest = float(np.linalg.norm(accurate[OMEGA].to_numpy(), axis=1).max())
    step = grounds.section.step_s
    return judged(
        fastest * step >= np.pi,
        f"at its fastest the body turns by {np.degrees(fastest * step):.0f} deg in a step of "
        f"{step:g} s, {2.0 * np.pi / (fastest * step):.1f} steps a turn: more than the two that an "
        f"oscillation needs. What spoils the end is the error that the integration gathers",
    )


def step_leaves_artefacts(grounds: Grounds[Configuration]) -> Judgement:
    """The fixed-torque run, with the document's step and less, is compared with another method."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    _, accurate = _both(grounds, "fixed torque")
    duration, switch = section.durations_s.response, section.mrp_switch.torque
    torque = np.array(section.fixed_torque_N_m, dtype=float)
    errors = {}
    for division in (1, 2, 4):
        step = section.step_s / division
        record = run(parameters, OPEN_LOOP, duration, step, step, switch, torque)
        angles = attitude_angle(record[::division, 1:4], accurate[SIGMA].to_numpy())
        errors[step] = np.degrees(angles)
    whole, half, quarter = errors.values()
    listed = ", ".join(f"{error[-1]:.3g} deg at {step:g} s" for step, error in errors.items())
    visible = np.flatnonzero(whole > VISIBLE_DEG)
    falls = bool(half[-1] < whole[-1] / 8 and quarter[-1] < half[-1] / 8)
    order = (
        "it falls with the fourth power of the step, so it is the integration's, and "
        if falls
        else "it "
    )
    since = f" from {accurate['time_s'].to_numpy()[visible[0]]:g} s on" if len(visible) else ""
    if whole[-1] > VISIBLE_DEG and not falls:
        return Judgement(
            "undecided",
            f"attitude error at the end by step size: {listed}; it does not fall with the step yet",
        )
    return judged(
        whole[-1] > VISIBLE_DEG,
        f"attitude error at the end by step size: {listed}; {order}"
        f"{'exceeds' if len(visible) else 'never exceeds'} {VISIBLE_DEG:g} deg{since}",
    )


def gains_meet_requirements(grounds: Grounds[Configuration]) -> Judgement:
    """The largest decay time and damping ratio follow from the linearised loop's eigenvalues."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    required = section.requirements
    pairs = _closed_loop_eigenvalues(parameters)
    slowest, most_damped = _decay_and_damping(pairs)
    return judged(
        np.isclose(slowest.max(), required.largest_decay_time_s, rtol=1e-4)
        and np.isclose(most_damped.max(), required.largest_damping_ratio, rtol=1e-4),
        f"eigenvalues of the linearised loop: decay times {vector(slowest, 1)} s, damping ratios "
        f"{vector(most_damped, 3)} about axes 1, 2, 3; required at most "
        f"{required.largest_decay_time_s:g} s and {required.largest_damping_ratio:g}",
    )


def performance_formulas(grounds: Grounds[Configuration]) -> Judgement:
    """Eqs. 35 and 36 are compared with the eigenvalues of the linearised closed loop."""
    parameters = Parameters.from_section(grounds.section)
    slowest, damping = _decay_and_damping(_closed_loop_eigenvalues(parameters))
    by_35 = decay_times(parameters.inertia, parameters.gains)
    by_36 = damping_ratios(parameters.inertia, parameters.gains)
    apart = max(np.max(np.abs(slowest / by_35 - 1.0)), np.max(np.abs(damping / by_36 - 1.0)))
    return judged(
        apart < 1e-4,
        f"decay times {vector(by_35, 1)} s and damping ratios {vector(by_36, 3)} by the formulas "
        f"differ from the eigenvalues' by at most {apart:.1e}",
    )


def extremes_fall_on_extreme_inertias(grounds: Grounds[Configuration]) -> Judgement:
    """The extremes of decay time and damping ratio must fall on the extreme inertias."""
    parameters = Parameters.from_section(grounds.section)
    inertia = parameters.inertia
    slowest = int(np.argmax(decay_times(inertia, parameters.gains)))
    damped = int(np.argmax(damping_ratios(inertia, parameters.gains)))
    return judged(
        slowest == int(np.argmax(inertia)) and damped == int(np.argmin(inertia)),
        f"the largest decay time is about axis {slowest + 1} ({inertia[slowest]:g} kg m^2), "
        f"the largest damping ratio about axis {damped + 1} ({inertia[damped]:g} kg m^2)",
    )


def sun_pointing_converges(grounds: Grounds[Configuration]) -> Judgement:
    """In Sun pointing the error must decay as required; the attitude reached is told."""
    ours, _ = _both(grounds, "sun")
    target = np.array(dcm_to_mrp(SUN_FRAME))
    return _converges(grounds.section, ours, f"; the frame's MRPs are {vector(target, 4)}")


def nadir_pointing_converges(grounds: Grounds[Configuration]) -> Judgement:
    """In nadir pointing the error must decay as required and be small at the end."""
    return _converges(grounds.section, _both(grounds, "nadir")[0])


def gmo_pointing_converges(grounds: Grounds[Configuration]) -> Judgement:
    """In GMO pointing the error must decay as required and be small at the end."""
    return _converges(grounds.section, _both(grounds, "gmo")[0])


def mission_converges(grounds: Grounds[Configuration]) -> Judgement:
    """In every interval of the mission the error must decay as required and end small."""
    ours, _ = _both(grounds, "mission")
    mode = ours["mode"].to_numpy()
    starts = np.r_[0, np.flatnonzero(np.diff(mode[:-1])) + 1]
    ends = np.r_[starts[1:], len(mode) - 1]
    intervals = [
        _decay(grounds.section, ours.iloc[start:end])
        for start, end in zip(starts, ends, strict=True)
    ]
    decayed = [later / allowed for _, later, allowed, _ in intervals if not np.isnan(later)]
    if len(decayed) < len(intervals):
        return Judgement("undecided", f"an interval is shorter than {DECAY_TIMES:g} decay times")
    worst_end = max(end for *_, end in intervals)
    return judged(
        max(decayed) <= 1.0 and worst_end < CONVERGED_DEG,
        f"in {len(intervals)} intervals the pointing error is at most {max(decayed):.0%} of what "
        f"the required decay allows {DECAY_TIMES:g} decay times after the switch, and at most "
        f"{worst_end:.3f} deg at the interval's end",
    )


def modes_switch_automatically(grounds: Grounds[Configuration]) -> Judgement:
    """The mission visits all modes, and each is the one Table 7 asks for."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    ours, _ = _both(grounds, "mission")
    times, mode = ours["time_s"].to_numpy(), ours["mode"].to_numpy()
    lmo, gmo = directions(parameters, times)
    separation = angle_between(lmo, gmo)
    expected = np.where(lmo[:, 1] > 0.0, 0, np.where(separation <= parameters.visibility, 2, 1))
    wrong = int(np.sum(expected != mode))
    switches = times[1:][np.diff(mode) != 0]
    if wrong == 0 and set(mode) != {0, 1, 2}:
        return Judgement("undecided", "not every mode holds at some time of this run's mission")
    return judged(
        wrong == 0,
        f"switches at {', '.join(f'{t:g}' for t in switches)} s; at {wrong} of {len(times)} steps "
        f"the mode differs from Table 7",
    )


def directions(parameters: Parameters, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inertial directions of both spacecraft from the centre of Mars at times, s, (n, 3) each."""
    lmo, gmo = (
        np.array([orbit_frame(orbit, t)[0] for t in times])
        for orbit in (parameters.lmo, parameters.gmo)
    )
    return lmo, gmo


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between unit vectors, rad, row by row."""
    return np.arccos(np.clip(np.sum(a * b, axis=1), -1.0, 1.0))


def _both(grounds: Grounds, name: str) -> tuple[pd.DataFrame, pd.DataFrame]:
    """A run as recorded and by the independent check.

    Raises
    ------
    LookupError
        If one of them overflowed.
    """
    ours, again = (
        grounds.rows(f"{stem}.parquet", run=name).reset_index(drop=True)
        for stem in ("trajectories", "independent")
    )
    if not np.isfinite(np.vstack([one[SIGMA + OMEGA].to_numpy() for one in (ours, again)])).all():
        raise LookupError(f"the run '{name}' overflowed")
    return ours, again


def _apart(ours: pd.DataFrame, again: pd.DataFrame) -> np.ndarray:
    return attitude_angle(ours[SIGMA].to_numpy(), again[SIGMA].to_numpy())


def _sign_changes(values: np.ndarray) -> np.ndarray:
    return np.sum(np.diff(np.signbit(values), axis=0), axis=0)


def frame_rate(frame, time: float, span: float = 0.1) -> np.ndarray:
    """Inertial rate of a frame by a central difference of order 4."""
    weights = {-2: 1.0, -1: -8.0, 1: 8.0, 2: -1.0}
    change = sum(w * np.array(frame(time + n * span)) for n, w in weights.items()) / (12.0 * span)
    tilde = np.array(frame(time)).T @ change
    # d[RN]/dt = -[~w][RN] in frame components, so that [NR] d[RN]/dt is -[~w] in inertial ones.
    return np.array([tilde[1, 2], tilde[2, 0], tilde[0, 1]])


def _closed_loop_eigenvalues(parameters: Parameters) -> np.ndarray:
    """Eigenvalues of the regulator linearised at rest, shape (3, 2): a pair an axis."""

    def rate_of(state: np.ndarray) -> np.ndarray:
        torque = -parameters.gains.k * state[:3] - parameters.gains.p * state[3:]
        acceleration = angular_acceleration(parameters.inertia, state[3:], torque)
        return np.r_[mrp_rate(state[:3], state[3:]), acceleration]

    small = 1e-6
    columns = [
        (rate_of(small * direction) - rate_of(-small * direction)) / (2 * small)
        for direction in np.eye(6)
    ]
    jacobian = np.array(columns).T
    return np.array([np.linalg.eigvals(jacobian[np.ix_([i, i + 3], [i, i + 3])]) for i in range(3)])


def _decay_and_damping(pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Decay time -2 / trace and damping ratio of each pair of eigenvalues."""
    trace, product = np.real(pairs.sum(axis=1)), np.real(pairs.prod(axis=1))
    return -2.0 / trace, -trace / (2.0 * np.sqrt(product))


def _decay(section: Configuration, rows: pd.DataFrame) -> tuple[float, float, float, float]:
    """Pointing error, deg: at the start, after `DECAY_TIMES`, what is allowed then, at the end.

    Allowed is twice the decayed initial error: an oscillating axis may be ahead of its envelope,
    and the initial rate adds to the amplitude.
    """
    requirement = section.requirements.largest_decay_time_s
    angle = attitude_angle(rows[SIGMA_REFERENCE].to_numpy(), rows[SIGMA].to_numpy())
    error = np.degrees(angle)
    time = rows["time_s"].to_numpy() - rows["time_s"].to_numpy()[0]
    late = error[time >= DECAY_TIMES * requirement]
    later = float(late.max()) if len(late) else np.nan
    return error[0], later, 2.0 * error[0] * np.exp(-DECAY_TIMES), float(error[-1])


def _converges(section: Configuration, rows: pd.DataFrame, note: str = "") -> Judgement:
    start, later, allowed, end = _decay(section, rows)
    if np.isnan(later):
        return Judgement("undecided", f"the run is shorter than {DECAY_TIMES:g} decay times")
    return judged(
        later <= allowed and end < CONVERGED_DEG,
        f"pointing error {start:.1f} deg at the start, at most {later:.3f} deg from "
        f"{DECAY_TIMES:g} decay times on (the requirement allows {allowed:.2f}), {end:.3f} deg "
        f"after {rows['time_s'].max():g} s{note}",
    )


def vector(values: np.ndarray, decimals: int = 3) -> str:
    """A vector for a reader."""
    return f"({', '.join(f'{value:.{decimals}f}' for value in values)})"
