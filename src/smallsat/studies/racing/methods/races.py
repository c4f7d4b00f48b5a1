"""The races: both scenarios, by every kind of solution, as tidy tables."""

import time
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts, indirect
from smallsat.studies.racing.methods.course_program import (
    LEAST_SPEED,
    CourseProgram,
    Leg,
    Plan,
    length_unit,
)
from smallsat.studies.racing.methods.flight import (
    COSTATE,
    RING,
    STATE,
    THRUST,
    minimum_cost,
    plan_table,
    propagate_plan,
    residual,
    ring_rows,
)
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

LISTING = "our solve of the listing"
GREEDY = "segment by segment"
INDIRECT = "segment by segment, indirect"
WHOLE = "whole course"
ANYWHERE = "whole course, rest anywhere"
SOLUTIONS = (LISTING, GREEDY, INDIRECT, WHOLE, ANYWHERE)
# The start positions lie in a plane.
ALONG_TRACK_VARIANCE = 0.0
# Where the indirect method fails, it starts anew from a mesh so many times finer.
FINER = 4
# Multiple of the least ring speed below which a solution counts as held by it.
SLOW = 1.01
REST = np.zeros(3)
KEY = ["scenario", "cubesat", "solution"]


@dataclass
class Tables:
    """Rows of the tables that a kind of solution fills; `files` makes tables of them."""

    races: list[dict[str, Any]] = field(default_factory=list)
    rings: list[dict[str, Any]] = field(default_factory=list)
    segments: list[dict[str, Any]] = field(default_factory=list)
    trajectories: list[pd.DataFrame] = field(default_factory=list)
    seconds: list[dict[str, Any]] = field(default_factory=list)
    not_converged: list[NotConverged] = field(default_factory=list)

    def files(self, stem: str) -> dict[str, pd.DataFrame]:
        """The tables by file name, the seconds apart."""
        return {
            f"{stem}-races.csv": pd.DataFrame(self.races),
            # Where no race was solved there are no rings, but the table has its columns.
            f"{stem}-rings.csv": pd.DataFrame(self.rings, columns=[*KEY, *RING]),
            f"{stem}-segments.csv": pd.DataFrame(self.segments),
            f"{stem}-seconds.csv": pd.DataFrame(self.seconds),
            f"{stem}-trajectories.parquet": self.trajectory(),
        }

    def trajectory(self) -> pd.DataFrame:
        """All trajectories in one table."""
        if not self.trajectories:
            return pd.DataFrame(columns=[*KEY, "segment", "time_s", *STATE, *THRUST, *COSTATE])
        return pd.concat(self.trajectories, ignore_index=True)


@cache
def program(rings: int, finish: Any, intervals: int) -> CourseProgram:
    """One program for a number of rings, built once."""
    return CourseProgram(rings, finish, intervals)


def whole_leg(course: Course, cubesat: CubeSat) -> Leg:
    """The race of a CubeSat from its place at the start to rest at the end ring."""
    return Leg(cubesat.position, REST, course.centres, course.normals, course.end, REST)


def segment_name(course: Course, k: int) -> str:
    """Name of a segment, as in the captions: ``3 to 4``."""
    return f"{k} to {k + 1 if k < course.rings else 'end'}"


def solve_optima(parameters: Parameters, section: Configuration, scenario: str) -> Tables:
    """Every CubeSat of a scenario by the three well-posed kinds of solution."""
    tables = Tables()
    race = parameters.races[scenario]
    numerics = section.optimum
    for cubesat in race.cubesats:
        key = {"scenario": scenario, "cubesat": cubesat.name}
        for name, finish in ((WHOLE, "state"), (ANYWHERE, "rest anywhere")):
            solver = program(race.course.rings, finish, numerics.intervals)
            leg = whole_leg(race.course, cubesat)
            plan = attempts.solve(solver, leg, cubesat, parameters.mean_motion)
            _add_plan(tables, key | {"solution": name}, plan, parameters, race.course, cubesat)
            tables.seconds.append(key | {"solution": name, "seconds": plan.solution.seconds})
        began = time.perf_counter()
        plans = greedy(race.course, cubesat, parameters.mean_motion, numerics.intervals)
        greedy_seconds = time.perf_counter() - began
        joined = join(plans)
        _add_plan(
            tables, key | {"solution": GREEDY}, joined, parameters, race.course, cubesat, plans
        )
        tables.seconds.append(key | {"solution": GREEDY, "seconds": greedy_seconds})
        if not cubesat.axis_thrust:
            began = time.perf_counter()
            if joined.converged:
                _add_extremals(tables, key, plans, parameters, section, race.course, cubesat)
            else:
                _without_start(tables, key | {"solution": INDIRECT}, race.course)
            seconds = time.perf_counter() - began
            tables.seconds.append(key | {"solution": INDIRECT, "seconds": seconds})
    return tables


def greedy(course: Course, cubesat: CubeSat, mean_motion: float, intervals: int) -> list[Plan]:
    """Each segment in least time by itself, from where the last one ended.

    Ends with the first segment that does not converge, as the next has nowhere to begin.
    """
    state = np.r_[cubesat.position, REST]
    plans = []
    for k in range(course.rings + 1):
        solver, leg = segment_leg(course, k, state, intervals)
        plans.append(attempts.solve(solver, leg, cubesat, mean_motion))
        if not plans[-1].converged:
            break
        state = plans[-1].final
    return plans


def segment_leg(
    course: Course, k: int, state: np.ndarray, intervals: int
) -> tuple[CourseProgram, Leg]:
    """The program and the leg of segment k from a state (6,)."""
    final = k == course.rings
    leg = Leg(
        state[:3],
        state[3:],
        course.centres[k : k + 1],
        course.normals[k : k + 1],
        course.end,
        REST,
    )
    return program(0 if final else 1, "state" if final else "ring", intervals), leg


def join(plans: list[Plan]) -> Plan:
    """Plans flown one after the other as one plan; its status is that of the worst."""
    worst = next((plan for plan in plans if not plan.converged), plans[-1])
    return Plan(
        durations=np.concatenate([plan.durations for plan in plans]),
        starts=np.vstack([plan.starts for plan in plans]),
        controls=np.concatenate([plan.controls for plan in plans]),
        costates=np.vstack([plan.costates for plan in plans]),
        final=plans[-1].final,
        solution=worst.solution,
        tried=worst.tried,
    )


def _add_plan(
    tables: Tables,
    key: dict[str, Any],
    plan: Plan,
    parameters: Parameters,
    course: Course,
    cubesat: CubeSat,
    plans: list[Plan] | None = None,
) -> None:
    """A race in all tables; one that was not solved as missing, and where it was not."""
    if not plan.converged:
        where = "" if plans is None else f", segment {segment_name(course, len(plans) - 1)}"
        last = plan if plans is None else plans[-1]
        tables.not_converged.append(
            attempts.not_converged(case_name(key) + where, last, cubesat, parameters.mean_motion)
        )
        solved = len(plans) - 1 if plans else 0
        _add_missing(tables, key, course, solved, last.solution.status)
        return
    flown = propagate_plan(plan, parameters.mean_motion)
    arrivals = np.cumsum(plan.durations)
    rows = ring_rows(course, flown[:, -1], arrivals, parameters.plane, parameters.pointing)
    failed = [segment_name(course, k) for k, one in enumerate(plans or [plan]) if not one.converged]
    tables.races.append(
        key
        | totals(
            course,
            rows,
            failed,
            minimum_cost(flown[:, 0], course, cubesat.thrust),
            plan.delta_v,
            plan.time,
            plan.solution.iterations,
            residual=residual(plan, flown, cubesat, course),
        )
    )
    tables.rings += [key | row for row in rows]
    tables.segments += [
        key
        | {
            "segment": k,
            "name": segment_name(course, k),
            "duration_s": float(plan.durations[k]),
            "converged": (plans[k] if plans else plan).converged,
            "status": (plans[k] if plans else plan).solution.status,
            **dict(zip(COSTATE, plan.costates[k].tolist(), strict=True)),
        }
        for k in range(course.rings + 1)
    ]
    table = plan_table(plan, parameters.mean_motion)
    for place, (name, value) in enumerate(key.items()):
        table.insert(place, name, value)
    tables.trajectories.append(table)


def case_name(key: dict[str, Any]) -> str:
    """What was to be solved, in the words of `NotConverged`."""
    return ", ".join(key.values())


def _add_missing(
    tables: Tables, key: dict[str, Any], course: Course, solved: int, status: str
) -> None:
    """A race without a solution: no numbers but how many of its segments were not solved."""
    names = [segment_name(course, k) for k in range(solved, course.rings + 1)]
    tables.races.append(key | _unsolved(course, names))
    tables.segments += [
        key
        | {
            "segment": k,
            "name": segment_name(course, k),
            "duration_s": np.nan,
            "converged": False,
            "status": "without the others" if k < solved else status,
            **dict.fromkeys(COSTATE, np.nan),
        }
        for k in range(course.rings + 1)
    ]


def _unsolved(course: Course, names: list[str]) -> dict[str, Any]:
    """What a race without a solution has in its row: which of its segments were not solved."""
    return dict.fromkeys(_TOTALS, np.nan) | {
        "rings": course.rings,
        "segments": course.rings + 1,
        "not_converged": len(names),
        "segments_not_converged": "; ".join(names),
        "residual": np.nan,
        "iterations": 0,
    }


def _without_start(tables: Tables, key: dict[str, Any], course: Course) -> None:
    """The indirect method where the direct one, from whose plans it starts, found none."""
    status = "no direct solution to start from"
    tables.not_converged.append(NotConverged(case_name(key), status, tried="the direct method"))
    _add_missing(tables, key, course, 0, status)


_TOTALS = ["cost", "time_s", "accuracy_m", "minimum_cost_s", "delta_v_m_s", "missed", "off_axis"]


def _add_extremals(
    tables: Tables,
    key: dict[str, Any],
    plans: list[Plan],
    parameters: Parameters,
    section: Configuration,
    course: Course,
    cubesat: CubeSat,
) -> None:
    """The same segments by the indirect method, each from the start of the direct one."""
    key = key | {"solution": INDIRECT}
    rows, failed, total = [], [], 0.0
    ends, starts = [], []
    for k, plan in enumerate(plans):
        found = _extremal(plan, course, k, parameters, section, cubesat)
        intervals = section.optimum.intervals
        if not found.converged:
            intervals *= FINER
            solver, leg = segment_leg(course, k, plan.starts[0], intervals)
            finer = solver.refine(leg, cubesat, parameters.mean_motion, plan)
            if finer.converged:
                found = _extremal(finer, course, k, parameters, section, cubesat)
        if not found.converged:
            failed.append(segment_name(course, k))
            tables.not_converged.append(
                NotConverged(
                    f"{case_name(key)}, segment {failed[-1]}",
                    "no root",
                    found.error,
                    f"from costates of up to {intervals} pieces, with quadratures of "
                    f"{_panels(section)[0]} to {_panels(section)[-1]} panels",
                )
            )
        total += found.duration
        starts.append(plan.starts[0])
        ends.append(found.end)
        rows.append(
            key
            | {
                "segment": k,
                "name": segment_name(course, k),
                "duration_s": found.duration,
                "converged": found.converged,
                "status": "converged" if found.converged else f"error {found.error:.0e}",
                **dict(zip(COSTATE, found.costate.tolist(), strict=True)),
            }
        )
    tables.segments += rows
    if failed:
        tables.races.append(key | _unsolved(course, failed))
        return
    arrivals = np.cumsum([row["duration_s"] for row in rows])
    passed = ring_rows(course, np.array(ends), arrivals, parameters.plane, parameters.pointing)
    tables.rings += [key | row for row in passed]
    tables.races.append(
        key
        | totals(
            course,
            passed,
            failed,
            minimum_cost(np.array(starts), course, cubesat.thrust),
            cubesat.thrust * total,
            total,
            0,
        )
    )


def _panels(section: Configuration) -> list[int]:
    return [section.optimum.indirect_panels * 8**i for i in range(3)]


def _extremal(
    plan: Plan,
    course: Course,
    k: int,
    parameters: Parameters,
    section: Configuration,
    cubesat: CubeSat,
) -> indirect.Extremal:
    """The indirect method from a plan of segment k, with ever finer quadratures."""
    position = course.end if k == course.rings else course.centres[k]
    # Where the direct solution crosses at the least speed allowed, the speed is not free.
    before, speed = (float(np.linalg.norm(state[3:])) for state in (plan.starts[0], plan.final))
    length = length_unit(np.array([plan.starts[0, :3], position]), before, cubesat.thrust)
    slowest = SLOW * LEAST_SPEED * np.sqrt(length * cubesat.thrust)
    goal = indirect.Goal(
        position,
        course.normals[min(k, course.rings - 1)],
        plan.final[3:] if speed < slowest else None,
    )
    for panels in _panels(section):
        found = indirect.solve(
            plan.starts[0],
            goal,
            cubesat.thrust,
            parameters.mean_motion,
            plan.costates[0],
            plan.time,
            panels,
        )
        if found.converged:
            break
    return found


def totals(
    course: Course,
    rows: list[dict[str, Any]],
    failed: list[str],
    least_cost: float,
    delta_v: float,
    time: float,
    iterations: int,
    residual: float = np.nan,
) -> dict[str, Any]:
    """A race in one row; its cost is time and misses."""
    accuracy = sum(row["miss_m"] for row in rows)
    return {
        "cost": time + accuracy,
        "time_s": time,
        "accuracy_m": accuracy,
        "minimum_cost_s": least_cost,
        "delta_v_m_s": delta_v,
        "missed": sum(row["missed"] for row in rows),
        "off_axis": sum(row["off_axis"] for row in rows),
        "rings": course.rings,
        "segments": course.rings + 1,
        "not_converged": len(failed),
        "segments_not_converged": "; ".join(failed),
        "residual": residual,
        "iterations": iterations,
    }
