"""The document's two minimum-torque plans, flown in the fuller model."""

import time

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import not_converged_table
from smallsat.step import Step, Tables
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.attitude_steps import compared_steps
from smallsat.studies.slew.methods.flights import replay
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.methods.plans import HELD_COLUMNS, joined, resampled
from smallsat.studies.slew.methods.turns import (
    INFEASIBLE,
    NODE_COLUMNS,
    START_COLUMNS,
    euler_plan,
    free_plans,
    turn_plans,
)
from smallsat.studies.slew.model.onboard import third_order, transition_errors
from smallsat.studies.slew.model.simulation import COLUMNS
from smallsat.studies.slew.parameters import Parameters

REPETITIONS = 10


def run(step: Step[Configuration]) -> Tables:
    """Plan both turns, and simulate what the plans do."""
    section, parameters = step.section, Parameters.from_section(step.section)
    turns = [
        *turn_plans(parameters, "quarter", section),
        *free_plans(parameters, section),
        *turn_plans(parameters, "half", section),
        euler_plan(parameters, section),
    ]
    infeasible = [turn.infeasible for turn in turns if turn.infeasible]
    starts = [turn.starts for turn in turns if turn.starts is not None]
    nodes = [turn.nodes for turn in turns if turn.nodes is not None]
    helds = [turn.held for turn in turns if turn.held is not None]
    replays = {
        str(turn.nodes["plan"].iloc[0]): replay(
            parameters,
            section,
            resampled(turn.nodes, section.resampling_hz),
            parameters.duration,
            carried=MODELS[turn.model],
        )
        for turn in turns
        if turn.nodes is not None
    }
    flights = [flown.assign(flight=name) for name, flown in replays.items()]
    chosen = {name: flown for name, flown in replays.items() if name.endswith(", segments")}
    seconds = [{"plan": turn.row["plan"], "seconds": turn.seconds} for turn in turns if turn.timed]
    seconds.append(
        {"plan": "on-board propagator", "seconds": _propagator_seconds(section, parameters)}
    )
    return {
        "plans.csv": pd.DataFrame([turn.row for turn in turns]),
        "infeasible.csv": pd.DataFrame(infeasible, columns=list(INFEASIBLE)),
        "plan-starts.csv": joined(starts, START_COLUMNS),
        "plan-nodes.parquet": joined(nodes, NODE_COLUMNS),
        "held-plans.parquet": joined(helds, HELD_COLUMNS),
        "replays.parquet": joined(flights, (*COLUMNS, "flight")),
        "propagator.csv": transition_errors(chosen),
        "attitude-steps.csv": compared_steps(chosen, section.onboard.step_s),
        "plan-seconds.csv": pd.DataFrame(seconds),
        "plans-not-converged.csv": not_converged_table(
            row for turn in turns for row in turn.missing
        ),
    }


def _propagator_seconds(section: Configuration, parameters: Parameters) -> float:
    """Seconds of the on-board propagation of the orbit, compiled, as the mean of several runs."""
    step = section.onboard.step_s
    steps = round(parameters.duration / step)
    start = np.concatenate(parameters.state)
    third_order(start, *parameters.gravity, steps, step)
    began = time.perf_counter()
    for _ in range(REPETITIONS):
        third_order(start, *parameters.gravity, steps, step)
    return (time.perf_counter() - began) / REPETITIONS
