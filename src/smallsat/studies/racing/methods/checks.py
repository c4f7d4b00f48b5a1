"""Is the optimum one? Finer meshes, other starts, Pontryagin's conditions, sweeps.

Each check gives its table, and the cases in it without a solution, whose numbers are missing.
"""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import costate_transition, rate_matrix
from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.course_program import Arcs, Plan
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.methods.races import ANYWHERE, WHOLE, program, whole_leg
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

SATURATED = 1.0 - 1e-3
# Random guesses: ring speeds and durations between these, scaled.
SPEEDS, TIMES = (0.3, 1.2), (1.6, 3.5)
# A primer below this share of its largest value has no direction to speak of.
SMALL_PRIMER = 0.05
# Columns of `mesh_refinement` that are there even if nothing converged.
MESH = ["residual", "hamiltonian_error", "hamiltonian_median_error"]
MESH += ["largest_ring_multiplier_s_m", "full_thrust_share", "primer_angle_median_deg"]
MESH += ["primer_angle_largest_deg", "sign_share"]


Checked = tuple[pd.DataFrame, list[NotConverged]]


def mesh_refinement(parameters: Parameters, section: Configuration, scenario: str) -> Checked:
    """Whole-course optimum of every CubeSat on meshes that each contain the last one's plans."""
    numerics, race = section.optimum, parameters.races[scenario]
    rows, missing = [], []
    for cubesat in race.cubesats:
        leg, coarser = whole_leg(race.course, cubesat), None
        for intervals in (numerics.intervals, *numerics.finer_intervals):
            solver = program(race.course.rings, "state", intervals)
            plan = solver.refine(leg, cubesat, parameters.mean_motion, coarser) if coarser else None
            if plan is None or not plan.converged:
                plan = attempts.solve(solver, leg, cubesat, parameters.mean_motion)
            row = {"scenario": scenario, "cubesat": cubesat.name, "intervals": intervals}
            if plan.converged:
                coarser = plan
                flown = propagate_plan(plan, parameters.mean_motion)
                row |= {
                    "time_s": plan.time,
                    "converged": True,
                    "residual": residual(plan, flown, cubesat, race.course),
                } | primer_check(plan, cubesat, parameters.mean_motion)
            else:
                case = f"{scenario}, {cubesat.name}, whole course, {intervals} pieces a segment"
                missing.append(attempts.not_converged(case, plan, cubesat, parameters.mean_motion))
                row |= {"time_s": np.nan, "converged": False}
            rows.append(row)
    return pd.DataFrame(rows, columns=_columns(rows, MESH)), missing


def _columns(rows: list[dict[str, Any]], least: list[str]) -> list[str]:
    """The columns that rows have, in their order, and those that none of them has."""
    return list(dict.fromkeys([*(name for row in rows for name in row), *least]))


def primer_check(plan: Plan, cubesat: CubeSat, mean_motion: float) -> dict[str, float]:
    """How a plan keeps the minimum principle, from the multipliers alone.

    Angles between thrust and the opposite of the primer at the middle of each piece, where the
    primer has a direction; for axial thrusters the share of pieces in which every axis has the sign
    that the primer asks for. The Hamiltonian, which has to be -1, over all pieces.
    """
    segments, intervals, _ = plan.controls.shape
    flown = propagate_plan(plan, mean_motion)
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


def other_starts(parameters: Parameters, section: Configuration, scenario: str) -> pd.DataFrame:
    """The whole-course optimum of every CubeSat from random first guesses."""
    numerics, race = section.optimum, parameters.races[scenario]
    rows = []
    for place, cubesat in enumerate(race.cubesats):
        draws = np.random.default_rng([numerics.seed, place])
        solver = program(race.course.rings, "state", numerics.intervals)
        for start in range(numerics.starts):
            arcs = Arcs(
                draws.uniform(*SPEEDS, race.course.rings),
                draws.uniform(*TIMES, race.course.rings + 1),
            )
            leg = whole_leg(race.course, cubesat)
            plan = solver.solve(leg, cubesat, parameters.mean_motion, arcs=arcs)
            rows.append(
                {
                    "scenario": scenario,
                    "cubesat": cubesat.name,
                    "start": start,
                    "time_s": plan.time if plan.converged else np.nan,
                    "converged": plan.converged,
                    "status": plan.solution.status,
                }
            )
    return pd.DataFrame(rows)


def thrust_sweep(parameters: Parameters, section: Configuration, scenario: str) -> Checked:
    """The optimum over thrust, from the middle of the start: what it does to time and accuracy."""
    course = parameters.races[scenario].course
    rows, missing = [], []
    for thrust in sorted(section.thrust_sweep_m_s2):
        cubesat = CubeSat("any", thrust, (), course.start)
        row: dict[str, Any] = {"scenario": scenario, "thrust_m_s2": thrust}
        multiplier = delta_v = np.nan
        for name, finish in ((WHOLE, "state"), (ANYWHERE, "rest anywhere")):
            solver = program(course.rings, finish, section.optimum.intervals)
            leg = whole_leg(course, cubesat)
            plan = attempts.solve(solver, leg, cubesat, parameters.mean_motion)
            if not plan.converged:
                case = f"{scenario}, thrust of {thrust:g} m/s^2, {name}"
                missing.append(attempts.not_converged(case, plan, cubesat, parameters.mean_motion))
            flown = propagate_plan(plan, parameters.mean_motion)
            row |= {
                f"{name} (s)": plan.time if plan.converged else np.nan,
                f"{name}, converged": plan.converged,
                f"{name}, residual": (
                    residual(plan, flown, cubesat, course) if plan.converged else np.nan
                ),
            }
            if plan.converged:
                check = primer_check(plan, cubesat, parameters.mean_motion)
                multiplier = check["largest_ring_multiplier_s_m"]
            if name == WHOLE and plan.converged:
                delta_v = plan.delta_v
        rows.append(
            row | {"largest_ring_multiplier_s_m": multiplier, f"{WHOLE}, delta-v (m/s)": delta_v}
        )
    return pd.DataFrame(rows), missing


def start_positions(parameters: Parameters, section: Configuration, scenario: str) -> Checked:
    """The optimum from random places at the start, drawn as the document draws them."""
    numbers, course = section.random_courses, parameters.races[scenario].course
    draws = np.random.default_rng([numbers.seed, 1])
    solver = program(course.rings, "state", section.optimum.intervals)
    rows, missing = [], []
    for number in range(numbers.positions):
        offset = parameters.scatter * np.array([1.0, 0.0, 1.0]) * draws.standard_normal(3)
        cubesat = CubeSat("any", numbers.thrust_m_s2, (), course.start + offset)
        plan = attempts.solve(solver, whole_leg(course, cubesat), cubesat, parameters.mean_motion)
        if not plan.converged:
            case = f"{scenario}, random place {number} at the start"
            missing.append(attempts.not_converged(case, plan, cubesat, parameters.mean_motion))
        rows.append(
            {
                "scenario": scenario,
                "number": number,
                "x_m": offset[0],
                "z_m": offset[2],
                "time_s": plan.time if plan.converged else np.nan,
                "converged": plan.converged,
            }
        )
    return pd.DataFrame(rows), missing
