"""The document's two turns in its time: plans of least torque, or else least infeasible ones."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import nan

import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.configuration import Configuration, Numerics
from smallsat.studies.slew.methods.bound import impossible, plan_names
from smallsat.studies.slew.methods.guidance_problem import Model, Result
from smallsat.studies.slew.methods.plans import (
    AXES,
    SWEEP_STARTS,
    HeldPlan,
    best_plan,
    held_if_converged,
    held_table,
    least_infeasible,
    node_table,
    summary,
    unsolved,
)
from smallsat.studies.slew.parameters import Parameters

INFEASIBLE = ("mesh", "hard_status", "hard_converged", "soft_status", "miss")
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
    """What is kept of a turn on one mesh.

    Attributes
    ----------
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
        "one segment": Mesh(1, entry.nodes),
        "segments": Mesh(entry.segments, entry.segment_nodes),
    }


def turn_plans(
    model: Model, parameters: Parameters, case: str, section: Configuration
) -> Iterator[Turn]:
    """The plan of a turn in the document's time on each mesh."""
    beyond_reach = impossible(parameters, case, parameters.duration)
    for kind, mesh in meshes(section, case).items():
        if beyond_reach:
            yield _least_infeasible(
                model, parameters, case, kind, mesh, section.numerics, proven=True
            )
            continue
        result, starts = best_plan(
            model,
            parameters,
            case,
            parameters.duration,
            mesh,
            section.numerics,
            section.numerics.starts,
        )
        if not result.solution.converged:
            yield _least_infeasible(
                model, parameters, case, kind, mesh, section.numerics, proven=False
            )
            continue
        name, _ = plan_names(parameters, case, kind)
        turn = _least_torque(model, parameters, case, name, kind, result, starts, section.numerics)
        # Whether the larger turn is possible is the document's own question.
        answer = dict(zip(INFEASIBLE, (kind, result.solution.status, True, "", nan), strict=True))
        yield Turn(
            **{**vars(turn), "infeasible": answer if case == "half" else None},
        )


def free_plans(parameters: Parameters, section: Configuration) -> Iterator[Turn]:
    """The smaller turn without the gravity gradient, which has a solution by hand."""
    if impossible(parameters, "quarter", parameters.duration, gradient=False):
        return
    free = Model(
        parameters.inertia, parameters.torque, parameters.momentum, parameters.duration, True, None
    )
    for kind, mesh in meshes(section, "quarter").items():
        name = f"{parameters.names['quarter']}, no gravity gradient, {kind}"
        result, starts = best_plan(
            free, parameters, "quarter", parameters.duration, mesh, section.numerics, SWEEP_STARTS
        )
        turn = _least_torque(
            free, parameters, "quarter", name, kind, result, starts, section.numerics
        )
        missing = turn.missing + unsolved(name, result, f"{len(starts)} starts")
        yield Turn(turn.row, turn.seconds, timed=False, missing=missing)


def _least_torque(
    model: Model,
    parameters: Parameters,
    case: str,
    name: str,
    kind: str,
    result: Result,
    starts: pd.DataFrame,
    numerics: Numerics,
) -> Turn:
    """A plan of least torque; on our mesh with a held control too."""
    held: HeldPlan | None = None
    missing: list[NotConverged] = []
    if kind == "segments":
        held, missing = held_if_converged(model, parameters, case, name, result, numerics)
    return Turn(
        row=summary(model, parameters, name, result, starts, held),
        seconds=result.seconds,
        starts=starts.assign(plan=name),
        nodes=node_table(model, result, parameters, name),
        held=held_table(model, held, name) if held and held.solution.converged else None,
        missing=missing,
    )


def _least_infeasible(
    model: Model,
    parameters: Parameters,
    case: str,
    kind: str,
    mesh: Mesh,
    numerics: Numerics,
    proven: bool,
) -> Turn:
    """The plan that misses its end least; a larger turn that cannot be is a result, no failure."""
    feasible, name = plan_names(parameters, case, kind)
    result, refused = least_infeasible(model, parameters, case, parameters.duration, mesh, numerics)
    missing = unsolved(name, result, "free end, starts on and off the eigenaxis")
    if case == "quarter" or not proven:
        why = "no plan can exist in this time, by the bound" if proven else "no start converged"
        missing.insert(
            0,
            NotConverged(
                feasible,
                f"{refused.status}: {why}",
                refused.violation,
                "then with a free end, for the least miss",
            ),
        )
    met = (kind, refused.status, refused.converged, result.solution.status)
    return Turn(
        row=summary(model, parameters, name, result, pd.DataFrame({"converged": [True]}), None),
        seconds=result.seconds,
        nodes=node_table(model, result, parameters, name) if result.solution.converged else None,
        infeasible=dict(zip(INFEASIBLE, (*met, result.solution.objective), strict=True))
        if case == "half"
        else None,
        missing=missing,
    )
