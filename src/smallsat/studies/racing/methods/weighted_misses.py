"""Races whose misses are penalised by a weight, as the document's cost does (Eq. 6).

A ring may be missed within its plane: where the path meets that plane is the crossing. The cost is
the time plus a weight times the sum of all misses. What a first metre off a centre saves at most is
the multiplier of the race through the centres: as long as the weight exceeds it at every ring, that
race is a local optimum of the penalised one, with no miss.
"""

from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import costate_transition
from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.course_program import CourseProgram, Plan, Symbols
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.methods.races import program, whole_leg
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import SCENARIOS, Parameters

# The length of a miss is sqrt(d^2 + s^2) - s with this s, scaled: a length has no slope at zero.
SMOOTHING = 1e-4
KEYS = ("scenario", "cubesat", "weight_s_m", "threshold_share", "centred_s")
NUMBERS = ("time_s", "cost_s", "misses_m", "largest_miss_m", "missed", "residual")


class WeightedProgram(CourseProgram):
    """The program whose rings may be missed within their planes, for the leg's weight."""

    own_variables = 3

    def nodes(self, of: Symbols) -> list[Any]:
        """States at the rings, off their centres, and at a finish that is given."""
        moved = ca.vertcat(of.own, ca.MX.zeros(3, self.rings))
        centred = super().nodes(of)
        rings = [centred[k] + moved[:, k] for k in range(self.rings)]
        return [*rings, *centred[self.rings :]]

    def cost(self, of: Symbols) -> Any:
        """The time, and the weight times all misses."""
        misses = ca.sqrt(ca.sum1(of.own**2) + SMOOTHING**2) - SMOOTHING
        return super().cost(of) + of.weight * ca.sum2(misses)

    def own_guess(self, durations: np.ndarray, offsets: np.ndarray) -> np.ndarray:
        """The offsets (l, 3) themselves."""
        return offsets

    def restrictions(self, of: Symbols) -> Any:
        """Parts of the offsets out of the rings' planes."""
        return ca.sum1(of.own * of.normals).T


def misses(plan: Plan, course: Course) -> np.ndarray:
    """Distances (l,) from the rings' centres, m."""
    return np.linalg.norm(plan.ends[: course.rings, :3] - course.centres, axis=1)


def ring_multipliers(plan: Plan, course: Course, mean_motion: float) -> np.ndarray:
    """What a first metre off each ring's centre within its plane saves (l,), s/m."""
    jumps = np.array(
        [
            plan.costates[k + 1, :3]
            - (costate_transition(mean_motion, plan.durations[k]) @ plan.costates[k])[:3]
            for k in range(course.rings)
        ]
    )
    along = np.sum(jumps * course.normals, axis=1, keepdims=True)
    return np.linalg.norm(jumps - along * course.normals, axis=1)


def multiplier_table(parameters: Parameters, section: Configuration) -> pd.DataFrame:
    """By scenario, CubeSat and ring: what a first metre of miss saves, s/m, of solved races."""
    rows = []
    for scenario, cubesat in racers(parameters):
        plan = centred_plan(parameters, section, scenario, cubesat)
        if plan.converged:
            course = parameters.races[scenario].course
            saved = ring_multipliers(plan, course, parameters.mean_motion)
            key = {"scenario": scenario, "cubesat": cubesat.name}
            rows += [key | {"ring": k + 1, "multiplier_s_m": m} for k, m in enumerate(saved)]
    return pd.DataFrame(rows, columns=["scenario", "cubesat", "ring", "multiplier_s_m"])


def racers(parameters: Parameters) -> list[tuple[str, CubeSat]]:
    """Those of Scenario 1 and the first of Scenario 2, whose four differ by their places alone."""
    first, second = (parameters.races[scenario].cubesats for scenario in SCENARIOS)
    return [*((SCENARIOS[0], cubesat) for cubesat in first), (SCENARIOS[1], second[0])]


def centred_plan(
    parameters: Parameters, section: Configuration, scenario: str, cubesat: CubeSat
) -> Plan:
    """The whole-course optimum through all centres."""
    course = parameters.races[scenario].course
    solver = program(course.rings, "state", section.optimum.intervals)
    return attempts.solve(solver, whole_leg(course, cubesat), cubesat, parameters.mean_motion)


def weight_sweep(
    parameters: Parameters, section: Configuration
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """One CubeSat's best penalised flight by weight, and the cases without one.

    From the race through the centres the weight falls, and then grows again up to the document's:
    a flight that leaves a ring may be a local optimum beside that through its centre. The better of
    both ways counts.
    """
    numbers = section.miss_weights
    rows, missing = [], []
    for scenario in SCENARIOS:
        race = parameters.races[scenario]
        course = race.course
        cubesat = next(c for c in race.cubesats if c.name == numbers.cubesat)
        centred = centred_plan(parameters, section, scenario, cubesat)
        if not centred.converged:
            case = f"{scenario}, {cubesat.name}, weights of misses"
            missing.append(attempts.not_converged(case, centred, cubesat, parameters.mean_motion))
            continue
        threshold = float(ring_multipliers(centred, course, parameters.mean_motion).max())
        falling = [threshold * share for share in sorted(numbers.threshold_shares, reverse=True)]
        leg, solver = (
            whole_leg(course, cubesat),
            WeightedProgram(course.rings, "state", section.optimum.intervals),
        )
        found: dict[float, list[Plan]] = {}
        plan = centred
        for weight in [*falling, *falling[-2::-1], leg.weight]:
            trial = solver.refine(
                replace(leg, weight=weight), cubesat, parameters.mean_motion, plan
            )
            plan = trial if trial.converged else plan
            found.setdefault(weight, []).append(trial)
        for weight, trials in found.items():
            row = {
                "scenario": scenario,
                "cubesat": cubesat.name,
                "weight_s_m": weight,
                "threshold_share": weight / threshold,
                "centred_s": centred.time,
            }
            solved = [trial for trial in trials if trial.converged]
            if not solved:
                case = f"{scenario}, {cubesat.name}, a miss at {weight:.3g} s/m"
                last = replace(trials[-1], tried=("the flight of the weight before",))
                missing.append(attempts.not_converged(case, last, cubesat, parameters.mean_motion))
                rows.append(row | dict.fromkeys(NUMBERS, np.nan))
                continue
            costs = [one.time + weight * misses(one, course).sum() for one in solved]
            best = solved[int(np.argmin(costs))]
            missed = misses(best, course)
            flown = propagate_plan(best, parameters.mean_motion)
            values = (
                best.time,
                min(costs),
                missed.sum(),
                missed.max(),
                (missed > course.sizes).sum(),
                residual(best, flown, cubesat, None),
            )
            rows.append(row | dict(zip(NUMBERS, map(float, values), strict=True)))
    table = pd.DataFrame(rows, columns=[*KEYS, *NUMBERS])
    return table.sort_values(["scenario", "weight_s_m"], ignore_index=True), missing
