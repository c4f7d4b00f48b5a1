"""The docking phase's predictive control in closed loop: the compiled loop, OSQP, cvxpy, do-mpc.

All fly the phase from the same state, and solve the same quadratic programs, whose rows give way
against a large weight. From one to the next their start alone changes, so that a peer sets its
solver up once and starts each solution from the last one; this project writes every program anew,
as the other phases need it. The excesses of the rows are in units in which their weight is 1,
without which OSQP is slower and less accurate. Its tolerance is the loosest power of ten that is as
accurate as asked for; Clarabel's and that of IPOPT, which do-mpc calls, are their usual ones.

Neither TinyMPC nor acados is here: the wheels of the former bound states and controls but know no
cones, and the only one of the latter, by others, puts a CasADi without IPOPT in place of the
project's.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
from contender import Contender, Problem

from smallsat.config import default_config
from smallsat.optimal_control.riccati_interior_point import Program
from smallsat.studies.rendezvous.guidance.law import APPROACH, DOCKING, settings
from smallsat.studies.rendezvous.guidance.phase_programs import empty_program, write_program
from smallsat.studies.rendezvous.methods import qp_solvers
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import simulate

ROOT = Path(__file__).parents[2]
# Of the largest change of velocity.
REQUIRED = 5e-4
# Of Clarabel, as the reference and as a peer, and of OSQP.
REFERENCE_TOLERANCE, CLARABEL_TOLERANCE = 1e-12, 1e-8
OSQP_TOLERANCE = 1e-5
OSQP_ITERATIONS = 100000

SECTION = default_config(ROOT).rendezvous
LAW = law(SECTION)
RECORD = settings([LAW])[0]
STAGES = int(RECORD["horizons"][DOCKING])
SAMPLE_TIME = float(RECORD["sample_times"][DOCKING])

# The first control (3,) for a state (6,), both scaled.
Control = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Phase:
    """What a loop flies.

    Attributes
    ----------
    start
        Relative state where the document's manoeuvre comes to the docking phase, m and m/s, (6,).
    program
        The first one; of the others, in the law's scales, only the start differs.
    steps
        As many as the compiled loop takes to the phase's end.
    """

    start: np.ndarray
    program: Program
    steps: int

    @property
    def scaled_start(self) -> np.ndarray:
        """The start in the law's scales."""
        return self.start / RECORD["scales"][DOCKING]

    @property
    def move(self) -> np.ndarray:
        """A of a stage, (6, 6), scaled."""
        return self.program.transitions[0]

    def sparse(self, state: np.ndarray) -> qp_solvers.SparseProgram:
        """The program from a scaled state (6,)."""
        return qp_solvers.sparse_program(qp_solvers.Sample("docking", self.program, STAGES, state))

    def flown(self, control: Control) -> np.ndarray:
        """Scaled controls (steps, 3) of a loop in Python."""
        state, found = self.scaled_start, []
        for _ in range(self.steps):
            found.append(np.clip(control(state), -1.0, 1.0))
            state = self.move @ (state + np.r_[np.zeros(3), found[-1]])
        return np.array(found)


@cache
def phase() -> Phase:
    """The phase of the document's first case; the first call compiles, and is counted as ours."""
    flight = simulate([LAW], start_state(SECTION))
    start = flight.ends[0, APPROACH]
    program, _ = write_program(RECORD, DOCKING, start, 0.0, empty_program(STAGES))
    return Phase(start, program, int(flight.steps[0, DOCKING]))


@cache
def reference() -> np.ndarray:
    """Scaled controls (steps, 3) of the loop around a solver of high accuracy."""

    def control(state: np.ndarray) -> np.ndarray:
        answer = qp_solvers.clarabel(phase().sparse(state), REFERENCE_TOLERANCE)
        if not answer.solved:
            raise RuntimeError("a program of the reference was not solved")
        return answer.controls[0]

    return phase().flown(control)


def problem() -> Problem:
    """The docking phase of the document's first case, to its end."""

    def error(found: np.ndarray) -> float:
        """Largest difference of a control from the reference's, in largest controls."""
        return float(np.max(np.abs(found - reference())))

    return Problem(
        "rendezvous: the docking loop",
        "largest difference of a velocity change from that of the loop around Clarabel with a "
        f"tolerance of {REFERENCE_TOLERANCE:g}, as a share of the largest one allowed",
        REQUIRED,
        error,
        (
            Contender("compiled loop", "smallsat", _ours),
            Contender("Python and OSQP", "osqp", lambda: _loop(_osqp)),
            Contender("cvxpy, OSQP", "cvxpy", lambda: _loop(_cvxpy_osqp)),
            Contender("cvxpy, Clarabel", "cvxpy", lambda: _loop(_cvxpy_clarabel)),
            Contender("do-mpc, IPOPT", "do-mpc", lambda: _loop(_do_mpc)),
        ),
        # Ours is over so soon that three would scatter.
        9,
    )


def _ours():
    start = phase().start

    def solve() -> np.ndarray:
        docking = simulate([LAW], start, phases=(DOCKING, DOCKING), with_steps=True)
        return docking.record(0).impulse / RECORD["control_bounds"][DOCKING]

    solve()
    return solve


def _loop(prepare: Callable[[], tuple[Control, Callable[[], None]]]):
    """A peer's loop; ``prepare`` gives its control, and what makes it forget the last flight."""
    control, forget = prepare()

    def solve() -> np.ndarray:
        forget()
        return phase().flown(control)

    return solve


def _osqp():
    import osqp

    move, program = phase().move, phase().sparse(phase().scaled_start)
    count = len(program.at_most)
    weights = program.linear[-count:]
    units = sparse.diags(np.r_[np.ones(len(program.linear) - count), 1.0 / weights], format="csc")
    matrix = sparse.vstack([program.equalities, program.inequalities], "csc") @ units
    lower = np.r_[program.equal_to, np.full(count, -np.inf), program.lower]
    upper = np.r_[program.equal_to, program.at_most, program.upper]
    solver = osqp.OSQP()
    solver.setup(
        sparse.triu(program.quadratic, format="csc"),
        units @ program.linear,
        sparse.vstack([matrix, sparse.eye(len(program.linear))], "csc"),
        lower,
        upper,
        eps_abs=OSQP_TOLERANCE,
        eps_rel=OSQP_TOLERANCE,
        max_iter=OSQP_ITERATIONS,
        verbose=False,
    )

    def control(state: np.ndarray) -> np.ndarray:
        lower[:6] = upper[:6] = move @ state
        solver.update(l=lower, u=upper)
        return solver.solve(raise_error=False).x[:3]

    def forget() -> None:
        solver.warm_start(np.zeros(len(program.linear)), np.zeros(len(lower)))

    return control, forget


def _cvxpy_osqp():
    return _cvxpy("OSQP", eps_abs=OSQP_TOLERANCE, eps_rel=OSQP_TOLERANCE, max_iter=OSQP_ITERATIONS)


def _cvxpy_clarabel():
    tolerance = CLARABEL_TOLERANCE
    return _cvxpy("CLARABEL", tol_gap_abs=tolerance, tol_gap_rel=tolerance, tol_feas=tolerance)


def _cvxpy(solver: str, **options: float):
    import cvxpy as cp

    start, given = cp.Parameter(6), phase().program
    rows, limits, weights = qp_solvers.stage_rows(given, 1)
    states, controls = cp.Variable((STAGES + 1, 6)), cp.Variable((STAGES, 3))
    excesses = cp.Variable((STAGES, len(limits)), nonneg=True)
    pushed = states[:-1] + cp.hstack([np.zeros((STAGES, 3)), controls])
    cost = (
        cp.sum(cp.square(controls) @ given.control_hessian) / 2
        + cp.sum(cp.square(states[1:-1]) @ given.state_hessian) / 2
        + cp.quad_form(states[-1], cp.psd_wrap(given.terminal_hessian)) / 2
        + cp.sum(cp.multiply(given.state_gradient[1:], states[1:]))
        + cp.sum(excesses)
    )
    within = states[1:] @ rows.T - excesses @ np.diag(1.0 / weights) <= np.tile(limits, (STAGES, 1))
    moved = states[1:] == pushed @ phase().move.T
    program = cp.Problem(
        cp.Minimize(cost), [states[0] == start, moved, within, controls <= 1, controls >= -1]
    )

    def control(state: np.ndarray) -> np.ndarray:
        start.value = state
        program.solve(solver=solver, warm_start=True, **options)
        return controls.value[0]

    # The first solution canonicalizes the program, for any start; what it found is not forgotten.
    control(phase().scaled_start)
    return control, lambda: None


def _do_mpc():
    with warnings.catch_warnings():
        # It names the parts of it that are not installed.
        warnings.simplefilter("ignore")
        import do_mpc
    import casadi as ca

    given, move = phase().program, ca.DM(phase().move)
    rows, limits, weights = qp_solvers.stage_rows(given, 1)
    model = do_mpc.model.Model("discrete")
    state, push = model.set_variable("_x", "x", (6, 1)), model.set_variable("_u", "u", (3, 1))
    model.set_rhs("x", move @ (state + ca.vertcat(ca.DM.zeros(3), push)))
    model.setup()
    state, push = model.x["x"], model.u["u"]
    mpc = do_mpc.controller.MPC(model)
    mpc.settings.n_horizon, mpc.settings.t_step = STAGES, SAMPLE_TIME
    mpc.settings.store_full_solution = False
    mpc.settings.supress_ipopt_output()
    hessian, last = ca.DM(np.diag(given.state_hessian)), ca.DM(given.terminal_hessian)
    effort = ca.dot(ca.DM(given.control_hessian), push**2)
    gradient = given.state_gradient
    mpc.set_objective(
        lterm=(state.T @ hessian @ state + effort) / 2 + ca.dot(ca.DM(gradient[1]), state),
        mterm=state.T @ last @ state / 2 + ca.dot(ca.DM(gradient[STAGES]), state),
    )
    mpc.set_rterm(u=0.0)
    mpc.bounds["lower", "_u", "u"], mpc.bounds["upper", "_u", "u"] = -1.0, 1.0
    # Its rows are on the states before each control; ours are on those after it.
    following = move @ (state + ca.vertcat(ca.DM.zeros(3), push))
    for r, (row, limit, weight) in enumerate(zip(rows, limits, weights, strict=True)):
        mpc.set_nl_cons(
            f"row_{r}",
            weight * ca.dot(ca.DM(row), following),
            ub=weight * limit,
            soft_constraint=True,
            penalty_term_cons=1.0,
        )
    with warnings.catch_warnings():
        # A legacy call of CasADi in it.
        warnings.simplefilter("ignore")
        mpc.setup()

    def control(state: np.ndarray) -> np.ndarray:
        return mpc.make_step(state[:, None]).ravel()

    def forget() -> None:
        mpc.reset_history()
        mpc.x0 = phase().scaled_start
        mpc.u0 = np.zeros(3)
        mpc.set_initial_guess()

    return control, forget
