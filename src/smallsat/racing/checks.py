"""Is the optimum one? Finer meshes, other starts, dynamic programming, Pontryagin's conditions."""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.dynamics.clohessy_wiltshire import costate_transition, rate_matrix
from smallsat.racing.course import Course
from smallsat.racing.course_program import Arcs, Leg, Plan, length_unit
from smallsat.racing.cubesat import CubeSat
from smallsat.racing.flight import fly_plan, residual
from smallsat.racing.parameters import Parameters
from smallsat.racing.races import ANYWHERE, REST, WHOLE, program, whole_leg

SATURATED = 1.0 - 1e-3
# Random guesses: ring speeds and durations between these, scaled.
SPEEDS, TIMES = (0.3, 1.2), (1.6, 3.5)
# A primer below this share of its largest value has no direction to speak of.
SMALL_PRIMER = 0.05


def mesh_refinement(given: Parameters, section: Config, scenario: str) -> pd.DataFrame:
    """Whole-course optimum of every CubeSat on meshes that each contain the last one's plans."""
    numerics, race = section["optimum"], given.races[scenario]
    rows = []
    for cubesat in race.cubesats:
        leg, plan = whole_leg(race.course, cubesat), None
        for intervals in (numerics["intervals"], *numerics["finer_intervals"]):
            solver = program(race.course.rings, "state", intervals)
            plan = (
                solver.refine(leg, cubesat, given.mean_motion, plan)
                if plan
                else solver.solve(leg, cubesat, given.mean_motion)
            )
            flown = fly_plan(plan, given.mean_motion)
            rows.append(
                {
                    "scenario": scenario,
                    "cubesat": cubesat.name,
                    "intervals": intervals,
                    "time_s": plan.time,
                    "converged": plan.converged,
                    "residual": residual(plan, flown, cubesat, race.course),
                }
                | primer_check(plan, cubesat, given.mean_motion)
            )
    return pd.DataFrame(rows)


def primer_check(plan: Plan, cubesat: CubeSat, mean_motion: float) -> dict[str, float]:
    """How a plan keeps the minimum principle, from the multipliers alone.

    Angles between thrust and the opposite of the primer at the middle of each piece, where the
    primer has a direction; for axial thrusters the share of pieces in which every axis has the sign
    that the primer asks for. The Hamiltonian, which has to be -1, over all pieces.
    """
    segments, intervals, _ = plan.controls.shape
    flown = fly_plan(plan, mean_motion)
    a = rate_matrix(mean_motion)
    angles, signs, hamiltonians, jumps, full = [], [], [], [], []
    steps = (flown.shape[1] - 1) // intervals
    for k in range(segments):
        h = plan.durations[k] / intervals
        primers = np.array(
            [
                (costate_transition(mean_motion, (i + 0.5) * h) @ plan.costates[k])[3:]
                for i in range(intervals)
            ]
        )
        large = np.linalg.norm(primers, axis=1) > SMALL_PRIMER * np.abs(primers).max()
        thrust = plan.controls[k]
        if cubesat.axis_thrust:
            used = np.abs(thrust) / np.array(cubesat.axis_thrust)
            clear = np.abs(primers) > SMALL_PRIMER * np.abs(primers).max()
            signs.append((np.sign(thrust) == -np.sign(primers))[clear])
            full.append((used > SATURATED)[clear])
        else:
            across = np.linalg.norm(np.cross(thrust, -primers), axis=1)
            along = -np.sum(thrust * primers, axis=1)
            angles.append(np.degrees(np.arctan2(across, along))[large])
            full.append(np.linalg.norm(thrust, axis=1) / cubesat.thrust > SATURATED)
        for i in range(intervals):
            p = costate_transition(mean_motion, i * h) @ plan.costates[k]
            hamiltonians.append(p @ (a @ flown[k, i * steps]) + p[3:] @ thrust[i])
        if k + 1 < segments:
            arriving = costate_transition(mean_motion, plan.durations[k]) @ plan.costates[k]
            jumps.append(np.linalg.norm((arriving - plan.costates[k + 1])[:3]))
    found = {
        "hamiltonian_error": float(np.abs(np.array(hamiltonians) + 1.0).max()),
        "hamiltonian_median_error": float(np.median(np.abs(np.array(hamiltonians) + 1.0))),
        "largest_ring_multiplier_s_m": float(max(jumps)) if jumps else 0.0,
        "full_thrust_share": float(np.concatenate(full).mean()),
    }
    if cubesat.axis_thrust:
        return found | {"sign_share": float(np.concatenate(signs).mean())}
    every = np.concatenate(angles)
    return found | {
        "primer_angle_median_deg": float(np.median(every)),
        "primer_angle_largest_deg": float(every.max()),
    }


def other_starts(given: Parameters, section: Config, scenario: str) -> pd.DataFrame:
    """The whole-course optimum of every CubeSat from random first guesses."""
    numerics, race = section["optimum"], given.races[scenario]
    rows = []
    for place, cubesat in enumerate(race.cubesats):
        draws = np.random.default_rng([numerics["seed"], place])
        solver = program(race.course.rings, "state", numerics["intervals"])
        for start in range(numerics["starts"]):
            arcs = Arcs(
                draws.uniform(*SPEEDS, race.course.rings),
                draws.uniform(*TIMES, race.course.rings + 1),
            )
            leg = whole_leg(race.course, cubesat)
            plan = solver.solve(leg, cubesat, given.mean_motion, arcs=arcs)
            rows.append(
                {
                    "scenario": scenario,
                    "cubesat": cubesat.name,
                    "start": start,
                    "time_s": plan.time,
                    "converged": plan.converged,
                    "status": plan.solution.status,
                }
            )
    return pd.DataFrame(rows)


def dynamic_programming(given: Parameters, section: Config, scenario: str) -> pd.DataFrame:
    """Least time over the ring speeds, the only free part of a state at a ring.

    A table of least times from speed to speed for every segment, first on a grid of speeds, then on
    ever finer ones around the best path. Each entry is a solve of one segment with both ends fixed,
    on the mesh of the whole-course program, which it must agree with.
    """
    numbers, race = section["dynamic_programming"], given.races[scenario]
    cubesat = next(c for c in race.cubesats if c.name == numbers["cubesat"])
    course = race.course
    length = length_unit(np.vstack([cubesat.position, course.centres, course.end]))
    unit = float(np.sqrt(length * cubesat.thrust))
    grid = unit * np.linspace(numbers["least_speed"], numbers["largest_speed"], numbers["speeds"])
    choices = [grid] * course.rings
    known: dict[tuple[int, float, float], float] = {}
    spacing = float(grid[1] - grid[0])
    rows: list[dict[str, Any]] = []
    for level in range(numbers["refinements"] + 1):
        total, path = _best_path(given, section, course, cubesat, choices, known)
        rows.append(
            {
                "scenario": scenario,
                "cubesat": cubesat.name,
                "level": level,
                "spacing_m_s": spacing,
                "segments_solved": len(known),
                "time_s": total,
            }
        )
        spacing /= 2.0
        least = numbers["least_speed"] * unit / 100.0
        choices = [np.maximum([s - spacing, s, s + spacing], least) for s in path]
    return pd.DataFrame(rows)


def _best_path(
    given: Parameters,
    section: Config,
    course: Course,
    cubesat: CubeSat,
    choices: list[np.ndarray],
    known: dict[tuple[int, float, float], float],
) -> tuple[float, list[float]]:
    """Bellman's recursion from the finish back to the start."""
    ends = [*choices, np.zeros(1)]
    starts = [np.zeros(1), *choices]
    values, decisions = np.zeros(1), []
    for k in reversed(range(course.rings + 1)):
        times = np.array(
            [
                [_segment_time(given, section, course, cubesat, k, v, w, known) for w in ends[k]]
                for v in starts[k]
            ]
        )
        totals = times + values
        decisions.append(totals.argmin(axis=1))
        values = totals.min(axis=1)
    path, place = [], 0
    for k, decision in enumerate(reversed(decisions)):
        place = int(decision[place])
        if k < course.rings:
            path.append(float(ends[k][place]))
    return float(values[0]), path


def _segment_time(
    given: Parameters,
    section: Config,
    course: Course,
    cubesat: CubeSat,
    k: int,
    before: float,
    after: float,
    known: dict[tuple[int, float, float], float],
) -> float:
    """Least time of segment k between given speeds; infinite where the solver finds none."""
    key = (k, round(before, 9), round(after, 9))
    if key not in known:
        final = k == course.rings
        leg = Leg(
            cubesat.position if k == 0 else course.centres[k - 1],
            REST if k == 0 else before * course.normals[k - 1],
            course.centres[:0],
            course.normals[:0],
            course.end if final else course.centres[k],
            REST if final else after * course.normals[k],
        )
        solver = program(0, "state", section["optimum"]["intervals"])
        plan = solver.solve(leg, cubesat, given.mean_motion)
        known[key] = plan.time if plan.converged else np.inf
    return known[key]


def thrust_sweep(given: Parameters, section: Config, scenario: str) -> pd.DataFrame:
    """The optimum over thrust, from the middle of the start: what it does to time and accuracy."""
    course, rows = given.races[scenario].course, []
    for thrust in section["thrust_sweep_m_s2"]:
        cubesat = CubeSat("any", thrust, (), course.start)
        row: dict[str, Any] = {"scenario": scenario, "thrust_m_s2": thrust}
        for name, finish in ((WHOLE, "state"), (ANYWHERE, "rest anywhere")):
            solver = program(course.rings, finish, section["optimum"]["intervals"])
            plan = solver.solve(whole_leg(course, cubesat), cubesat, given.mean_motion)
            flown = fly_plan(plan, given.mean_motion)
            row |= {
                f"{name} (s)": plan.time,
                f"{name}, converged": plan.converged,
                f"{name}, residual": residual(plan, flown, cubesat, course),
            }
        check = primer_check(plan, cubesat, given.mean_motion)
        row["largest_ring_multiplier_s_m"] = check["largest_ring_multiplier_s_m"]
        rows.append(row)
    return pd.DataFrame(rows)


def start_positions(given: Parameters, section: Config, scenario: str) -> pd.DataFrame:
    """The optimum from random places at the start, drawn as the document draws them."""
    numbers, course = section["random_courses"], given.races[scenario].course
    draws = np.random.default_rng([numbers["seed"], 1])
    rows = []
    for number in range(numbers["positions"]):
        offset = given.scatter * np.array([1.0, 0.0, 1.0]) * draws.standard_normal(3)
        cubesat = CubeSat("any", numbers["thrust_m_s2"], (), course.start + offset)
        solver = program(course.rings, "state", section["optimum"]["intervals"])
        plan = solver.solve(whole_leg(course, cubesat), cubesat, given.mean_motion)
        rows.append(
            {
                "scenario": scenario,
                "number": number,
                "x_m": offset[0],
                "z_m": offset[2],
                "time_s": plan.time,
                "converged": plan.converged,
            }
        )
    return pd.DataFrame(rows)
