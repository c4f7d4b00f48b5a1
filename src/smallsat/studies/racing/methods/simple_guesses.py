"""Whether the indirect method converges from costates that need no solve."""

from typing import Any

import numpy as np
import pandas as pd

from smallsat.dynamics.orbits.clohessy_wiltshire import costate_transition
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.methods import indirect
from smallsat.studies.racing.methods.flight import least_time
from smallsat.studies.racing.methods.listing import guess
from smallsat.studies.racing.methods.listing_races import targets
from smallsat.studies.racing.methods.races import greedy, segment_name
from smallsat.studies.racing.parameters import Parameters

DIRECT, DIRECTIONS, PREVIOUS = "direct method", "directions", "previous segment"


def simple_guesses(
    parameters: Parameters, section: Configuration, scenario: str, name: str
) -> pd.DataFrame:
    """Convergence by segment and guess, each from the start of the direct plan's segment.

    The guesses: the direct method's costates and duration; the listing's directions and duration;
    the costates at the end of the segment before with the time along a straight line (Section V).
    """
    race = parameters.races[scenario]
    cubesat = next(one for one in race.cubesats if one.name == name)
    plans = greedy(race.course, cubesat, parameters.mean_motion, section.optimum.intervals)
    rows: list[dict[str, Any]] = []
    for k, (plan, target) in enumerate(zip(plans, targets(race.course), strict=False)):
        if not plan.converged:
            break
        state = plan.starts[0]
        directions, _ = guess(state, 0.0, target, cubesat.thrust, parameters.listing)
        guesses = {DIRECT: np.r_[plan.costates[0], plan.time], DIRECTIONS: directions}
        if k > 0:
            before = plans[k - 1]
            last = costate_transition(parameters.mean_motion, before.time) @ before.costates[0]
            gap = float(np.linalg.norm(target.centre - state[:3]))
            straight = least_time(gap, float(np.linalg.norm(state[3:])), cubesat.thrust)
            guesses[PREVIOUS] = np.r_[last, straight]
        goal = indirect.Goal(target.centre, target.normal, np.zeros(3) if target.final else None)
        for kind, unknowns in guesses.items():
            found = indirect.solve(
                state, goal, cubesat.thrust, parameters.mean_motion, unknowns[:6],
                float(unknowns[6]), section.optimum.indirect_panels,
            )  # fmt: skip
            primer, right = unknowns[3:6], plan.costates[0, 3:]
            rows.append(
                {
                    "scenario": scenario,
                    "cubesat": name,
                    "segment": segment_name(race.course, k),
                    "guess": kind,
                    "converged": found.converged,
                    "size_against_right": float(np.linalg.norm(primer) / np.linalg.norm(right)),
                    "angle_to_right_deg": float(
                        np.degrees(
                            np.arctan2(np.linalg.norm(np.cross(primer, right)), primer @ right)
                        )
                    ),
                }
            )
    return pd.DataFrame(rows)
