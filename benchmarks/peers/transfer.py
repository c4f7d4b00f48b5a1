"""The orbit transfer in least time: direct collocation, yapss, dymos, and the document's listing.

The collocations start from the same rough guess, a straight line of states and a thrust that turns
once, on the same 20 segments with three Radau points each. dymos has SciPy's SLSQP: the optimizers
that it is else used with come with pyOptSparse, which PyPI does not have. The listing is the
document's multiple shooting from the document's guess; it is solved once more with exact
derivatives, as this project does it. The bounds of the final time are the document's for all.
"""

from pathlib import Path

import numpy as np
from contender import Contender, Problem
from scipy.integrate import solve_ivp
from scipy.interpolate import BarycentricInterpolator
from scipy.optimize import minimize

from smallsat.config import default_config
from smallsat.optimal_control.collocation import (
    Collocation,
    collocation_control,
    collocation_guess,
)
from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram, SlsqpSolver
from smallsat.studies.transfer.methods.collocation import GUESS_TIME, transcription
from smallsat.studies.transfer.methods.direct import (
    Case,
    control_history,
    interval_ends,
    program_numbers,
    published_guess,
    shooting_program,
)
from smallsat.studies.transfer.methods.experiments import extremal_table
from smallsat.studies.transfer.model.problem import STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import ControlHistory, boundary_error, propagate

ROOT = Path(__file__).parents[2]
# One in two thousand, which this mesh gives, and the listing with eight intervals.
REQUIRED = 5e-4
SECTION = default_config(ROOT).transfer
# Its units are canonical already.
TRANSFER = TransferProblem.of(SECTION.problem)
MESH = Collocation(20, 3, "radau")
TIME_BOUNDS = SECTION.bounds.final_time_multiple
# Of the interior-point method, here and in yapss.
TOLERANCE = 1e-10
CASE = Case(3, 8, "global")
# Of SLSQP: that of the listing's port, and what dymos takes if none is named.
SLSQP_TOLERANCE = 1e-6


def problem() -> Problem:
    """The document's transfer, whose optimum is the extremal that indirect shooting finds."""
    optimum = float(extremal_table(SECTION)["t"].iloc[-1])

    def error(found: ControlHistory) -> float:
        """How far the final time is from the optimum, or the end from the final orbit."""
        final, _ = propagate(TRANSFER, found)
        return max(abs(found.final_time / optimum - 1.0), boundary_error(TRANSFER, final))

    return Problem(
        "transfer: least time",
        "final time against that of the extremal, as a share, or miss of the final orbit in "
        "canonical units where the control is flown anew, whichever is larger",
        REQUIRED,
        error,
        (
            Contender("collocation", "smallsat", _ours),
            Contender("yapss", "yapss", _yapss),
            Contender("dymos, SLSQP", "dymos", _dymos),
            Contender("multiple shooting", "smallsat", _shooting),
            Contender("port of the listing", "scipy", _listing),
        ),
        3,
    )


def guessed_states(share: np.ndarray) -> np.ndarray:
    """States (5, n) on the line between both orbits, at shares (n,) of the time."""
    start = TRANSFER.initial_state
    angle = GUESS_TIME * TRANSFER.final_speed / TRANSFER.final_radius
    mass = TRANSFER.final_mass(GUESS_TIME)
    end = np.array([TRANSFER.final_radius, angle, 0.0, TRANSFER.final_speed, mass])
    return start[:, None] + (end - start)[:, None] * share


def guessed_angle(share: np.ndarray) -> np.ndarray:
    """The thrust's angle, rad, at shares (n,) of the time."""
    return 2.0 * np.pi * share


def collocated(final_time: float, nodes: np.ndarray, angles: np.ndarray) -> ControlHistory:
    """The control through angles (segments, n) at nodes (n,) between 0 and 1 in each segment.

    A collocation point leaves open by how many turns its angle differs from the others'.
    """
    times = np.linspace(0.0, final_time, len(angles) + 1)

    def control(k: int):
        polynomial = BarycentricInterpolator(nodes, np.unwrap(angles[k]))
        return lambda t: polynomial((t - times[k]) / (times[k + 1] - times[k]))

    return ControlHistory(times, [control(k) for k in range(len(angles))])


def _ours():
    solver = IpoptSolver(transcription(TRANSFER, MESH, TIME_BOUNDS), tol=TOLERANCE)
    guess = collocation_guess(
        MESH,
        GUESS_TIME,
        lambda t: guessed_states(np.array([t / GUESS_TIME])).ravel(),
        lambda t: guessed_angle(t / GUESS_TIME),
    )

    def solve() -> ControlHistory:
        solution = solver.solve(guess)
        angles = collocation_control(MESH, len(STATES), solution.variables)
        return collocated(solution.objective, MESH.nodes, angles)

    return solve


def _yapss():
    import yapss
    from yapss.math import cos, sin

    transfer = yapss.Problem(name="transfer", nx=[5], nu=[1])

    def objective(arg):
        arg.objective = arg.phase[0].final_time

    def continuous(arg):
        angle = arg.phase[0].control[0]
        arg.phase[0].dynamics[:] = TRANSFER.state_rate(arg.phase[0].state, sin(angle), cos(angle))

    transfer.functions.objective, transfer.functions.continuous = objective, continuous
    bounds, guess = transfer.bounds.phase[0], transfer.guess.phase[0]
    bounds.initial_time.lower = bounds.initial_time.upper = 0.0
    bounds.final_time.lower, bounds.final_time.upper = TIME_BOUNDS
    bounds.initial_state.lower[:] = bounds.initial_state.upper[:] = TRANSFER.initial_state
    for name, value in _ends().items():
        i = STATES.index(name)
        bounds.final_state.lower[i] = bounds.final_state.upper[i] = value
    share = np.linspace(0.0, 1.0, MESH.intervals * MESH.degree + 1)
    guess.time = GUESS_TIME * share
    guess.state, guess.control = guessed_states(share), guessed_angle(share)[None]
    transfer.mesh.phase[0].collocation_points = [MESH.degree] * MESH.intervals
    transfer.mesh.phase[0].fraction = [1.0 / MESH.intervals] * MESH.intervals
    transfer.spectral_method = "lgr"
    transfer.derivatives.method, transfer.derivatives.order = "auto", "second"
    transfer.ipopt_options.print_level = 0
    transfer.ipopt_options.tol = TOLERANCE

    def solve() -> ControlHistory:
        found = transfer.solve().phase[0]
        nodes = found.time_c[: MESH.degree] / found.final_time * MESH.intervals
        angles = found.control[0].reshape(MESH.intervals, MESH.degree)
        return collocated(found.final_time, nodes, angles)

    return solve


def _dymos():
    import dymos
    import openmdao.api as om

    class Rates(om.ExplicitComponent):
        """The equations of motion at all points; derivatives by complex steps, which are exact."""

        def initialize(self):
            self.options.declare("num_nodes", types=int)

        def setup(self):
            count = self.options["num_nodes"]
            for name in (*STATES, "beta"):
                self.add_input(name, np.ones(count))
            for name in STATES:
                self.add_output(f"{name}_rate", np.ones(count))
            every = np.arange(count)
            self.declare_partials("*", "*", rows=every, cols=every, method="cs")
            self.declare_coloring("*", method="cs", show_summary=False)

        def compute(self, inputs, outputs):
            states, angle = [inputs[name] for name in STATES], inputs["beta"]
            rates = TRANSFER.state_rate(states, np.sin(angle), np.cos(angle))
            for name, rate in zip(STATES, rates, strict=True):
                outputs[f"{name}_rate"] = rate

    transfer = om.Problem(reports=False, work_dir=str(ROOT / ".cache/bench"))
    transfer.driver = om.ScipyOptimizeDriver(
        optimizer="SLSQP", tol=SLSQP_TOLERANCE, maxiter=1000, disp=False
    )
    transfer.driver.declare_coloring(show_summary=False)
    mesh = dymos.Radau(num_segments=MESH.intervals, order=MESH.degree)
    phase = dymos.Phase(ode_class=Rates, transcription=mesh)
    transfer.model.add_subsystem("transfer", dymos.Trajectory()).add_phase("flight", phase)
    phase.set_time_options(fix_initial=True, duration_bounds=TIME_BOUNDS, units=None)
    for name in STATES:
        phase.add_state(name, rate_source=f"{name}_rate", targets=[name], fix_initial=True)
    for name, value in _ends().items():
        phase.add_boundary_constraint(name, loc="final", equals=value)
    # As free at every point as with the others.
    phase.add_control("beta", targets=["beta"], continuity=False, rate_continuity=False)
    phase.add_objective("time", loc="final")
    transfer.setup()
    ends = np.array([0.0, 1.0])

    def solve() -> ControlHistory:
        phase.set_time_val(initial=0.0, duration=GUESS_TIME)
        for name, line in zip(STATES, guessed_states(ends), strict=True):
            phase.set_state_val(name, line)
        phase.set_control_val("beta", guessed_angle(ends))
        transfer.run_driver()
        times = transfer.get_val("transfer.flight.timeseries.time").ravel()
        angles = transfer.get_val("transfer.flight.timeseries.beta").reshape(MESH.intervals, -1)
        nodes = times[: angles.shape[1]] / times[-1] * MESH.intervals
        return collocated(times[-1], nodes, angles)

    return solve


def _ends() -> dict[str, float]:
    """States that the final orbit fixes."""
    return {"r": TRANSFER.final_radius, "v_r": 0.0, "v_theta": TRANSFER.final_speed}


def _shooting():
    numbers = program_numbers(TRANSFER, CASE, SECTION.numerics.steps.as_published)
    solver = SlsqpSolver(_published_program(), numbers)
    guess = published_guess(CASE, SECTION.guess)
    return lambda: control_history(CASE, solver.solve(guess, SLSQP_TOLERANCE).variables)


def _listing():
    program = _published_program()
    bounds = list(zip(program.lower, program.upper, strict=True))
    guess = published_guess(CASE, SECTION.guess)
    return lambda: control_history(CASE, _port_of_the_listing(guess, bounds))


def _port_of_the_listing(guess: np.ndarray, bounds: list[tuple[float, float]]) -> np.ndarray:
    """Listings 6 to 11 in plain SciPy: nothing compiled, no derivatives."""

    def errors(z: np.ndarray) -> np.ndarray:
        interior, coefficients, final_time = CASE.split(z)
        nodes = np.concatenate([TRANSFER.initial_state, interior]).reshape(-1, 5)
        found = []
        for k, row in enumerate(np.reshape(coefficients, (CASE.intervals, -1))):

            def rate(tau: float, x: np.ndarray, row: np.ndarray = row) -> np.ndarray:
                beta = np.polyval(row, tau)
                return final_time / 2 * np.array(TRANSFER.state_rate(x, np.sin(beta), np.cos(beta)))

            end = solve_ivp(rate, interval_ends(CASE, k), nodes[k], method="LSODA", rtol=1e-6)
            state = end.y[:, -1]
            last = k == CASE.intervals - 1
            found.append(TRANSFER.terminal_error(state) if last else state - nodes[k + 1])
        return np.concatenate(found)

    return minimize(
        lambda z: z[-1],
        guess,
        bounds=bounds,
        constraints={"type": "eq", "fun": errors},
        method="SLSQP",
        options={"ftol": SLSQP_TOLERANCE, "maxiter": 1000},
    ).x


def _published_program() -> NonlinearProgram:
    return shooting_program(
        TRANSFER,
        CASE,
        SECTION.numerics.steps.as_published,
        coefficient_bounds=SECTION.bounds.coefficient,
        state_bounds=SECTION.bounds.interior_state,
        time_bounds=TIME_BOUNDS,
    )
