"""The document's two turns in its time: plans of least torque, or else least infeasible ones."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import nan

import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.optimal_control.nonlinear_program import Solution
from smallsat.studies.slew.configuration import Configuration, Numerics
from smallsat.studies.slew.methods.bound import impossible
from smallsat.studies.slew.methods.guidance_problem import Model, Result
from smallsat.studies.slew.methods.plan_names import (
    EULER,
    MODELS,
    ONE_SEGMENT,
    SEGMENTS,
    WHEELS,
    plan_names,
)
from smallsat.studies.slew.methods.plans import (
    AXES,
    SWEEP_STARTS,
    HeldPlan,
    Slew,
    asked_once,
    best_plan,
    guidance_model,
    held_if_converged,
    held_table,
    least_infeasible,
    node_table,
    slew_of,
    summary,
    unsolved,
)
from smallsat.studies.slew.parameters import Parameters

INFEASIBLE = ("model", "mesh", "hard_status", "hard_converged", "soft_status", "miss")
START_COLUMNS = ("start", "converged", "status", "cost_N_m_s", "plan")
NODE_COLUMNS = (
    "plan",
    "time_s",
    "node",
    *(f"q_{i}" for i in range(1, 5)),
    *(f"{name}_{axis}" for axis in AXES for name in ("omega", "h", "u")),
    "hamiltonian",
)


@dataclass(frozen=True)
class Turn:
    """What is kept of a turn by one model on one mesh.

    Attributes
    ----------
    model
        Its name, a key of `MODELS`.
    row
        Its summary, a row of ``plans.csv``.
    seconds
        Seconds that the chosen solve took.
    timed
        Whether they are compared with printed ones.
    starts
        One row a start, if the plan is of least torque in the document's model.
    nodes
        The plan at its points, to be flown; none where nothing converged.
    held
        The plan with a held control, as flown anew.
    infeasible
        What the solver says of the turn as it stands, where that is in question.
    missing
        What did not converge.
    """

    model: str
    row: dict
    seconds: float
    timed: bool = True
    starts: pd.DataFrame | None = None
    nodes: pd.DataFrame | None = None
    held: pd.DataFrame | None = None
    infeasible: dict | None = None
    missing: list[NotConverged] = field(default_factory=list)


def meshes(section: Configuration, case: str) -> dict[str, Mesh]:
    """The document's mesh of a turn, one segment, and ours, several."""
    entry = section.manoeuvre[case]
    return {
        ONE_SEGMENT: Mesh(1, entry.nodes),
        SEGMENTS: Mesh(entry.segments, entry.segment_nodes),
    }


def turn_plans(parameters: Parameters, case: str, section: Configuration) -> Iterator[Turn]:
    """The plan of a turn in the document's time on each mesh, with the wheels' momentum."""
    model, numerics = guidance_model(parameters), section.numerics
    beyond_reach = impossible(parameters, case, parameters.duration)
    for kind, mesh in meshes(section, case).items():
        slew = slew_of(model, parameters, case, mesh)
        feasible, least = plan_names(parameters, case, kind)
        if not beyond_reach:
            result, starts = best_plan(slew, numerics, numerics.starts)
            if result.solution.converged:
                turn = _least_torque(slew, feasible, kind, result, starts, numerics)
                # Whether the larger turn is possible is the document's own question.
                yield replace(turn, infeasible=_reached(WHEELS, kind, result, case))
                continue
        turn, refused = _least_infeasible(slew, WHEELS, least, kind, numerics)
        if case == "quarter":
            turn = replace(turn, infeasible=None)
        if case == "quarter" or not beyond_reach:
            why = "no plan can exist in this time, by the bound"
            unmet = NotConverged(
                feasible,
                f"{refused.status}: {why if beyond_reach else 'no start converged'}",
                refused.violation,
                "then with a free end, for the least miss",
            )
            turn = replace(turn, missing=[unmet, *turn.missing])
        yield turn


def euler_plan(parameters: Parameters, section: Configuration) -> Turn:
    """The larger turn on the document's mesh by Euler's equation alone.

    Of least torque where the solver reaches the end, or else the least infeasible one.
    """
    model, numerics = guidance_model(parameters, carried=MODELS[EULER]), section.numerics
    slew = slew_of(model, parameters, "half", meshes(section, "half")[ONE_SEGMENT])
    feasible, least = plan_names(parameters, "half", ONE_SEGMENT, EULER)
    turn, stated = _least_infeasible(slew, EULER, least, ONE_SEGMENT, numerics)
    if not stated.converged:
        return turn
    result, starts = best_plan(slew, numerics, SWEEP_STARTS)
    turn = _least_torque(slew, feasible, ONE_SEGMENT, result, starts, numerics)
    missing = turn.missing + unsolved(feasible, result, f"{len(starts)} starts")
    answer = _reached(EULER, ONE_SEGMENT, result, "half")
    return replace(turn, model=EULER, timed=False, missing=missing, infeasible=answer)


def free_plans(parameters: Parameters, section: Configuration) -> Iterator[Turn]:
    """The smaller turn without the gravity gradient, which has a solution by hand."""
    if impossible(parameters, "quarter", parameters.duration, gradient=False):
        return
    free = Model(
        parameters.inertia, parameters.torque, parameters.momentum, parameters.duration, True, None
    )
    for kind, mesh in meshes(section, "quarter").items():
        name = f"{parameters.names['quarter']}, no gravity gradient, {kind}"
        slew = slew_of(free, parameters, "quarter", mesh)
        result, starts = best_plan(slew, section.numerics, SWEEP_STARTS)
        turn = _least_torque(slew, name, kind, result, starts, section.numerics)
        missing = turn.missing + unsolved(name, result, f"{len(starts)} starts")
        yield Turn(WHEELS, turn.row, turn.seconds, timed=False, missing=missing)


def _reached(model: str, kind: str, result: Result, case: str) -> dict | None:
    """A row of ``infeasible.csv`` for a turn that the solver makes."""
    if case == "quarter":
        return None
    answer = (model, kind, result.solution.status, result.solution.converged, "", nan)
    return dict(zip(INFEASIBLE, answer, strict=True))


def _least_torque(
    slew: Slew,
    name: str,
    kind: str,
    result: Result,
    starts: pd.DataFrame,
    numerics: Numerics,
) -> Turn:
    """A plan of least torque; on our mesh with a held control too."""
    held: HeldPlan | None = None
    missing: list[NotConverged] = []
    if kind == SEGMENTS:
        held, missing = held_if_converged(slew, name, result, numerics)
    return Turn(
        model=WHEELS,
        row=summary(slew.model, name, result, starts, held),
        seconds=result.seconds,
        starts=starts.assign(plan=name),
        nodes=node_table(slew.model, result, name),
        held=held_table(slew.model, held, name) if held and held.solution.converged else None,
        missing=missing,
    )


def _least_infeasible(
    slew: Slew, model: str, name: str, kind: str, numerics: Numerics
) -> tuple[Turn, Solution]:
    """The plan that misses its end least, and the solve of the turn as it stands."""
    refused = asked_once(slew)
    (result,) = least_infeasible(slew, numerics)
    met = (model, kind, refused.status, refused.converged, result.solution.status)
    turn = Turn(
        model=model,
        row=summary(slew.model, name, result, pd.DataFrame({"converged": [True]}), None),
        seconds=result.seconds,
        timed=model == WHEELS,
        nodes=node_table(slew.model, result, name) if result.solution.converged else None,
        infeasible=dict(zip(INFEASIBLE, (*met, result.solution.objective), strict=True)),
        missing=unsolved(name, result, "free end, starts on and off the eigenaxis"),
    )
    return turn, refused
