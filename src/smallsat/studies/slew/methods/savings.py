"""What motion off the eigenaxis and the gravity gradient save of the torque, over the time."""

from dataclasses import replace
from itertools import product
from math import nan

import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import half_mesh
from smallsat.studies.slew.methods.guidance_problem import Guidance, Result
from smallsat.studies.slew.methods.one_axis import eigenaxis_cost
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.methods.plans import guidance_model, slew_of, unsolved
from smallsat.studies.slew.parameters import Parameters

# A start off the eigenaxis: the one on it leads to the turn about it alone.
OFF_AXIS = (0.2, 0.0)


def savings(
    section: Configuration, parameters: Parameters
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Cost of the larger turn by both models, with and without gravity gradient, in longer times.

    Beside it the cheapest turn about the eigenaxis alone, without gradient, by hand. The plans are
    collocated ones; the one without gradient begins where the one with it ended.
    """
    rows, missing = [], []
    turn = parameters.names["half"]
    for (name, carried), duration in product(MODELS.items(), section.beyond.savings_s):
        model = guidance_model(parameters, carried=carried)
        slew = slew_of(model, parameters, "half", half_mesh(section), duration)
        guidance = Guidance(model, slew.stated(), slew.mesh)
        # Every other stage of smoothing, down to the last.
        stages = section.numerics.smoothing[::-2][::-1]
        with_it = guidance.solve(slew.guess(OFF_AXIS), stages)
        free = replace(slew, model=replace(model, parameters=None))
        without = Guidance(free.model, free.stated(), free.mesh).solve(
            with_it.solution.variables, stages[-1:]
        )
        case = f"savings, {turn} in {duration:g} s, {name}"
        missing += unsolved(case, with_it, "one start off the eigenaxis")
        missing += unsolved(f"{case}, no gradient", without, "from the plan with gradient")
        rows.append(
            {
                "model": name,
                "duration_s": duration,
                "eigenaxis_cost_N_m_s": eigenaxis_cost(parameters, "half", duration),
                "cost_without_gradient_N_m_s": _cost(without),
                "cost_N_m_s": _cost(with_it),
            }
        )
    table = pd.DataFrame(rows)
    alone, without_it, best = (table[column] for column in table.columns[2:])
    table["saved_off_axis_pct"] = 100.0 * (1.0 - without_it / alone)
    table["saved_by_gradient_pct"] = 100.0 * (1.0 - best / without_it)
    return table, missing


def _cost(result: Result) -> float:
    return result.cost if result.solution.converged else nan
