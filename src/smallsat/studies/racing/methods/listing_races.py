"""The races as the listings solve them, segment after segment, as tidy tables."""

import time
from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from scipy.linalg import expm

from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.flight import (
    COSTATE,
    POINTS,
    minimum_cost,
    propagate_segment,
    ring_rows,
    segment_table,
)
from smallsat.studies.racing.methods.listing import Segment, Target, solve_segment
from smallsat.studies.racing.methods.races import (
    LISTING,
    REST,
    Tables,
    segment_leg,
    segment_name,
    totals,
)
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.model.shooting import costate_matrix, law_of, thrust_along
from smallsat.studies.racing.parameters import Listing, Parameters

# Variants of our solve of the listing.
AS_LISTED, MENDED = "as listed", "both"
DIRECT_GUESS, MENDED_DIRECT_GUESS = (
    "guess from the direct method",
    "both, guess from the direct method",
)
# Columns of the table that `without_thrust` makes, also where no CubeSat is bound to its axes.
WITHOUT_THRUST = ["scenario", "cubesat", "tolerance", "segments"]
WITHOUT_THRUST += ["segments_without_thrust", "without_thrust_s"]
# Points a segment at which its thrust is looked at.
IDLE_POINTS = 2000


def solve_listing(
    parameters: Parameters,
    section: Configuration,
    scenario: str,
    listing: Listing,
    cubesats: tuple[str, ...] = (),
    *,
    paths: bool = True,
) -> Tables:
    """Every CubeSat of a scenario, or those named; trajectories only with ``paths``."""
    tables = Tables()
    race = parameters.races[scenario]
    for cubesat in race.cubesats:
        if not cubesats or cubesat.name in cubesats:
            key = {"scenario": scenario, "cubesat": cubesat.name, "solution": LISTING}
            _solve(
                tables,
                key,
                parameters,
                listing,
                race.course,
                cubesat,
                section.optimum.intervals,
                paths=paths,
            )
    return tables


def targets(course: Course) -> list[Target]:
    """What each segment of a course aims at."""
    centres = [course.start, *course.centres, course.end]
    return [
        Target(
            centre=centres[k + 1],
            normal=course.normals[min(k, course.rings - 1)],
            size=float(course.sizes[k]) if k < course.rings else 0.0,
            previous_centre=centres[k],
            final=k == course.rings,
        )
        for k in range(course.rings + 1)
    ]


def _solve(
    tables: Tables,
    key: dict[str, Any],
    parameters: Parameters,
    listing: Listing,
    course: Course,
    cubesat: CubeSat,
    intervals: int,
    *,
    paths: bool,
) -> None:
    states, times = [np.r_[cubesat.position, REST]], [0.0]
    solved: list[Segment] = []
    clock = time.perf_counter()
    for k, target in enumerate(targets(course)):
        unknowns = None
        if listing.direct_guess:
            unknowns = _direct_guess(
                course, k, states[-1], times[-1], cubesat, parameters.mean_motion, intervals
            )
        one = solve_segment(
            states[-1], times[-1], target, cubesat, parameters.mean_motion, listing, unknowns
        )
        solved.append(one)
        states.append(one.end)
        times.append(one.arrival)
    tables.seconds.append(key | {"seconds": time.perf_counter() - clock})
    names = [segment_name(course, k) for k in range(course.rings + 1)]
    spent = []
    for k, one in enumerate(solved):
        if paths:
            path = _flown(k, states[k], times[k], one, cubesat, parameters.mean_motion, listing)
            tables.trajectories.append(path.assign(**key))
        duration = one.arrival - times[k]
        thrust = _thrust(one.costate, duration, POINTS, cubesat, parameters.mean_motion, listing)
        spent.append(
            float(np.trapezoid(np.linalg.norm(thrust, axis=1), dx=duration / (POINTS - 1)))
        )
        tables.segments.append(
            key
            | {
                "segment": k,
                "name": names[k],
                "duration_s": duration,
                "converged": one.converged,
                "status": one.status,
                "violation": one.violation,
                "evaluations": one.evaluations,
                **dict(zip(COSTATE, one.costate.tolist(), strict=True)),
            }
        )
    rows = ring_rows(
        course, np.array(states[1:]), np.array(times[1:]), parameters.plane, parameters.pointing
    )
    tables.rings += [key | row for row in rows]
    tables.races.append(
        key
        | totals(
            course,
            rows,
            [name for name, one in zip(names, solved, strict=True) if not one.converged],
            minimum_cost(np.array(states[:-1]), course, cubesat.thrust),
            sum(spent),
            times[-1],
            sum(one.evaluations for one in solved),
        )
    )


def _direct_guess(
    course: Course,
    k: int,
    state: np.ndarray,
    began: float,
    cubesat: CubeSat,
    mean_motion: float,
    intervals: int,
) -> np.ndarray | None:
    """Costates and time of arrival (7,) of segment k by the direct method; None without them."""
    solver, leg = segment_leg(course, k, state, intervals)
    plan = attempts.solve(solver, leg, cubesat, mean_motion)
    return np.r_[plan.costates[0], began + plan.time] if plan.converged else None


def _flown(
    number: int,
    state: np.ndarray,
    began: float,
    solved: Segment,
    cubesat: CubeSat,
    mean_motion: float,
    listing: Listing,
) -> pd.DataFrame:
    duration = solved.arrival - began
    times, flown = propagate_segment(
        state, solved.costate, duration, cubesat, mean_motion, listing.deadzone, listing.tolerance,
        listing.transposed,
    )  # fmt: skip
    return segment_table(number, began, times, flown, cubesat, listing.deadzone)


def flights(listing: Listing, section: Configuration) -> list[Listing]:
    """The same solve on flights to the listing's tolerance, and to others next to it.

    None converges, so that where each ends hangs on the last bits of its flights, and with them on
    the processor. What holds of all of them hangs on neither.
    """
    tolerances = {listing.tolerance, *section.listing.other_tolerances}
    return [replace(listing, tolerance=one) for one in sorted(tolerances, reverse=True)]


def variants(
    parameters: Parameters, section: Configuration, scenario: str, cubesats: tuple[str, ...] = ()
) -> pd.DataFrame:
    """What our solve of the listing becomes where one thing is done otherwise, on all `flights`."""
    base = parameters.listing
    mended = replace(base, ring_sizes=True, transposed=True)
    changes = {
        AS_LISTED: base,
        "rings have their smaller axis as size": replace(base, ring_sizes=True),
        "costates mended": replace(base, transposed=True),
        MENDED: mended,
        DIRECT_GUESS: replace(base, direct_guess=True),
        MENDED_DIRECT_GUESS: replace(mended, direct_guess=True),
    }
    parts = []
    for name, changed in changes.items():
        for listing in flights(changed, section):
            races = solve_listing(
                parameters, section, scenario, listing, cubesats, paths=False
            ).races
            # Which solve it is stands in the name of the variant.
            table = pd.DataFrame(races).drop(columns="solution")
            table.insert(2, "variant", name)
            table.insert(3, "tolerance", listing.tolerance)
            parts.append(table)
    return pd.concat(parts, ignore_index=True)


def without_thrust(parameters: Parameters, section: Configuration) -> pd.DataFrame:
    """How long the deadzone leaves CubeSats with thrusters on axes without any thrust, s.

    In our solves of the listing of every race, on all `flights`; a row each.
    """
    rows = []
    for scenario, race in parameters.races.items():
        bound = {craft.name: craft for craft in race.cubesats if craft.axis_thrust}
        if not bound:
            continue
        for listing in flights(parameters.listing, section):
            solved = solve_listing(
                parameters, section, scenario, listing, tuple(bound), paths=False
            ).segments
            for name, segments in pd.DataFrame(solved).groupby("cubesat", sort=False):
                idle = [
                    _idle(segment, bound[str(name)], parameters.mean_motion, listing)
                    for segment in segments.to_dict("records")
                ]
                rows.append(
                    {
                        "scenario": scenario,
                        "cubesat": name,
                        "tolerance": listing.tolerance,
                        "segments": len(idle),
                        "segments_without_thrust": int(np.count_nonzero(idle)),
                        "without_thrust_s": sum(idle),
                    }
                )
    return pd.DataFrame(rows, columns=WITHOUT_THRUST)


def _idle(
    segment: Mapping[Hashable, Any], cubesat: CubeSat, mean_motion: float, listing: Listing
) -> float:
    """Seconds of a segment in which no component of the primer is above the deadzone."""
    duration = segment["duration_s"]
    costate = np.array([segment[name] for name in COSTATE])
    thrust = _thrust(costate, duration, IDLE_POINTS + 1, cubesat, mean_motion, listing)[:-1]
    return duration * np.count_nonzero(~thrust.any(axis=1)) / IDLE_POINTS


def _thrust(
    costate: np.ndarray,
    duration: float,
    points: int,
    cubesat: CubeSat,
    mean_motion: float,
    listing: Listing,
) -> np.ndarray:
    """Thrust (points, 3) of a segment at equal times, both ends among them, from its costate (6,).

    It hangs on the costates alone, whose law is linear.
    """
    law, limits = law_of(cubesat)
    matrix = costate_matrix(mean_motion, listing.transposed)
    step = expm(matrix * duration / (points - 1))
    return thrust_along(costate, step, points, law, limits, listing.deadzone)
