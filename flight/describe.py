"""Describe one phase's program to CVXPYgen, which writes a solver for it in C (with QOCO inside).

    python describe.py PROGRAM.json FOLDER

It runs in an environment of its own, see requirements.in, and knows nothing of the project. The
program is the document's: what is a constraint there has no slack here. Symbols are those of
program.h; what changes from step to step is a parameter, the rest is a constant of the solver.
"""

import json
import sys
from pathlib import Path

import cvxpy as cp
import numpy as np
from cvxpygen import cpg


def problem(given: dict) -> cp.Problem:
    """The program of a phase: (3.7), (3.10) or (3.14), in scaled units.

    ``given`` has ``stages``, ``transition`` (6, 6), ``state_hessian`` (6,), ``terminal_hessian``
    (6, 6), ``control_hessian`` (3,); for each row on the position whether it is a ``penalty`` and
    the ``weight`` of that, at the ``inner`` stages and at the ``last`` one; the ``speed_bound``.
    """
    stages = given["stages"]
    x = cp.Variable((stages + 1, 6), name="states")
    u = cp.Variable((stages, 3), name="controls")
    start = cp.Parameter(6, name="start")
    gradient = cp.Parameter((stages, 6), name="gradient")
    transition = np.array(given["transition"])
    cost = cp.sum(cp.multiply(gradient, x[1:]))
    # As a sum of squares: CVXPYgen 1.0.2 hands QOCO some entries of a form below the diagonal.
    values, vectors = np.linalg.eigh(given["terminal_hessian"])
    cost += 0.5 * cp.sum_squares((np.sqrt(np.maximum(values, 0.0)) * vectors).T @ x[stages])
    cost += 0.5 * cp.sum_squares(cp.multiply(np.sqrt(given["control_hessian"])[None, :], u))
    if stages > 1:
        root = np.sqrt(given["state_hessian"])[None, :]
        cost += 0.5 * cp.sum_squares(cp.multiply(root, x[1:stages]))
    moved = x[:-1] + cp.hstack([np.zeros((stages, 3)), u])
    constraints = [x[0] == start, x[1:] == moved @ transition.T, cp.abs(u) <= 1.0]
    inner, last = given["inner"], given["last"]
    for row in range(max(len(inner), len(last))):
        first = 0 if row < len(inner) else stages - 1
        normal = cp.Parameter((stages - first, 3), name=f"normal{row}")
        offset = cp.Parameter(stages - first, name=f"offset{row}")
        excess = cp.sum(cp.multiply(normal, x[first + 1 :, :3]), axis=1) - offset
        weight = last[row]["weight"]
        if last[row]["penalty"]:
            cost += weight * cp.sum(cp.pos(excess))
        else:
            constraints.append(excess <= 0.0)
    if given["speed_bound"] is not None:
        constraints.append(cp.abs(x[1:, 3:]) <= given["speed_bound"])
    return cp.Problem(cp.Minimize(cost), constraints)


def mend(sources: Path) -> None:
    """Put right two things of the QOCO that CVXPYgen brings, without which later solves go wrong.

    Entry i of a matrix is entry ``GtoGt[i]`` of its transpose, as the setup has it; the update
    reads that map the other way round, and the dual residual is then that of another program. And
    a solve begins with the scaling of the one before in its linear system, where that of the
    identity is meant: after a program without a solution nothing is solved any more. All cones
    here are linear.
    """
    for name in "AG":
        replace(
            sources / "qoco_api.c",
            f"{name}tx[i] = {name}xnew[data->{name}to{name}t[i]];",
            f"{name}tx[data->{name}to{name}t[i]] = {name}xnew[i];",
        )
    factor = "  // Factor KKT matrix.\n  solver->linsys->linsys_factor("
    identity = """  for (QOCOInt i = 0; i < data->m; ++i)
    get_data_vectorf(work->WtW)[i] = 1.0;
  solver->linsys->linsys_update_nt(solver->linsys_data, work->WtW,
                                   solver->settings->kkt_static_reg, data->m);
"""
    replace(sources / "kkt.c", factor, identity + factor, only="initialize_ipm")


def replace(source: Path, old: str, new: str, only: str = "") -> None:
    """Replace a text in a file, after the definition of a function if one is named."""
    text = source.read_text()
    start = text.index(f"\nvoid {only}(") if only else 0
    before, after = text[:start], text[start:]
    if old not in after:
        sys.exit(f"{source}: no '{old}'; see whether this QOCO still needs mending")
    source.write_text(before + after.replace(old, new, 1))


if __name__ == "__main__":
    cpg.generate_code(
        problem(json.loads(Path(sys.argv[1]).read_text())),
        code_dir=sys.argv[2],
        solver="QOCO",
        wrapper=False,
    )
    mend(Path(sys.argv[2]) / "c/solver_code/src")
