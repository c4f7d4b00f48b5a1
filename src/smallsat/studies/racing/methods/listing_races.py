"""The races as the listings solve them, segment after segment, as tidy tables."""

import time
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.flight import (
    COSTATE,
    THRUST,
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
from smallsat.studies.racing.parameters import Listing, Parameters

AS_LISTED, DIRECT_GUESS = "as listed", "guess from the direct method"


def solve_listing(
    parameters: Parameters,
    section: Configuration,
    scenario: str,
    listing: Listing,
    cubesats: tuple[str, ...] = (),
) -> Tables:
    """Every CubeSat of a scenario, or those named."""
    tables = Tables()
    race = parameters.races[scenario]
    for cubesat in race.cubesats:
        if not cubesats or cubesat.name in cubesats:
            key = {"scenario": scenario, "cubesat": cubesat.name, "solution": LISTING}
            _solve(
                tables, key, parameters, listing, race.course, cubesat, section.optimum.intervals
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
        path = _flown(k, states[k], times[k], one, cubesat, parameters.mean_motion, listing)
        tables.trajectories.append(path.assign(**key))
        spent.append(
            float(np.trapezoid(np.linalg.norm(path[THRUST], axis=1), path["time_s"].to_numpy()))
        )
        tables.segments.append(
            key
            | {
                "segment": k,
                "name": names[k],
                "duration_s": times[k + 1] - times[k],
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


def variants(
    parameters: Parameters, section: Configuration, scenario: str, cubesats: tuple[str, ...] = ()
) -> pd.DataFrame:
    """What our solve of the listing becomes where one thing is done otherwise."""
    base = parameters.listing
    mended = replace(base, ring_sizes=True, transposed=True)
    changes = {
        AS_LISTED: base,
        "rings have their smaller axis as size": replace(base, ring_sizes=True),
        "costates mended": replace(base, transposed=True),
        "both": mended,
        DIRECT_GUESS: replace(base, direct_guess=True),
        f"both, {DIRECT_GUESS}": replace(mended, direct_guess=True),
    } | {
        f"flights to {tolerance:g}": replace(base, tolerance=tolerance)
        for tolerance in section.listing.other_tolerances
    }
    parts = []
    for name, listing in changes.items():
        table = pd.DataFrame(solve_listing(parameters, section, scenario, listing, cubesats).races)
        table["solution"] = name
        parts.append(table.rename(columns={"solution": "variant"}))
    return pd.concat(parts, ignore_index=True)
