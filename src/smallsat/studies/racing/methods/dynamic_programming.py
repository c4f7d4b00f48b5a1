"""Least time over the ring speeds, the only free part of a state at a ring, by Bellman's recursion.

A table of least times from speed to speed for every segment, first on a grid of speeds, then on
ever finer ones around the best path. Each entry is a solve of one segment with both ends fixed, on
the mesh of the whole-course program, which it must agree with.
"""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods.checks import Checked
from smallsat.studies.racing.methods.course_program import Leg, Plan, length_unit
from smallsat.studies.racing.methods.races import REST, program
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

# How often the range of speeds is doubled, and what counts as its end, in spacings of its grid.
# Below the range the refinements go by themselves.
WIDENED, END = 3, 1e-6


def dynamic_programming(parameters: Parameters, section: Configuration, scenario: str) -> Checked:
    """A row a level of refinement, and the CubeSat's race where no path was found.

    The grid's range goes with the thrust and the size of the course; where the best path touches
    its end, it is doubled.
    """
    numbers, race = section.dynamic_programming, parameters.races[scenario]
    cubesat = next(c for c in race.cubesats if c.name == numbers.cubesat)
    course = race.course
    length = length_unit(np.vstack([cubesat.position, course.centres, course.end]))
    unit = float(np.sqrt(length * cubesat.thrust))
    grid = unit * np.linspace(numbers.least_speed, numbers.largest_speed, numbers.speeds)
    segments = _Segments(course, cubesat, parameters.mean_motion, section.optimum.intervals)
    for _ in range(1 + WIDENED):
        levels, fastest = _refined(segments, grid, numbers.refinements)
        if not fastest:
            break
        grid = np.linspace(grid[0], 2.0 * grid[-1], len(grid))
    rows = [{"scenario": scenario, "cubesat": cubesat.name} | level for level in levels]
    missing = []
    if np.isnan(levels[-1]["time_s"]):
        missing.append(
            NotConverged(
                f"{scenario}, {cubesat.name}, dynamic programming",
                "no path of solved segments",
                tried=f"{len(grid)} speeds from {grid[0]:.3g} to {grid[-1]:.3g} m/s at each ring",
            )
        )
    return pd.DataFrame(rows), missing


class _Segments:
    """Plans of a course's segments from speed to speed, each solved once."""

    def __init__(self, course: Course, cubesat: CubeSat, mean_motion: float, intervals: int):
        self.course, self._cubesat, self._mean_motion = course, cubesat, mean_motion
        self._solver = program(0, "state", intervals)
        self._known: dict[tuple[int, float, float], Plan] = {}

    @property
    def solved(self) -> int:
        """How many solves there were."""
        return len(self._known)

    def plan(self, k: int, before: float, after: float, near: Plan | None) -> Plan:
        """Plan of segment k between given speeds, m/s, from one between other speeds, if any.

        A segment that is flown fast has several local optima. So one that differs little from a
        plan begins from it, and from smooth arcs only where that leads nowhere.
        """
        key = (k, round(before, 9), round(after, 9))
        if key not in self._known:
            course, final = self.course, k == self.course.rings
            leg = Leg(
                self._cubesat.position if k == 0 else course.centres[k - 1],
                REST if k == 0 else before * course.normals[k - 1],
                course.centres[:0],
                course.normals[:0],
                course.end if final else course.centres[k],
                REST if final else after * course.normals[k],
            )
            found = self._solver.solve(leg, self._cubesat, self._mean_motion, guess=near)
            if near is not None and not found.converged:
                found = self._solver.solve(leg, self._cubesat, self._mean_motion)
            self._known[key] = found
        return self._known[key]


def _refined(
    segments: _Segments, grid: np.ndarray, refinements: int
) -> tuple[list[dict[str, Any]], bool]:
    """Least times on a grid of speeds and on ever finer ones, one a level.

    Also whether the best path goes as fast as all of them let it: then the range was too small.
    """
    rings = segments.course.rings
    spacing = float(grid[1] - grid[0])
    least, reach = float(grid[0]) / 100.0, float(grid[-1])
    choices = [grid] * rings
    best: list[Plan | None] = [None] * (rings + 1)
    levels: list[dict[str, Any]] = []
    for level in range(refinements + 1):
        total, path = _best_path(segments, choices, best)
        levels.append(
            {
                "level": level,
                "spacing_m_s": spacing,
                "segments_solved": segments.solved,
                "time_s": total if np.isfinite(total) else np.nan,
            }
        )
        if not np.isfinite(total):
            return levels, False
        at_the_end = max(path) > reach - END * spacing
        ends = zip([0.0, *path], [*path, 0.0], best, strict=True)
        best = [segments.plan(k, v, w, near) for k, (v, w, near) in enumerate(ends)]
        spacing /= 2.0
        reach += spacing
        choices = [np.maximum([s - spacing, s, s + spacing], least) for s in path]
    return levels, at_the_end


def _best_path(
    segments: _Segments, choices: list[np.ndarray], near: list[Plan | None]
) -> tuple[float, list[float]]:
    """Least time and its ring speeds, from the finish back to the start."""
    rings = segments.course.rings
    ends = [*choices, np.zeros(1)]
    starts = [np.zeros(1), *choices]
    values, decisions = np.zeros(1), []
    for k in reversed(range(rings + 1)):
        plans = [[segments.plan(k, v, w, near[k]) for w in ends[k]] for v in starts[k]]
        times = [[plan.time if plan.converged else np.inf for plan in row] for row in plans]
        totals = np.array(times) + values
        decisions.append(totals.argmin(axis=1))
        values = totals.min(axis=1)
    path, place = [], 0
    for k, decision in enumerate(reversed(decisions)):
        place = int(decision[place])
        if k < rings:
            path.append(float(ends[k][place]))
    return float(values[0]), path
