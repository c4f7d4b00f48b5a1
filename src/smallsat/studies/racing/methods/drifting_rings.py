"""Races through rings that drift, which the document rules out as a simplification (Section I).

Every ring and the end move freely from their printed places on; a ring keeps its direction in the
Hill frame. A CubeSat crosses at the moving centre with a velocity along the normal relative to the
ring, and ends at rest relative to the end ring. Two readings say how the rings begin.
"""

from typing import Any

import casadi as ca
import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import transition_rows
from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.course_program import CourseProgram, Symbols
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.methods.races import WHOLE, whole_leg
from smallsat.studies.racing.methods.weighted_misses import racers
from smallsat.studies.racing.parameters import SCENARIOS, Parameters

# Along-track velocity at the beginning over mean motion times radial place: let go at rest, which
# is the document's first rule without its simplification, or on the orbit of the same period that
# begins at the place and comes back to it.
READINGS = {"let go at rest": 0.0, "natural orbits": -2.0}
NUMBERS = ("time_s", "longer_pct", "mean_drift_m", "largest_drift_m", "residual")


class DriftingProgram(CourseProgram):
    """The program whose rings and end move freely; ``ratio`` is a value of `READINGS`."""

    own_variables = 1

    def __init__(self, rings: int, intervals: int, ratio: float):
        super().__init__(rings, "state", intervals)
        self.ratio = ratio

    def nodes(self, of: Symbols) -> list[Any]:
        """States at the rings and the end, where these are when the CubeSat comes."""
        n = of.mean_motion
        arrivals = ca.horzcat(of.own, self._before(of)[-1] + of.times[-1])
        places = ca.horzcat(of.centres, of.end[:3])
        speeds = ca.horzcat(of.normals * ca.repmat(of.speeds.T, 3, 1), of.end[3:])
        found = []
        for k in range(self.segments):
            released = ca.vertcat(places[:, k], 0, self.ratio * n * places[0, k], 0)
            free = ca.vertcat(*(ca.horzcat(*row) for row in transition_rows(n, arrivals[k], ca)))
            found.append(free @ released + ca.vertcat(ca.MX.zeros(3), speeds[:, k]))
        return found

    def own_guess(self, durations: np.ndarray, offsets: np.ndarray) -> np.ndarray:
        """The times of arrival (l, 1): as variables they keep the program sparse."""
        return np.cumsum(durations)[: self.rings, None]

    def restrictions(self, of: Symbols) -> Any:
        """What the times of arrival are off the sums of the durations."""
        return of.own.T - self._before(of).T[: self.rings] - of.times[: self.rings]

    def _before(self, of: Symbols) -> Any:
        """The time (1, l + 1) at the start of each segment."""
        return ca.horzcat(0.0, of.own)


def drifting_races(
    parameters: Parameters, section: Configuration, fixed: pd.DataFrame
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Least times by both readings, beside those with fixed rings.

    Parameters
    ----------
    parameters, section
        Of the study.
    fixed
        Table of the races with fixed rings.

    Returns
    -------
    table, missing
        A row a scenario, CubeSat and reading: time, s, and what it is above that with fixed rings,
        %; how far rings and end are from their printed places when they are reached, m, in the mean
        and at most. And the cases without a solution.
    """
    rows: list[dict[str, Any]] = []
    missing = []
    times = fixed[fixed["solution"] == WHOLE].set_index(["scenario", "cubesat"])["time_s"]
    programs = {
        (scenario, reading): DriftingProgram(
            parameters.races[scenario].course.rings, section.optimum.intervals, ratio
        )
        for scenario in SCENARIOS
        for reading, ratio in READINGS.items()
    }
    for scenario, cubesat in racers(parameters):
        course = parameters.races[scenario].course
        leg, places = whole_leg(course, cubesat), np.vstack([course.centres, course.end])
        for reading in READINGS:
            plan = attempts.solve(programs[scenario, reading], leg, cubesat, parameters.mean_motion)
            row = {"scenario": scenario, "cubesat": cubesat.name, "rings": reading}
            if not plan.converged:
                case = f"{scenario}, {cubesat.name}, rings {reading}"
                missing.append(attempts.not_converged(case, plan, cubesat, parameters.mean_motion))
                rows.append(row | dict.fromkeys(NUMBERS, np.nan))
                continue
            moved = np.linalg.norm(plan.ends[:, :3] - places, axis=1)
            flown = propagate_plan(plan, parameters.mean_motion)
            values = (
                plan.time,
                100.0 * (plan.time / times[scenario, cubesat.name] - 1.0),
                moved.mean(),
                moved.max(),
                residual(plan, flown, cubesat, None),
            )
            rows.append(row | dict(zip(NUMBERS, map(float, values), strict=True)))
    return pd.DataFrame(rows), missing
