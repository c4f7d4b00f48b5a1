"""Proofs of the errata: each recomputes a quantity as printed and as corrected, and can fail."""

from dataclasses import replace

import numpy as np
from scipy.linalg import expm
from scipy.stats import chi2

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import SCENARIOS, Configuration
from smallsat.studies.racing.methods import listing
from smallsat.studies.racing.methods.flight import propagate_segment
from smallsat.studies.racing.methods.listing_races import targets
from smallsat.studies.racing.methods.recovery import start_positions
from smallsat.studies.racing.model.course import generate
from smallsat.studies.racing.model.matlab_random import MatlabStream
from smallsat.studies.racing.model.shooting import (
    AXIS_BY_AXIS,
    NORM_OF_AXES,
    costate_matrix,
    thrust_components,
)
from smallsat.studies.racing.parameters import Parameters

# Places of one CubeSat at the start of each race.
PLACES = {
    "scenario-1": "table-1/initial-position/scenario-1-eeny",
    "scenario-2": "table-3/initial-position/scenario-2-eeny",
}
PROBABLE = 0.01
SECONDS = 90.0
CONSTANT, DRIFTING = 1e-9, 1e-3
# A primer vector with a component below the deadzone.
PRIMER = np.array([2.0, 0.5, -3.0])


def _seeds(section: Configuration) -> dict[str, int]:
    return {name: section.scenarios[name].seed for name in SCENARIOS}


def _matched(
    grounds: Grounds[Configuration], parameters: Parameters, variance: float
) -> tuple[int, int, float]:
    """How many x and z a variance gives to the digit, of how many, and the largest error."""
    changed = replace(parameters, scatter=float(np.sqrt(variance)))
    errors = []
    for scenario, race in parameters.races.items():
        _, places = start_positions(changed, _seeds(grounds.section)[scenario], len(race.cubesats))
        printed = np.array([cubesat.position for cubesat in race.cubesats])
        errors.append(np.abs(places - printed)[:, [0, 2]])
    every = np.concatenate(errors).ravel()
    half_unit = grounds.ledger.value(f"{PLACES['scenario-1']}/x").half_unit
    return int((every <= half_unit).sum()), len(every), float(every.max())


def scatter_probability(parameters: Parameters, variance: float) -> float:
    """Two-sided probability of the printed scatter around the known start of Scenario 1."""
    race = parameters.races["scenario-1"]
    offsets = np.array([c.position - race.course.start for c in race.cubesats])[:, [0, 2]]
    total = float(np.sum(offsets**2)) / variance
    below = float(chi2.cdf(total, offsets.size))
    return 2.0 * min(below, 1.0 - below)


def start_covariance(grounds: Grounds[Configuration]) -> Proof:
    """250 m^2: the draws of the stream against the printed positions, and their scatter."""
    parameters = Parameters.from_section(grounds.section)
    right = parameters.scatter**2
    name = "section-i/cubesat-initial-position-covariance-diag/all-cubesats/x"
    printed = grounds.ledger.value(name).value
    fits, of, error = _matched(grounds, parameters, right)
    misfits, _, wrong = _matched(grounds, parameters, printed)
    probability = scatter_probability(parameters, printed)
    return Proof(
        fits >= of - 1 and misfits < of // 2 and probability < PROBABLE,
        f"{misfits} of {of} coordinates, off by up to {wrong:.1f} m",
        f"{fits} of {of} to the printed digit, the rest within {error:.2f} m",
        f"the normal draws after the courses' in the streams of both seeds give {fits} of "
        f"{of} printed x and z to the digit with a variance of {right:.2f} m^2, and {misfits} "
        f"with {printed:g} m^2; without the streams, the scatter of Table 1 around the known "
        f"start has a probability of {probability:.2g} under the printed variance and "
        f"{scatter_probability(parameters, right):.2g} under the other",
        correct=right,
    )


def start_ring_comment(grounds: Grounds[Configuration]) -> Proof:
    """The same draws as for the covariance are scaled by the comment's multiple of 5."""
    parameters = Parameters.from_section(grounds.section)
    used = grounds.section.start.axis_multiple
    right = parameters.scatter**2
    name = "listing-c-b-finalprojectmain-m/startring-comment-multiple-of-largest-axis"
    printed = grounds.ledger.value(name).value
    fits, of, _ = _matched(grounds, parameters, right)
    misfits, _, wrong = _matched(grounds, parameters, right * printed / used)
    return Proof(
        fits >= of - 1 and misfits < of // 2,
        f"{misfits} of {of} coordinates, off by up to {wrong:.1f} m",
        f"{fits} of {of} coordinates",
        f"with {printed:g} times the largest axis the draws give {misfits} of {of} "
        f"printed coordinates, with {used:g} times {fits}",
        correct=float(used),
    )


def angle_steps(grounds: Grounds[Configuration]) -> Proof:
    """Whole ranges of the angles: the start of both courses along the track."""
    parameters = Parameters.from_section(grounds.section)
    texts, fits, misfits = [], [], []
    for scenario, seed in _seeds(grounds.section).items():
        halved = generate(MatlabStream(seed), parameters.ranges).start[1]
        whole = generate(MatlabStream(seed), parameters.ranges, halved=False).start[1]
        y = f"{PLACES[scenario]}/y"
        printed = grounds.ledger.value(y)
        fits.append(printed.matches(halved))
        misfits.append(not printed.matches(whole))
        texts.append((f"{whole:.1f}", f"{halved:.1f}", grounds.ledger.literal(y)))
    return Proof(
        all(fits) and all(misfits),
        ", ".join(text[0] for text in texts) + " m",
        ", ".join(text[1] for text in texts) + " m",
        f"the start's y is printed as {' and '.join(text[2] for text in texts)} m; the halved "
        f"ranges give {' and '.join(text[1] for text in texts)} m, the whole ones "
        f"{' and '.join(text[0] for text in texts)} m",
    )


def hamiltonian_drift(section: Configuration, transposed: bool) -> tuple[float, float]:
    """Hamiltonian at both ends of a flight from Meeny's start with the listing's guess."""
    parameters = Parameters.from_section(section)
    race = parameters.races["scenario-1"]
    cubesat = next(c for c in race.cubesats if c.name == "Meeny")
    state = np.r_[cubesat.position, np.zeros(3)]
    guess, _ = listing.guess(
        state, 0.0, targets(race.course)[0], cubesat.thrust, parameters.listing
    )
    _, flown = propagate_segment(
        state, guess[:6], SECONDS, cubesat, parameters.mean_motion, 1.0, 1e-12, transposed
    )
    a = rate_matrix(parameters.mean_motion)
    first, last = (
        float(y[6:] @ (a @ y[:6]) - cubesat.thrust * np.linalg.norm(y[9:])) for y in flown[[0, -1]]
    )
    return first, last


def costate_transpose(grounds: Grounds[Configuration]) -> Proof:
    """Listing C.F: the Hamiltonian of a flight with either matrix."""
    first, last = hamiltonian_drift(grounds.section, transposed=False)
    right_first, right_last = hamiltonian_drift(grounds.section, transposed=True)
    drift, rest = abs(last - first), abs(right_last - right_first)
    return Proof(
        drift > DRIFTING * abs(first) and rest < CONSTANT * abs(right_first),
        f"H from {first:.4f} to {last:.4f} in {SECONDS:g} s",
        f"H constant to {max(rest, 1e-15):.0e}",
        f"flown for {SECONDS:g} s from the listing's guess, the Hamiltonian goes from "
        f"{first:.4f} to {last:.4f} with the printed matrix and stays within "
        f"{max(rest, 1e-15):.0e} with the transposed one, as Section II.B.5 says it must",
    )


def printed_adjoint_transition(n: float, t: float) -> np.ndarray:
    """The matrix of Eq. 18 as printed, shape (6, 6), for a mean motion, rad/s, and a time, s."""
    s, c = np.sin(n * t), np.cos(n * t)
    return np.array(
        [
            [4 - 3 * c, 6 * (n * t - s), 0, -3 * n * s, 6 * n * (c - 1), 0],
            [0, 1, 0, 0, 0, 0],
            [0, 0, c, 0, 0, n * s],
            [-s / n, 2 / n * (c - 1), 0, c, 2 * s, 0],
            [2 / n * (1 - c), -s / n, 0, -2 * s, 4 * c - 3, 0],
            [0, 0, -s / n, 0, 0, c],
        ]
    )


def adjoint_transition(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 18 is compared with the matrix exponential of Eq. 17, entry by entry."""
    n, t = Parameters.from_section(grounds.section).mean_motion, 10.0 * SECONDS
    exact = expm(costate_matrix(n) * t)
    printed = printed_adjoint_transition(n, t)
    # Rows and columns in units in which a time is measured by the orbit.
    scale = np.repeat([1.0, n], 3)
    error = np.abs((printed - exact) * scale[:, None] / scale)
    wrong = [(int(i) + 1, int(j) + 1) for i, j in np.argwhere(error > 1e-9)]
    mended = 3.0 * t - 4.0 / n * np.sin(n * t)
    right = abs(mended - exact[4, 1]) < 1e-9 * abs(exact[4, 1])
    return Proof(
        wrong == [(5, 2)] and right,
        f"{printed[4, 1]:.3f} s after {t:g} s",
        f"{mended:.3f} s",
        f"of the 36 entries after {t:g} s the matrix exponential differs in "
        f"{len(wrong)}, {wrong}: it has {exact[4, 1]:.3f} where the print gives "
        f"{printed[4, 1]:.3f} and the correction {mended:.3f}",
    )


def ring_size(grounds: Grounds[Configuration]) -> Proof:
    """The least entry of S is taken for every ring of Scenario 1."""
    course = Parameters.from_section(grounds.section).races["scenario-1"].course
    least = [float(np.min(np.diag(axes))) for axes in course.semi_axes]
    return Proof(
        max(least) == 0.0 and course.sizes.min() > 0.0,
        "0 m for every ring",
        f"{course.sizes.min():.2f} to {course.sizes.max():.2f} m",
        f"for all {course.rings} rings the least entry of diag(a, b) is 0, while the smaller "
        f"axes are {course.sizes.min():.2f} to {course.sizes.max():.2f} m: by the listing no "
        f"point but the centre is inside. The listing that builds S is not printed; it is "
        f"taken as Section I defines it",
    )


def axial_thrust(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 24, the listings' law and the minimiser are taken at one primer vector."""
    parameters = Parameters.from_section(grounds.section)
    axial = [c for c in parameters.races["scenario-1"].cubesats if c.axis_thrust]
    if not axial:
        raise LookupError("no CubeSat has axial thrusters")
    mo = axial[0]
    limits, deadzone = np.array(mo.axis_thrust), parameters.listing.deadzone
    equation = np.where(np.abs(PRIMER) > deadzone, -limits * np.sign(PRIMER), 0.0)
    listing = np.array(thrust_components(PRIMER, NORM_OF_AXES, limits, deadzone))
    best = np.array(thrust_components(PRIMER, AXIS_BY_AXIS, limits, deadzone))
    exceeds = float((np.abs(listing) / limits).max())
    return Proof(
        equation[1] == 0.0
        and abs(listing[1]) > 0.0
        and exceeds > 1.0
        and PRIMER @ best < PRIMER @ equation,
        f"u = {_vector(equation)}, p.u = {PRIMER @ equation:.4f}",
        f"code: {_vector(listing)}; minimiser: {_vector(best)}",
        f"for a primer of {_vector(PRIMER)} Eq. 24 gives {_vector(equation)} m/s^2, the code "
        f"{_vector(listing)}, which has the axis that should be off and {exceeds:.2f} times "
        f"the limit of another, and the minimiser over the limits of Table 1 {_vector(best)}; "
        f"p.u is {PRIMER @ equation:.3f}, {PRIMER @ listing:.3f} and {PRIMER @ best:.3f}",
    )


def _vector(values: np.ndarray) -> str:
    return "(" + ", ".join(f"{value:.4g}" for value in values) + ")"


# Options of Listing C.C, and the algorithms of `fmincon` that MathWorks documents them for.
OPTIONS = {
    "fmincon-enablefeasibilitymode": {"interior-point"},
    "fmincon-subproblemalgorithm": {"interior-point"},
    "fmincon-maxfunctionevaluations": {"active-set", "interior-point", "sqp", "sqp-legacy"},
}
LISTED = "listing-c-c-solvetrajectory-m"


def options_without_effect(grounds: Grounds) -> Proof:
    """Each option that the listing sets is looked up for the algorithm that it sets."""
    algorithm = grounds.ledger.literal(f"{LISTED}/fmincon-algorithm")
    idle = [name for name, algorithms in OPTIONS.items() if algorithm not in algorithms]
    return Proof(
        idle == list(OPTIONS)[:2],
        f"{len(OPTIONS)} options with {algorithm}",
        f"{len(OPTIONS) - len(idle)} of them without the other {len(idle)}",
        f"of the options that the listing sets beside the algorithm '{algorithm}', the "
        f"documentation of fmincon gives {len(idle)} to another algorithm alone; they do nothing",
    )


def adjoint_guess(grounds: Grounds[Configuration]) -> Proof:
    """The listing's guess for a second segment against the adjoints at the end of the first."""
    parameters = Parameters.from_section(grounds.section)
    race = parameters.races["scenario-1"]
    cubesat = next(c for c in race.cubesats if c.name == "Meeny")
    first, second = targets(race.course)[:2]
    state = np.r_[cubesat.position, np.zeros(3)]
    unknowns, _ = listing.guess(state, 0.0, first, cubesat.thrust, parameters.listing)
    _, flown = propagate_segment(
        state, unknowns[:6], SECONDS, cubesat, parameters.mean_motion, 1.0, 1e-12, False
    )
    carried = flown[-1, 6:]
    anew, _ = listing.guess(flown[-1, :6], SECONDS, second, cubesat.thrust, parameters.listing)
    apart = float(np.linalg.norm(anew[:6] - carried) / np.linalg.norm(carried))
    return Proof(
        apart > DRIFTING,
        f"{_vector(carried)}",
        f"{_vector(anew[:6])}",
        f"after a first segment of {SECONDS:g} s with the listing's guess, Section V would begin "
        f"the next with {_vector(carried)}; lines 46 to 53 begin it with {_vector(anew[:6])}, made "
        f"of the direction from the last ring and of that to the next, over the speed",
    )


def start_of_meeny(grounds: Grounds[Configuration]) -> Proof:
    """The draws that follow the second course, at the digits of Table 3."""
    parameters = Parameters.from_section(grounds.section)
    crafts = parameters.races["scenario-2"].cubesats
    _, places = start_positions(parameters, _seeds(grounds.section)["scenario-2"], len(crafts))
    misfits = {}
    for craft, place in zip(crafts, places, strict=True):
        for axis, value in (("x", place[0]), ("z", place[2])):
            name = f"table-3/initial-position/scenario-2-{craft.name.lower()}/{axis}"
            if not grounds.ledger.value(name).matches(float(value)):
                misfits[f"{craft.name}'s {axis}"] = (grounds.ledger.literal(name), float(value))
    found = misfits.get("Meeny's x", ("", np.nan))
    return Proof(
        list(misfits) == ["Meeny's x"],
        f"{found[0]} m",
        f"{found[1]:.1f} m",
        f"of the {2 * len(crafts)} scattered coordinates of Table 3 the stream gives all to the "
        f"digit but {', '.join(misfits) or 'none'}, printed as {found[0]} m and drawn as "
        f"{found[1]:.3f} m: cut off, and not rounded",
        correct=float(found[1]),
    )
