"""Predicates of what the document says of its models: motion, thrusters, disturbances.

None of them rests on the inference but by the height of the orbit, which the printed velocity
gives. Sentences that hedge ("may", "typically", "as close as desired") are judged as hedged.
"""

from math import exp

import numpy as np

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.environment.spherical_harmonics import acceleration, terms
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.dynamics.orbits.kepler_orbits import Elements, state_of
from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.guidance.law import PHASES, Law
from smallsat.studies.rendezvous.inference.misfit import printed_steps
from smallsat.studies.rendezvous.model import actuation_noise, truth
from smallsat.studies.rendezvous.model.environment import environment, orbit_radius, target_state
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.parameters import CASES, law
from smallsat.studies.rendezvous.simulation import disturbances

# What words are taken to mean.
FAR_BETTER = 10.0  # "accurate only locally", "much smaller", "comparatively smaller": a factor
AN_ESTIMATE = 0.1  # a "conservative estimate" is above what it estimates, by this share at most
SETTLED = 0.01  # "asymptotically bounded": variances of late times are this close to their limit
# Distances, m, and eccentricity at which the linear motion is looked at; a transfer orbit's own.
NEAR, AWAY, TRANSFER_ORBIT = 100.0, 10_000.0, 0.73
STANDARD_GRAVITY = 9.80665  # m/s^2
# Gravitational parameters, m^3/s^2, distances, m, and the pressure of sunlight there, N/m^2.
MOON, SUN = (4.9028e12, 3.844e8), (1.32712e20, 1.49598e11)
LIGHT_PRESSURE = 4.56e-6


def _prediction_error(law: Law, distance: float, eccentricity: float) -> float:
    """Error of the linear prediction over the far range's horizon, as a share of the distance.

    The chaser begins ahead of the target, at rest in its frame, in the central field alone.
    """
    duration = law.sample_times[0] * law.horizons[0]
    n = law.mean_motion
    # A perigee in the height of the document's orbit keeps the target above the ground.
    axis = orbit_radius(n) / (1.0 - eccentricity)
    elements = Elements(axis, eccentricity, 0.0, 0.0, 0.0, 0.0)
    target = np.concatenate(state_of(elements, egm96.MU))
    relative = np.array([0.0, distance, 0.0, 0.0, 0.0, 0.0])
    pair = truth.pair_from_relative(target, relative)
    mean_motion = float(np.sqrt(egm96.MU / axis**3))
    predicted = transition(rate_matrix(mean_motion), duration) @ relative
    still = np.zeros(3)
    truth.advance(pair, 0.0, duration, still, still, _central_field())
    return float(np.linalg.norm((truth.relative_state(pair) - predicted)[:3]) / distance)


def _central_field() -> truth.Environment:
    return truth.Environment(
        mu=egm96.MU,
        radius=egm96.RADIUS,
        gravity=terms(egm96.COEFFICIENTS, 0, 0),
        earth_rate=0.0,
        earth_angle=0.0,
        density=0.0,
        density_radius=egm96.RADIUS,
        scale_height=1.0,
        panels=np.zeros((2, 1, 4)),
        drag=np.zeros(2),
        step=10.0,
    )


def linear_motion_is_local(grounds: Grounds[Configuration]) -> Judgement:
    """Section 2.1.1: errors of the linear motion near and far, on circular and elliptic orbits."""
    given = law(grounds.section)
    near, away, elliptic = (
        _prediction_error(given, distance, eccentricity)
        for distance, eccentricity in ((NEAR, 0.0), (AWAY, 0.0), (NEAR, TRANSFER_ORBIT))
    )
    return judged(
        away > FAR_BETTER * near and elliptic > FAR_BETTER * near,
        f"over the far range's horizon the linear motion is off by {100 * near:.2g} % of the "
        f"distance at {NEAR:g} m, by {100 * away:.2g} % at {AWAY:g} m, and on an orbit of "
        f"eccentricity {TRANSFER_ORBIT:g}, a transfer orbit's, by {100 * elliptic:.2g} % at "
        f"{NEAR:g} m",
    )


def _position_errors(bound: float, on_time: float, sample_time: float) -> tuple[float, float]:
    """Errors at a step's end, m, of a held control and of an impulse; the thruster burns at first.

    Coriolis' and tidal terms are left out: they are alike in all three.
    """
    burnt = bound * (sample_time - 0.5 * on_time)
    held, impulse = 0.5 * bound * sample_time, bound * sample_time
    return abs(held - burnt), abs(impulse - burnt)


def hold_suits_short_samples(grounds: Grounds[Configuration]) -> Judgement:
    """Section 2.1.1: a held control and an impulse, each against the thruster's own burn."""
    section = grounds.section
    craft = section.spacecraft
    found = {
        name: _position_errors(
            phase.control_bound_m_s,
            phase.control_bound_m_s * craft.mass_kg / craft.thruster_N,
            phase.sample_time_s,
        )
        for name, phase in section.phases
    }
    shortest = min(PHASES, key=lambda name: section.phases[name].sample_time_s)
    longest = max(PHASES, key=lambda name: section.phases[name].sample_time_s)
    text = "; ".join(
        f"{name} range, {section.phases[name].sample_time_s:g} s: {held:.2g} m held, "
        f"{impulse:.2g} m by an impulse"
        for name, (held, impulse) in found.items()
    )
    return judged(
        found[shortest][0] < found[longest][0] and found[longest][1] < found[longest][0],
        f"errors at the end of a step with the largest control, against a burn of the printed "
        f"thruster from the step's start: {text}",
    )


def bound_makes_impulsive(grounds: Grounds[Configuration]) -> Judgement:
    """Section 2.1.2: what a shorter bound on the on-time does to the error of an impulse."""
    section = grounds.section
    craft, far = section.spacecraft, section.phases.far
    errors = []
    for share in (1.0, 0.5, 0.25):
        bound = share * far.control_bound_m_s
        on_time = bound * craft.mass_kg / craft.thruster_N
        errors.append(_position_errors(bound, on_time, far.sample_time_s)[1] / bound)
    moved = grounds.rows("truth.csv", model="burns")
    same = int((moved["steps"] == moved["steps_linear"]).sum())
    return judged(
        errors[0] > 1.9 * errors[1] > 3.6 * errors[2],
        f"per m/s, an impulse is off by {errors[0]:.2g} m at the printed bound, {errors[1]:.2g} m "
        f"at half of it and {errors[2]:.2g} m at a quarter: as close as desired. Whether the "
        f"printed bound is close enough is another question: with burns {same} of {len(moved)} "
        f"phases of the cases keep their number of steps",
    )


def constant_mass_is_conservative(grounds: Grounds[Configuration]) -> Judgement:
    """Section 2.1.2: propellant of the document's example by a constant and by a falling mass."""
    place = "section-2-1-2"
    delta_v, impulse = (
        grounds.ledger.value(f"{place}/{name}").value
        for name in ("delta-v-example", "isp-of-af-m315e-ascent")
    )
    printed = grounds.ledger.value(f"{place}/propellant-share-of-mass-example").value
    ratio = delta_v / (STANDARD_GRAVITY * impulse)
    constant, falling = ratio, 1.0 - exp(-ratio)
    return judged(
        falling < constant < (1.0 + AN_ESTIMATE) * falling,
        f"for {delta_v:g} m/s at {impulse:g} s a constant mass asks for {100 * constant:.2f} % of "
        f"it as propellant, a falling one for {100 * falling:.2f} %; the printed {printed:g} % is "
        f"neither",
    )


def phases_save_work(grounds: Grounds[Configuration]) -> Judgement:
    """Chapter 3: stages solved with three phases, and with the last one's sampling throughout.

    From printed numbers alone: Table 3.1 and the cases' times. A single phase has the shortest of
    the horizons here, though it would then look ahead for a minute only.
    """
    section = grounds.section
    steps = printed_steps(section, grounds.ledger)
    finest = min(phase.sample_time_s for _, phase in section.phases)
    shortest = min(phase.horizon for _, phase in section.phases)
    texts, saved = [], []
    for case in CASES[:3]:
        own = {name: steps[case, name] for name in PHASES}
        split = sum(own[name] * section.phases[name].horizon for name in PHASES)
        time = sum(own[name] * section.phases[name].sample_time_s for name in PHASES)
        single = time / finest * shortest
        saved.append(split < single)
        texts.append(f"{case}: {split} stages in three phases, {single:.0f} in one")
    return judged(
        all(saved),
        f"printed numbers alone; stages of all programs of a manoeuvre, {'; '.join(texts)}, though "
        f"a horizon of {shortest} steps of {finest:g} s sees but a small part of what the far "
        f"range's does",
    )


def noise_is_bounded(grounds: Grounds[Configuration]) -> Judgement:
    """Section 5.1: the variance of the amplitude error after ever longer times."""
    error = grounds.section.studies.robustness.thrust_error
    noise = disturbances.thrust_noise(error)
    rates = np.linalg.eigvals(actuation_noise.drift(noise)).real
    deviations = []
    for hours in (10.0, 30.0):
        factor = actuation_noise.interval(noise, error.reading, 3600.0 * hours).factor
        deviations.append(float(np.hypot(factor[0, 0], factor[0, 1])))
    return judged(
        rates.max() < 0.0 and abs(deviations[1] / deviations[0] - 1.0) < SETTLED,
        f"the model's slowest rate is {rates.max():.2g} 1/s; from a known start the deviation is "
        f"{100 * deviations[0]:.3g} % after 10 hours and {100 * deviations[1]:.3g} % after 30",
    )


def _accelerations(section: Configuration, degree: int, order: int) -> np.ndarray:
    """Gravity, m/s^2, at places around the target's orbit, (24, 3), in the inertial frame."""
    mean_motion = section.inferred.mean_motion_rad_s
    table = terms(egm96.COEFFICIENTS, degree, order)
    found = []
    for angle in np.arange(0.0, 360.0, 15.0):
        settings = section.truth.with_(argument_of_latitude_deg=float(angle))
        x, y, z = target_state(settings, mean_motion)[:3]
        found.append(acceleration(x, y, z, egm96.MU, egm96.RADIUS, table))
    return np.array(found)


def oblateness_dominates(grounds: Grounds[Configuration]) -> Judgement:
    """Section 5.2.1: the field's other terms against the oblateness, around the orbit."""
    section = grounds.section
    degree, order = section.truth.gravity_degree, section.truth.gravity_order
    if degree < 3:
        raise LookupError("a field with higher degrees")
    central, oblate, whole = (
        _accelerations(section, *size) for size in ((0, 0), (2, 0), (degree, order))
    )
    largest = float(np.linalg.norm(oblate - central, axis=1).max())
    others = float(np.linalg.norm(whole - oblate, axis=1).max())
    return judged(
        largest > FAR_BETTER * others,
        f"around the orbit the oblateness reaches {largest:.2g} m/s^2, all other terms to degree "
        f"{degree} and order {order} together {others:.2g} m/s^2, {largest / others:.0f} times "
        f"less",
    )


def light_and_third_bodies_are_small(grounds: Grounds[Configuration]) -> Judgement:
    """Section 5.2: sunlight and third bodies against drag, in what they do to the relative motion.

    Drag differs between the bodies by their printed coefficients. Reflectivities are not printed;
    they are taken to differ by the same share.
    """
    section = grounds.section
    mean_motion, mass = section.inferred.mean_motion_rad_s, section.spacecraft.mass_kg
    air = environment(section.truth, mean_motion, mass)
    if air.density == 0.0:
        raise LookupError("drag")
    radius = orbit_radius(mean_motion)
    size = section.truth.body_size_m
    coefficient = section.truth.drag_coefficient
    share = abs(coefficient.target - coefficient.chaser) / coefficient.target
    pressure = 0.5 * air.density * (radius * mean_motion) ** 2
    drag = pressure * size.radial * size.normal * coefficient.target / mass
    light = LIGHT_PRESSURE * size.radial * size.along / mass
    distance = float(np.linalg.norm(section.start.position_m))
    tides = sum(2.0 * mu * distance / away**3 for mu, away in (MOON, SUN))
    ratios = [share * drag / (share * light), share * drag / tides]
    return judged(
        min(ratios) > FAR_BETTER,
        f"between the bodies, at the start: drag differs by {share * drag:.2g} m/s^2, sunlight on "
        f"the largest face by {share * light:.2g} m/s^2 if reflectivities differ as drag "
        f"coefficients do, and Moon and Sun pull by {tides:.2g} m/s^2: {ratios[0]:.0f} and "
        f"{ratios[1]:.0f} times less",
    )
