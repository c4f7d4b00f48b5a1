"""Library solvers for the programs of `riccati_interior_point`, one function each.

All solve the same problem, in which constraints are penalties with a large weight; DAQP alone has
them hard, for which it has a form, and so finds some programs infeasible.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sparse

from smallsat.dynamics.compiled import compiled
from smallsat.optimal_control.riccati_interior_point import (
    CONTROLS,
    SOLVED,
    STATES,
    Program,
    solve,
    workspace,
)
from smallsat.studies.rendezvous.methods import hpipm as hpipm_library

OWN_LIMIT = 100  # iterations
REPETITIONS = 20  # of the stage-wise solver, whose time is too short for the clock


@dataclass(frozen=True)
class SparseProgram:
    """minimise z'Pz/2 + q'z  subject to  Ez = e,  Gz <= h,  lower <= z <= upper.

    The unknowns z are the controls of all stages, the states 1..N, and the rows' excesses.
    """

    quadratic: sparse.csc_matrix
    linear: np.ndarray
    equalities: sparse.csc_matrix
    equal_to: np.ndarray
    inequalities: sparse.csc_matrix
    at_most: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    stages: int


@dataclass(frozen=True)
class Answer:
    """What a back end gave.

    Attributes
    ----------
    solved
        Whether it says so.
    controls
        Scaled, (N, 3).
    iterations
        Its own count.
    seconds
        Of the processor, for the solution, with the data in its own form already.
    """

    solved: bool
    controls: np.ndarray
    iterations: int
    seconds: float


def row_list(program: Program, stages: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All rows on states and controls as G z - excess <= b; G (R, 9 N) dense, b and w (R,)."""
    bounds = len(program.components)
    entries, limits, weights = [], [], []
    offset = CONTROLS * stages
    for i in range(1, stages + 1):
        at = offset + STATES * (i - 1)
        for p in range(program.plane_count[i]):
            row = np.zeros(offset + STATES * stages)
            row[at : at + 3] = program.normals[i, p]
            entries.append(row)
            limits.append(program.offsets[i, p])
            weights.append(program.plane_weights[i, p])
        for b in range(bounds):
            row = np.zeros(offset + STATES * stages)
            row[at + program.components[b]] = program.signs[b]
            entries.append(row)
            limits.append(program.bounds[i, b])
            weights.append(program.bound_weights[i, b])
    if program.control_norm[0] > 0.0:
        for c in range(offset):
            row = np.zeros(offset + STATES * stages)
            row[c] = 1.0
            entries.append(row)
            limits.append(0.0)
            weights.append(2.0 * program.control_norm[c % CONTROLS])
    return np.array(entries), np.array(limits), np.array(weights)


def sparse_program(program: Program, stages: int, start: np.ndarray) -> SparseProgram:
    """Write a program with states and excesses as unknowns."""
    rows, limits, weights = row_list(program, stages)
    count, controls, states = len(rows), CONTROLS * stages, STATES * stages
    blocks = [np.diag(program.control_hessian)] * stages
    blocks += [np.diag(program.state_hessian)] * (stages - 1) + [program.terminal_hessian]
    quadratic = sparse.block_diag([*blocks, sparse.csc_matrix((count, count))], "csc")
    linear = np.concatenate(
        [
            np.tile(-program.control_norm, stages),
            program.state_gradient[1 : stages + 1].ravel(),
            weights,
        ]
    )
    a, b = program.transition, program.transition[:, 3:]
    below = sparse.kron(sparse.eye(stages, k=-1), a)
    equalities = sparse.hstack(
        [
            -sparse.kron(sparse.eye(stages), b),
            sparse.eye(states) - below,
            sparse.csc_matrix((states, count)),
        ],
        "csc",
    )
    equal_to = np.zeros(states)
    equal_to[:STATES] = a @ start
    inequalities = sparse.hstack([sparse.csc_matrix(rows), -sparse.eye(count)], "csc")
    free = np.full(states, np.inf)
    return SparseProgram(
        sparse.csc_matrix(quadratic),
        linear,
        sparse.csc_matrix(equalities),
        equal_to,
        sparse.csc_matrix(inequalities),
        limits,
        np.concatenate([-np.ones(controls), -free, np.zeros(count)]),
        np.concatenate([np.ones(controls), free, np.full(count, np.inf)]),
        stages,
    )


def _answer(data: SparseProgram, solved: bool, z: Any, iterations: int, seconds: float) -> Answer:
    controls = np.asarray(z)[: CONTROLS * data.stages].reshape(-1, CONTROLS)
    return Answer(solved, controls, iterations, seconds)


def piqp(data: SparseProgram, tolerance: float) -> Answer:
    """PIQP, sparse: a proximal interior-point method."""
    import piqp as library

    solver = library.SparseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = tolerance
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = tolerance
    solver.settings.max_iter = 1000
    minus = np.full(len(data.at_most), -np.inf)
    solver.setup(
        data.quadratic, data.linear, data.equalities, data.equal_to, data.inequalities, minus,
        data.at_most, data.lower, data.upper,
    )  # fmt: skip
    begin = time.process_time()
    status = solver.solve()
    seconds = time.process_time() - begin
    solved = status == library.PIQP_SOLVED
    return _answer(data, solved, solver.result.x, solver.result.info.iter, seconds)


def _cone_rows(data: SparseProgram) -> tuple[sparse.csc_matrix, np.ndarray]:
    """Inequalities and finite bounds as one set of rows Gz <= h."""
    identity = sparse.eye(len(data.lower), format="csr")
    upper, lower = np.isfinite(data.upper), np.isfinite(data.lower)
    matrix = sparse.vstack([data.inequalities, identity[upper], -identity[lower]], "csc")
    return matrix, np.concatenate([data.at_most, data.upper[upper], -data.lower[lower]])


def clarabel(data: SparseProgram, tolerance: float) -> Answer:
    """Clarabel: a homogeneous embedding interior-point method."""
    import clarabel as library

    matrix, limits = _cone_rows(data)
    settings = library.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    solver = library.DefaultSolver(
        sparse.triu(data.quadratic, format="csc"),
        data.linear,
        sparse.vstack([data.equalities, matrix], "csc"),
        np.concatenate([data.equal_to, limits]),
        [library.ZeroConeT(len(data.equal_to)), library.NonnegativeConeT(len(limits))],
        settings,
    )
    begin = time.process_time()
    solution = solver.solve()
    seconds = time.process_time() - begin
    solved = solution.status == library.SolverStatus.Solved
    return _answer(data, solved, solution.x, solution.iterations, seconds)


def osqp(data: SparseProgram, tolerance: float) -> Answer:
    """OSQP: operator splitting."""
    import osqp as library

    solver = library.OSQP()
    identity = sparse.eye(len(data.lower), format="csc")
    solver.setup(
        sparse.triu(data.quadratic, format="csc"),
        data.linear,
        sparse.vstack([data.equalities, data.inequalities, identity], "csc"),
        np.concatenate([data.equal_to, np.full(len(data.at_most), -np.inf), data.lower]),
        np.concatenate([data.equal_to, data.at_most, data.upper]),
        eps_abs=tolerance,
        eps_rel=tolerance,
        max_iter=100000,
        verbose=False,
    )
    begin = time.process_time()
    result = solver.solve(raise_error=False)
    seconds = time.process_time() - begin
    solved = result.info.status == "solved"
    return _answer(data, solved, result.x, result.info.iter, seconds)


def daqp(
    program: Program, stages: int, start: np.ndarray, hard_weight: float, tolerance: float
) -> Answer:
    """DAQP: a dual active-set method, on the program in the controls alone.

    Rows with `hard_weight` are constraints; the others keep their excess as an unknown.
    """
    import daqp as library

    data = sparse_program(program, stages, start)
    controls, states = CONTROLS * stages, STATES * stages
    free = np.linalg.solve(
        data.equalities[:, controls : controls + states].toarray(),
        np.column_stack([data.equal_to, -data.equalities[:, :controls].toarray()]),
    )
    at_rest, reach = free[:, 0], free[:, 1:]
    inner = data.quadratic[controls : controls + states, controls : controls + states].toarray()
    weights = data.linear[controls + states :]
    soft = weights != hard_weight
    excesses = int(soft.sum())
    hessian = np.zeros((controls + excesses, controls + excesses))
    hessian[:controls, :controls] = (
        data.quadratic[:controls, :controls].toarray() + reach.T @ inner @ reach
    )
    gradient = np.zeros(controls + excesses)
    gradient[:controls] = data.linear[:controls] + reach.T @ (
        data.linear[controls : controls + states] + inner @ at_rest
    )
    gradient[controls:] = weights[soft]
    rows = data.inequalities[:, : controls + states].toarray()
    matrix = np.zeros((len(weights), controls + excesses))
    matrix[:, :controls] = rows[:, :controls] + rows[:, controls:] @ reach
    matrix[np.flatnonzero(soft), controls + np.arange(excesses)] = -1.0
    limits = data.at_most - rows[:, controls:] @ at_rest
    infinite = 1e30
    upper = np.concatenate([np.ones(controls), np.full(excesses, infinite), limits])
    lower = np.concatenate(
        [-np.ones(controls), np.zeros(excesses), np.full(len(limits), -infinite)]
    )
    x, _, flag, info = library.solve(
        hessian, gradient, matrix, upper, lower, primal_tol=tolerance, iter_limit=100000
    )
    return _answer(data, flag == 1, x, info["iterations"], info["setup_time"] + info["solve_time"])


def hpipm(program: Program, stages: int, start: np.ndarray, tolerance: float) -> Answer:
    """HPIPM: a Riccati-based interior-point method, through its C interface."""
    solver = hpipm_library.Solver(program, stages, start, tolerance)
    solved, controls, iterations, seconds = solver.solve()
    return Answer(solved, controls, iterations, seconds)


def own(program: Program, stages: int, start: np.ndarray, tolerance: float) -> Answer:
    """The stage-wise solver of this package, timed as in the loop: called from compiled code."""
    planes = program.normals.shape[1]
    work = workspace(stages, planes, len(program.components))
    status, iterations = solve(program, stages, start, work, tolerance, OWN_LIMIT)
    begin = time.process_time()
    _solve_again(program, stages, start, work, tolerance, REPETITIONS)
    seconds = (time.process_time() - begin) / REPETITIONS
    return Answer(status == SOLVED, work.controls[:stages].copy(), iterations, seconds)


@compiled
def _solve_again(program, stages, start, work, tolerance, times):
    for _ in range(times):
        solve(program, stages, start, work, tolerance, OWN_LIMIT)


def cost(program: Program, stages: int, start: np.ndarray, controls: np.ndarray) -> float:
    """Cost of some controls, clipped to their bounds, with the penalties of all rows."""
    u = np.clip(controls, -1.0, 1.0)
    states = [np.asarray(start)]
    for control in u:
        moved = states[-1].copy()
        moved[3:] += control
        states.append(program.transition @ moved)
    x = np.array(states)
    rows, limits, weights = row_list(program, stages)
    excess = np.maximum(rows @ np.concatenate([u.ravel(), x[1:].ravel()]) - limits, 0.0)
    quadratic = (
        np.sum(program.control_hessian * u**2)
        + np.sum(program.state_hessian * x[1:stages] ** 2)
        + x[-1] @ program.terminal_hessian @ x[-1]
    )
    linear = np.sum(program.state_gradient[1 : stages + 1] * x[1:]) - np.sum(
        program.control_norm * u
    )
    return float(0.5 * quadratic + linear + weights @ excess)
