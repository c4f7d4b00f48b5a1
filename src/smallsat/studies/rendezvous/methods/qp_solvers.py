"""Library solvers for the programs of `riccati_interior_point`, one function each.

All solve the same problem, in which constraints are penalties with a large weight. Each library is
called by its own interface, not through qpsolvers: that counts wall-clock seconds instead of the
processor's, and tells no iterations of Clarabel.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import scipy.linalg
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

Result = TypeVar("Result")
OWN_LIMIT = 100  # iterations
REPETITIONS = 20  # of the stage-wise solver, whose time is too short for the clock


@dataclass(frozen=True)
class Sample:
    """One program of a closed loop: which kind, the program, its stages and its start."""

    kind: str
    program: Program
    stages: int
    start: np.ndarray


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
    """What a solver gave.

    Attributes
    ----------
    solved
        Whether it says so.
    controls
        Scaled, (N, 3).
    iterations
        The solver's own count.
    seconds
        Processor seconds of the solution, with the data in its own form already.
    """

    solved: bool
    controls: np.ndarray
    iterations: int
    seconds: float


def stage_rows(program: Program, i: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows on the state of a stage: G (R, 6), b and w (R,), in G x - excess <= b."""
    planes, bounds = program.plane_count[i], len(program.components)
    rows = np.zeros((planes + bounds, STATES))
    rows[:planes, :3] = program.normals[i, :planes]
    rows[planes + np.arange(bounds), program.components] = program.signs
    limits = np.concatenate([program.offsets[i, :planes], program.bounds[i, :bounds]])
    weights = np.concatenate([program.plane_weights[i, :planes], program.bound_weights[i, :bounds]])
    return rows, limits, weights


def row_list(program: Program, stages: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All rows on controls and states z, (9 N,), as G z - excess <= b; G (R, 9 N), b and w (R,)."""
    matrices, limits, weights = zip(
        *(stage_rows(program, i) for i in range(1, stages + 1)), strict=True
    )
    matrix = scipy.linalg.block_diag(*matrices)
    matrix = np.hstack([np.zeros((len(matrix), CONTROLS * stages)), matrix])
    if program.control_norm[0] > 0.0:
        matrix = np.vstack([matrix, np.eye(CONTROLS * stages, matrix.shape[1])])
        limits += (np.zeros(CONTROLS * stages),)
        weights += (np.tile(2.0 * program.control_norm, stages),)
    return matrix, np.concatenate(limits), np.concatenate(weights)


def moves_of(sample: Sample) -> np.ndarray:
    """A of each stage, (N, 6, 6)."""
    return np.broadcast_to(sample.program.transitions, (sample.stages, STATES, STATES))


def sparse_program(sample: Sample) -> SparseProgram:
    """Write a program with states and excesses as unknowns."""
    program, stages = sample.program, sample.stages
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
    moves = moves_of(sample)
    below = sparse.lil_matrix((states, states))
    for i in range(1, stages):
        below[STATES * i : STATES * (i + 1), STATES * (i - 1) : STATES * i] = moves[i]
    equalities = sparse.hstack(
        [
            -sparse.block_diag([a[:, 3:] for a in moves]),
            sparse.eye(states) - below,
            sparse.csc_matrix((states, count)),
        ],
        "csc",
    )
    equal_to = np.zeros(states)
    equal_to[:STATES] = moves[0] @ sample.start
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


def timed(solve: Callable[[], Result]) -> tuple[Result, float]:
    """What a call returns, and its processor seconds."""
    begin = time.process_time()
    result = solve()
    return result, time.process_time() - begin


def _answer(data: SparseProgram, solved: bool, z: Any, iterations: int, seconds: float) -> Answer:
    controls = np.asarray(z)[: CONTROLS * data.stages].reshape(-1, CONTROLS)
    return Answer(solved, controls, iterations, seconds)


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
    solution, seconds = timed(solver.solve)
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
    result, seconds = timed(lambda: solver.solve(raise_error=False))
    solved = result.info.status == "solved"
    return _answer(data, solved, result.x, result.info.iter, seconds)


def own(sample: Sample, tolerance: float) -> Answer:
    """The stage-wise solver of this package, timed as in the loop: called from compiled code."""
    program, stages = sample.program, sample.stages
    work = workspace(stages, program.normals.shape[1], len(program.components))
    solution = solve(program, stages, sample.start, work, tolerance, OWN_LIMIT)
    again = (program, stages, sample.start, work, tolerance)
    _, seconds = timed(lambda: _solve_again(*again))
    solved, controls = solution.status == SOLVED, solution.controls.copy()
    return Answer(solved, controls, solution.iterations, seconds / REPETITIONS)


@compiled
def _solve_again(program, stages, start, work, tolerance):
    for _ in range(REPETITIONS):
        solve(program, stages, start, work, tolerance, OWN_LIMIT)


def cost(sample: Sample, controls: np.ndarray) -> float:
    """Cost of some controls (N, 3), clipped to their bounds, with the penalties of all rows."""
    program, stages = sample.program, sample.stages
    u = np.clip(controls, -1.0, 1.0)
    states = [np.asarray(sample.start)]
    for transition, control in zip(moves_of(sample), u, strict=True):
        moved = states[-1].copy()
        moved[3:] += control
        states.append(transition @ moved)
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
