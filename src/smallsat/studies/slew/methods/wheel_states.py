"""The larger turn with a wheel that failed, and with momentum that a wheel holds at the start."""

from dataclasses import replace

import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import half_mesh
from smallsat.studies.slew.methods.guidance_problem import Guidance, problem, tilts, turning_guess
from smallsat.studies.slew.methods.minimum_time import guess
from smallsat.studies.slew.methods.plans import AXES, guidance_model, unsolved
from smallsat.studies.slew.parameters import Parameters

# The starts to all four sides of the eigenaxis; the first of all is the one on it.
STARTS = slice(1, 5)
# The least time lies within these parts of the healthy wheels' guess.
WINDOW = (0.5, 4.0)
HEALTHY = "all wheels, at rest"


def wheel_states(
    section: Configuration, parameters: Parameters
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Least time of the larger turn, s, by collocation, for each state of the wheels.

    The model is the one in which the wheels carry their momentum. At the end the wheels hold what
    the turned body leaves them.
    """
    share = section.beyond.stored_momentum_pct / 100.0
    states: dict[str, dict] = {HEALTHY: {}}
    for i, axis in enumerate(AXES):
        states[f"wheel {axis} failed"] = {"working": tuple(float(j != i) for j in range(3))}
    for i, axis in enumerate(AXES):
        name = f"{section.beyond.stored_momentum_pct:g} % in wheel {axis}"
        states[name] = {"stored": tuple(share * float(j == i) for j in range(3))}
    initial, target = parameters.initial, parameters.targets["half"]
    about = guess(parameters, "half")
    rows, missing = [], []
    for name, changes in states.items():
        model = replace(guidance_model(parameters), **changes)
        window = (WINDOW[0] * about, WINDOW[1] * about)
        stated = problem(model, initial, target, window, least_time=True)
        guidance = Guidance(model, stated, half_mesh(section))
        results = [
            guidance.solve(turning_guess(model, initial, target, about, tilt), [1.0])
            for tilt in tilts(STARTS.stop, section.numerics.seed)[STARTS]
        ]
        converged = [r for r in results if r.solution.converged]
        best = min(converged or results, key=lambda r: r.duration)
        missing += unsolved(f"least time, {name}", best, f"{len(results)} starts")
        rows.append(
            {
                "wheels": name,
                "converged": best.solution.converged,
                "least_time_s": best.duration if converged else float("nan"),
            }
        )
    return pd.DataFrame(rows), missing
