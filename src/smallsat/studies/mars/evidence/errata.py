"""Proofs of the errata: each recomputes a quantity as printed and as corrected, and can fail."""

from collections.abc import Iterable, Sequence

import numpy as np

from smallsat.dynamics.attitude.mrp import mrp_to_dcm
from smallsat.dynamics.attitude.rigid_body import angular_momentum, kinetic_energy
from smallsat.dynamics.orbits.circular_orbits import position
from smallsat.dynamics.units import KM
from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.printed import Printed
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.evidence.claims import (
    SIGMA,
    angle_between,
    directions,
    vector,
)
from smallsat.studies.mars.evidence.observations import row_at
from smallsat.studies.mars.methods.simulation import (
    AUTOMATIC,
    document_runs,
    finite,
    run,
    tracking_error,
)
from smallsat.studies.mars.model.frames import (
    SUN_FRAME,
    SUN_FRAME_RATE,
    gmo_frame,
    nadir_frame,
    nadir_frame_rate,
)
from smallsat.studies.mars.model.gains import Gains, damping_ratios
from smallsat.studies.mars.parameters import Parameters

# Place of the misprinted column of Table 8 among the mission's answer times.
MISPRINTED_TIME = 3
ORTHOGONAL = 1e-12  # what rounding may leave of an orthogonal matrix's defect


def table_8_misprint(grounds: Grounds[Configuration]) -> Proof:
    """Table 8, 4400 s: no threshold, step or integrator gives the printed first component."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    time = section.answer_times_s.mission[MISPRINTED_TIME]
    difference = section.frame_difference_s.control
    thresholds = sorted({threshold for _, threshold in section.mrp_switch})
    steps = [section.step_s / n for n in (1, 2, 4)]
    found = [
        _row(run(parameters, AUTOMATIC, time, step, difference, threshold), time, "mission")[1:4]
        for step in steps
        for threshold in thresholds
    ]
    again = grounds.rows("independent.parquet", run="mission")
    found.append(again.loc[np.isclose(again["time_s"], time), SIGMA].to_numpy()[0])
    # Whatever set each run ended in, the printed value might stand for the other one.
    sigma = np.array(found)
    shadows = -sigma / np.sum(sigma**2, axis=1, keepdims=True)
    sigma_1 = np.r_[sigma[:, 0], shadows[:, 0]]
    printed = grounds.ledger.value("table-8/sigma-b-n-at-t-4400-s/full-mission/1")
    closest = float(np.min(np.abs(sigma_1 - printed.value)))
    ours = _row(document_runs(section, parameters)["mission"], time, "mission")[1]
    return Proof(
        closest > 2 * printed.half_unit,
        f"sigma_1 = {printed.value}",
        f"sigma_1 = {ours:.3f}",
        f"{len(sigma)} runs ({len(thresholds)} MRP switch thresholds, {len(steps)} step sizes "
        f"and an adaptive integrator with quaternions) give sigma_1 between "
        f"{sigma[:, 0].min():.4f} and {sigma[:, 0].max():.4f}; neither they nor their shadow "
        f"sets come closer to {printed.value} than {closest:.4f}",
        correct=float(ours),
    )


def nadir_frame_sign(grounds: Grounds[Configuration]) -> Proof:
    """[RnN](330 s): with the printed sign of entry (3,2) the matrix is no rotation."""
    section = grounds.section
    lmo = Parameters.from_section(section).lmo
    time = float(section.answer_times_s.reference_frames)
    entry = grounds.ledger.value("section-vi-d/dcm-rnn-330-s/lmo/32")
    correct = np.array(nadir_frame(lmo, time))
    printed = correct.copy()
    printed[2, 1] = np.copysign(correct[2, 1], entry.value)
    by_equation_25 = np.sin(lmo.inclination) * np.cos(lmo.raan)
    before, after = _orthogonality_defect(printed), _orthogonality_defect(correct)
    return Proof(
        before > 0.1 and after < ORTHOGONAL and np.isclose(correct[2, 1], by_equation_25),
        f"entry (3,2) = {printed[2, 1]:.4f}: R R' differs from 1 by {before:.2f}",
        f"entry (3,2) = {correct[2, 1]:.4f}: R R' differs from 1 by {after:.0e}",
        f"Eq. 25 makes the entry sin i cos Omega = {by_equation_25:+.4f}; with the printed sign "
        f"the third row is not normal to the others (largest entry of R R' - 1: {before:.2f})",
        correct=float(correct[2, 1]),
    )


def kinetic_energy_half(grounds: Grounds[Configuration]) -> Proof:
    """T = w' I w lacks the factor 1/2 that the printed value contains."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    time = section.answer_times_s.no_torque
    rate = _row(document_runs(section, parameters)["no torque"], time, "no_torque")[4:7]
    correct = kinetic_energy(parameters.inertia, rate)
    without = float(rate @ (parameters.inertia * rate))
    printed = grounds.ledger.value("section-ix-b/kinetic-energy-t-500-s/no-torque")
    return Proof(
        printed.matches(correct) and not printed.matches(without),
        f"w' I w = {without:.5f} J",
        f"w' I w / 2 = {correct:.5f} J",
        f"The formula as printed gives {without:.5f} J, with the factor 1/2 {correct:.5f} J; "
        f"the value printed beside it is {printed.value} J",
    )


def attitude_matrix_factor(grounds: Grounds[Configuration]) -> Proof:
    """The printed [BN] of an MRP set lacks (1 - sigma^2) on its second term."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    time = section.answer_times_s.no_torque
    row = _row(document_runs(section, parameters)["no torque"], time, "no_torque")
    sigma, rate = row[1:4], row[4:7]
    tilde = np.cross(np.eye(3), -sigma)
    printed = np.eye(3) + (8 * tilde @ tilde - 4 * tilde) / (1 + sigma @ sigma) ** 2
    correct = np.array(mrp_to_dcm(sigma))
    momentum = np.array(angular_momentum(parameters.inertia, rate))
    start = np.array(angular_momentum(parameters.inertia, parameters.initial_state[3:]))
    conserved = np.linalg.norm(np.array(mrp_to_dcm(parameters.initial_state[:3])).T @ start)
    before, after = _orthogonality_defect(printed), _orthogonality_defect(correct)
    return Proof(
        before > 1e-3 and after < ORTHOGONAL,
        f"H = {vector(printed.T @ momentum)} kg m^2/s; [BN] is no rotation",
        f"H = {vector(correct.T @ momentum)} kg m^2/s",
        f"[BN] [BN]' differs from 1 by {before:.2f} as printed and by {after:.0e} with the "
        f"factor; the printed formula gives |H| = {np.linalg.norm(printed.T @ momentum):.4f}, "
        f"although |H| = {conserved:.4f} kg m^2/s is conserved",
    )


def gmo_frame_roots(grounds: Grounds[Configuration]) -> Proof:
    """Eqs. 30 and 31 divide by squared lengths: the rows are not of length one."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    time = float(section.answer_times_s.reference_frames)
    a, b, c = np.subtract(position(parameters.gmo, time), position(parameters.lmo, time)) / KM
    rows = np.array([[-a, -b, -c], [b, -a, 0.0], [-a * c, -b * c, a * a + b * b]])
    flat, full = a * a + b * b, a * a + b * b + c * c
    squared = np.array([full, flat, flat * full])[:, None]
    printed, correct = rows / squared, rows / np.sqrt(squared)
    by_definition = np.array(gmo_frame(parameters.lmo, parameters.gmo, time))
    lengths = np.linalg.norm(printed, axis=1)
    return Proof(
        np.all(np.abs(lengths - 1) > 0.5)
        and np.allclose(correct, by_definition, rtol=0, atol=ORTHOGONAL),
        f"rows of length {', '.join(f'{length:.1e}' for length in lengths)} (km)",
        "rows of length 1, equal to Eq. 28",
        f"As printed the rows have lengths between {lengths.min():.1e} and "
        f"{lengths.max():.1e}; with square roots of the denominators the matrix equals Eq. 28 "
        f"to {np.max(np.abs(correct - by_definition)):.0e}, and the printed [RcN] follows",
    )


def gain_name(grounds: Grounds[Configuration]) -> Proof:
    """The summary calls both gains K: with the first as K the damping requirement is missed."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    k, p = parameters.gains
    called_k = grounds.ledger.value("section-x-b/gain-1-6-in-summary-sentence").value
    wrong = damping_ratios(parameters.inertia, Gains(k=called_k, p=p)).max()
    right = damping_ratios(parameters.inertia, parameters.gains).max()
    required = section.requirements.largest_damping_ratio
    return Proof(
        np.isclose(called_k, p) and np.isclose(right, required) and not np.isclose(wrong, required),
        f"K = {called_k:.4f}: largest damping ratio {wrong:.2f}",
        f"K = {k:.4f}, P = {p:.4f}: largest ratio {right:.2f}",
        f"Eq. 36 gives a largest damping ratio of {wrong:.3f} with K = {called_k:.4f} and "
        f"of {right:.3f} with K = {k:.5f}; required is {required:g}, and by Eq. 35 P = {p:.4f}",
    )


def gain_fraction(grounds: Grounds[Configuration]) -> Proof:
    """The printed intermediate fraction is not the K printed beside it; P^2 over I_2 is."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    inertia, required = parameters.inertia.min(), section.requirements.largest_damping_ratio
    literal = grounds.ledger.literal("section-x-b/k-intermediate-fraction")
    printed = grounds.ledger.value("section-x-b/k-intermediate-fraction").value
    beside = grounds.ledger.value("section-x-b/gain-k")
    correct = parameters.gains.p**2 / (required**2 * inertia)
    return Proof(
        beside.matches(correct) and not beside.matches(printed),
        f"{literal} = {printed:.5f}",
        f"{correct:.5f}",
        f"{literal} is {printed:.5f}, and the K printed beside it {beside.value:.5f}; P^2 over the "
        f"smallest inertia {inertia:g} kg m^2 is {correct:.5f} N m, the K that is used; a digit of "
        f"the fraction may be a slip of the transcription",
        correct=float(correct),
    )


def argument_of_latitude_start(grounds: Grounds[Configuration]) -> Proof:
    """theta(t) = rate t omits theta(t0): without it the verified position does not come out."""
    section = grounds.section
    lmo = Parameters.from_section(section).lmo
    time = float(section.answer_times_s.position_lmo)
    correct = np.array(position(lmo, time)) / KM
    without = np.array(position(lmo._replace(argument_of_latitude=0.0), time)) / KM
    printed = grounds.ledger.values("section-iii-c/inertial-position-r-lmo-450-s/lmo")
    apart = float(np.linalg.norm(without - np.array(printed, dtype=float)))
    return Proof(
        _all_match(printed, correct) and not _all_match(printed, without),
        f"r = {vector(without, 1)} km",
        f"r = {vector(correct, 1)} km",
        f"Without the initial angle the position at {time:g} s is {apart:.0f} km from the "
        f"printed one, with it the printed digits come out",
    )


def visibility_overlap(grounds: Grounds[Configuration]) -> Proof:
    """Table 1's footnotes call the mothercraft visible and not visible at exactly the limit."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    limit = section.visibility_deg
    angles = np.array([limit - 1.0, limit, limit + 1.0])
    visible, hidden = (
        grounds.ledger.literal(f"table-1-footnote/{name}-lmo-gmo-angular-separation")
        for name in ("visible", "not-visible")
    )
    as_printed = _meets(angles, visible).astype(int) + _meets(angles, hidden)
    corrected = _meets(angles, visible).astype(int) + (angles > limit)
    day = grounds.table("day.parquet")
    times = day["time_s"].to_numpy()[:: max(1, len(day) // 20000)]
    separation = np.degrees(angle_between(*directions(parameters, times)))
    closest = np.min(np.abs(separation - limit))
    return Proof(
        np.any(as_printed != 1) and np.all(corrected == 1),
        f"{as_printed[1]} modes apply at {limit:g} deg",
        f"{corrected[1]} mode applies: not visible is > {limit:g} deg",
        f"At {limit:g} deg both printed conditions, {visible} and {hidden}, hold; with > in "
        f"the second exactly one holds at every angle. Nothing follows for the results: of "
        f"{len(times)} times over the Mars day the closest to the limit is {closest:.1e} deg "
        f"from it",
    )


def second_rate_panel(grounds: Grounds) -> Proof:
    """Listings A.H plot omega_1 in the panel of omega_2 (Figs. 4 and 5)."""
    runs = grounds.table("trajectories.parquet")
    apart = {
        name: float((group["omega_1"] - group["omega_2"]).abs().max())
        for name, group in runs.groupby("run")
        if name in ("no torque", "fixed torque")
    }
    if not np.isfinite(list(apart.values())).all():
        raise LookupError("a run overflowed")
    return Proof(
        min(apart.values()) > 1e-3,
        "second panel of omega: omega_1",
        "second panel of omega: omega_2",
        f"omega_1 and omega_2 differ by up to {apart['no torque']:.3f} rad/s without torque "
        f"and {apart['fixed torque']:.3f} rad/s under the fixed torque, so one cannot stand "
        f"for the other; our panels draw omega_2",
    )


def reference_rate_frame(grounds: Grounds[Configuration]) -> Proof:
    """Figs. 7, 8 and 10 compare the body rate with the reference's rate in inertial components."""
    parameters = Parameters.from_section(grounds.section)
    last = grounds.rows("trajectories.parquet", run="nadir").iloc[-1]
    body_rate, reference_rate = (
        last[[f"{name}_{axis}" for axis in "123"]].to_numpy(dtype=float)
        for name in ("omega", "omega_ref")
    )
    if not np.isfinite(body_rate).all():
        raise LookupError("the run 'nadir' overflowed")
    inertial = np.array(nadir_frame_rate(parameters.lmo, float(last["time_s"])))
    apart, correct = (float(np.linalg.norm(body_rate - one)) for one in (inertial, reference_rate))
    return Proof(
        apart > 0.1 * parameters.lmo.rate > 10.0 * correct,
        f"omega_R/N = {vector(1e6 * inertial, 0)}e-6 rad/s, inertial components",
        f"omega_R/N = {vector(1e6 * reference_rate, 0)}e-6 rad/s, body components",
        f"At the end of the nadir run the body rate is {vector(1e6 * body_rate, 0)}e-6 rad/s: "
        f"{apart:.1e} from the reference's rate in inertial components, which the listings "
        f"plot beside it, and {correct:.1e} from it in body components, which our figures show",
    )


def first_row_of_listings(grounds: Grounds[Configuration]) -> Proof:
    """Listings A.I to A.L begin with the body's state as the reference and without torque."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    state, gains = parameters.initial_state, parameters.gains
    sigma, rate = tracking_error(state[:3], state[3:], SUN_FRAME, SUN_FRAME_RATE)
    torque = -gains.k * np.array(sigma) - gains.p * np.array(rate)
    return Proof(
        np.linalg.norm(sigma) > ORTHOGONAL and np.linalg.norm(torque) > ORTHOGONAL,
        "sigma_R = sigma_B and u = 0 at the start",
        f"|sigma_B/R| = {np.linalg.norm(sigma):.3f}, u = {vector(torque, 4)} N m",
        f"In Sun pointing the body begins {np.linalg.norm(sigma):.3f} (MRPs) away from the "
        f"reference, and the control law answers with u = {vector(torque, 4)} N m at once; every "
        f"later row has torque and reference of the step before it",
    )


def tracking_rate_formula(grounds: Grounds[Configuration]) -> Proof:
    """Section VIII.A subtracts the body rate from itself: Table 3 does not follow."""
    section = grounds.section
    state = Parameters.from_section(section).initial_state
    _, correct = tracking_error(state[:3], state[3:], SUN_FRAME, SUN_FRAME_RATE)
    body = np.array(mrp_to_dcm(state[:3]))
    printed = state[3:] - state[3:] - body @ np.array(SUN_FRAME_RATE)
    table = grounds.ledger.values("table-3/omega-b-r-t0/sun-pointing")
    fails = any(one.matches(rate) for one, rate in zip(table, printed, strict=True))
    return Proof(
        _all_match(table, correct) and not fails,
        f"omega_B/R = {vector(printed, 4)} rad/s (Sun)",
        f"omega_B/R = {vector(np.array(correct), 4)} rad/s (Sun)",
        f"As printed the rate relative to the resting Sun frame vanishes; without the repeated "
        f"term it is {vector(np.array(correct), 4)} rad/s, and Table 3 prints "
        f"{vector(np.array(table, dtype=float), 4)}; the repetition may be "
        f"a slip of the transcription",
    )


def _meets(angles: np.ndarray, condition: str) -> np.ndarray:
    """Whether angles meet a printed condition such as ``<= 35``."""
    sign, limit = condition.split()
    compare = {"<=": np.less_equal, ">=": np.greater_equal, ">": np.greater, "<": np.less}[sign]
    return compare(angles, float(limit))


def _all_match(printed: Sequence[Printed], computed: Iterable[float]) -> bool:
    """Whether every component has its printed digits."""
    return all(one.matches(value) for one, value in zip(printed, computed, strict=True))


def _row(record: np.ndarray, time: float, key: str) -> np.ndarray:
    """The row of a run at a time; a LookupError where the run overflowed."""
    if not finite(record):
        raise LookupError("the run overflowed")
    return row_at(record, time, key)


def _orthogonality_defect(matrix: np.ndarray) -> float:
    return float(np.max(np.abs(matrix @ matrix.T - np.eye(3))))
