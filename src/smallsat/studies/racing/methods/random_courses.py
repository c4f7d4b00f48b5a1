"""Optimal races on random courses: where the published race lies among them."""

import time
from collections.abc import Iterable

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import attempts
from smallsat.studies.racing.methods.races import program, whole_leg
from smallsat.studies.racing.model.course import generate
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

# How the steps of both angles are drawn.
RULES = {"generator": True, "text": False}


def solve_random(
    parameters: Parameters, section: Configuration, courses: Iterable[int], rings: int
) -> tuple[pd.DataFrame, pd.DataFrame, list[NotConverged]]:
    """Some of the random courses, by number: results, seconds, courses not solved.

    Each course has a random stream of its own, so that it depends on its number alone. It is drawn
    twice: with the generator's halved ranges of angles, and with the text's whole ones.
    """
    numbers = section.random_courses
    streams = np.random.SeedSequence(numbers.seed).spawn(numbers.courses)
    solver = program(rings, "state", section.optimum.intervals)
    rows, seconds, missing = [], [], []
    for number in courses:
        for rule, halved in RULES.items():
            draws = np.random.default_rng(streams[number])
            course = generate(draws, parameters.ranges, rings, halved)
            offset = parameters.scatter * np.array([1.0, 0.0, 1.0]) * draws.standard_normal(3)
            cubesat = CubeSat("any", numbers.thrust_m_s2, (), course.start + offset)
            began = time.perf_counter()
            plan = attempts.solve(
                solver, whole_leg(course, cubesat), cubesat, parameters.mean_motion
            )
            seconds.append({"number": number, "rule": rule, "seconds": time.perf_counter() - began})
            if not plan.converged:
                case = f"random course {number} by the rules of the {rule}"
                missing.append(attempts.not_converged(case, plan, cubesat, parameters.mean_motion))
            rows.append(
                {
                    "number": number,
                    "rule": rule,
                    "time_s": plan.time if plan.converged else np.nan,
                    "converged": plan.converged,
                    "status": plan.solution.status,
                    "path_m": float(
                        np.linalg.norm(
                            np.diff(np.vstack([course.start, course.centres, course.end]), axis=0),
                            axis=1,
                        ).sum()
                    ),
                    "sizes_m": float(course.sizes.sum()),
                }
            )
    return pd.DataFrame(rows), pd.DataFrame(seconds), missing
