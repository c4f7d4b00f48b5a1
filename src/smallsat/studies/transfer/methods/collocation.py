"""The document's future work: direct and indirect collocation, beside what it did."""

import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import casadi as ca
import numpy as np
import pandas as pd
from scipy.integrate import solve_bvp
from scipy.interpolate import BarycentricInterpolator

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.collocation import (
    Collocation,
    collocation_control,
    collocation_guess,
    collocation_program,
)
from smallsat.optimal_control.nonlinear_program import IpoptSolver, NonlinearProgram, Solution
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.bounds import relative_length, time_bounds
from smallsat.studies.transfer.methods.experiments import NO_EXTREMAL, extremal_table
from smallsat.studies.transfer.methods.extremals import SAME_TIME
from smallsat.studies.transfer.methods.indirect import Extremal, condition_error, propagate_extremal
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import ControlHistory, boundary_error, propagate
from smallsat.studies.transfer.model.units import canonical, units_of

Row = dict[str, Any]
COLUMNS = [
    "method",
    "intervals",
    "degree",
    "final_time",
    "converged",
    "iterations",
    "residual",
    "seconds",
]

MESHES = (
    Collocation(20, 3, "radau"),
    Collocation(80, 3, "radau"),
    Collocation(40, 4, "legendre"),
    Collocation(80, 4, "legendre"),
)

# A rough guess that knows nothing of the document's transfer but a plausible duration. For another
# transfer it is as much longer or shorter as that is.
GUESS_TIME = 3.3

# A plausible costate for indirect collocation: signs of a spiral outwards, lambda_m between the
# initial and the final value. The document's own guess does not converge there.
COLLOCATION_COSTATE = (-1.0, 0.0, -0.5, 1.0, 0.5)

# Points of the first mesh of indirect collocation, from the rough guess and from the extremal.
ROUGH_POINTS, FINE_POINTS = 41, 481


def collocation(section: Configuration) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Direct collocation on several meshes, and indirect collocation.

    Each starts from a rough guess, and where that does not converge, or ends at a slower extremal,
    from the extremal of indirect shooting. What fails still keeps its row, without a final time.

    Returns
    -------
    table
        Columns method, intervals, degree, final_time, converged, iterations, residual, seconds.
    not_converged
        Rows of it that nothing solved.
    """
    configured = TransferProblem.of(section.problem)
    problem, unit = canonical(configured), units_of(configured).time
    extremal = extremal_table(section)
    rows, missing = [], []
    if isinstance(extremal, NotConverged):
        name = "direct and indirect collocation"
        unknown = replace(extremal, case=name, status=NO_EXTREMAL, residual=np.inf)
        return pd.DataFrame(columns=COLUMNS), [unknown]
    methods: list[Callable[..., tuple[Row, str]]] = [partial(_direct, mesh=m) for m in MESHES]
    for solve in (*methods, _indirect):
        tried = []
        for name, rough in (("a rough guess", True), ("the extremal", False)):
            row, status = solve(problem, extremal, rough=rough)
            if row["converged"]:
                break
            tried.append(f"{name}: {status}")
        else:
            row |= {"final_time": np.nan, "residual": np.inf}
            case = f"{row['method']}, {row['intervals']} intervals"
            missing.append(NotConverged(case, tried[-1], np.inf, "; ".join(tried)))
        rows.append(row | {"final_time": row["final_time"] * unit})
    return pd.DataFrame(rows, columns=COLUMNS), missing


def direct_collocation(
    problem: TransferProblem, extremal: pd.DataFrame, mesh: Collocation, *, rough: bool
) -> tuple[Solution, ControlHistory]:
    """Direct collocation on a mesh and its control, in canonical units.

    Parameters
    ----------
    problem, mesh
        What is solved.
    extremal
        Table of `propagate_extremal`; of a rough guess, its final time alone is used.
    rough
        Guess a straight line of states and a thrust angle that turns once, instead of the extremal.
    """
    final_time = float(extremal["t"].iloc[-1])
    if rough:
        duration = GUESS_TIME * relative_length(final_time)
        guess = collocation_guess(
            mesh,
            duration,
            lambda t: _straight_line(problem, duration, np.array([t / duration])).ravel(),
            lambda t: 2 * np.pi * t / duration,
        )
    else:
        guess = extremal_guess(extremal, mesh)
    program = transcription(problem, mesh, time_bounds(final_time))
    solution = IpoptSolver(program).solve(guess)
    controls = collocation_control(mesh, len(STATES), solution.variables)
    return solution, _collocated_history(mesh, controls, solution.objective)


def transcription(
    problem: TransferProblem, mesh: Collocation, bounds: tuple[float, float]
) -> NonlinearProgram:
    """The nonlinear program of direct collocation on a mesh.

    Parameters
    ----------
    problem, mesh
        What is solved, in canonical units.
    bounds
        Of the final time.
    """

    def rate(x: Any, u: Any) -> list[Any]:
        return problem.state_rate(x, ca.sin(u), ca.cos(u))

    return collocation_program(rate, problem.initial_state, problem.terminal_error, mesh, bounds)


def extremal_guess(extremal: pd.DataFrame, mesh: Collocation) -> np.ndarray:
    """An extremal, a table of `propagate_extremal`, as the variables of a `transcription`."""
    times, angle = extremal["t"].to_numpy(), np.unwrap(extremal["beta"])
    states = [extremal[name].to_numpy() for name in STATES]
    return collocation_guess(
        mesh,
        float(times[-1]),
        lambda t: np.array([np.interp(t, times, state) for state in states]),
        lambda t: float(np.interp(t, times, angle)),
    )


def indirect_collocation(
    problem: TransferProblem, extremal: pd.DataFrame, *, rough: bool
) -> tuple[Any, float]:
    """Indirect collocation of the costate problem with SciPy's solve_bvp, in canonical units.

    Parameters
    ----------
    problem, extremal, rough
        As in `direct_collocation`; the rough guess has a constant costate.

    Returns
    -------
    solution, seconds
        What solve_bvp returned, and how long it took.
    """
    final_time = float(extremal["t"].iloc[-1])
    s = np.linspace(0.0, 1.0, ROUGH_POINTS if rough else FINE_POINTS)
    if rough:
        final_time = GUESS_TIME * relative_length(final_time)
        costates = np.repeat(np.array(COLLOCATION_COSTATE)[:, None], s.size, axis=1)
        guess = np.vstack([_straight_line(problem, final_time, s), costates])
    else:
        names = (*STATES, *COSTATES)
        guess = np.array([np.interp(s * final_time, extremal["t"], extremal[n]) for n in names])

    def rate(_: np.ndarray, y: np.ndarray, p: np.ndarray) -> np.ndarray:
        return p[0] * np.array(problem.extremal_rate(y[:5], y[5:]))

    def conditions(ya: np.ndarray, yb: np.ndarray, p: np.ndarray) -> np.ndarray:
        transversality = [yb[6], yb[9] - 1.0, problem.hamiltonian(yb[:5], yb[5:])]
        return np.array(
            [*(ya[:5] - problem.initial_state), *problem.terminal_error(yb), *transversality]
        )

    began = time.perf_counter()
    # A poor guess overflows inside the solver; its status says so, and is what we report.
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        solution = solve_bvp(rate, conditions, s, guess, p=[final_time], tol=1e-8, max_nodes=20000)
    return solution, time.perf_counter() - began


def _direct(
    problem: TransferProblem, extremal: pd.DataFrame, mesh: Collocation, *, rough: bool
) -> tuple[Row, str]:
    solution, history = direct_collocation(problem, extremal, mesh, rough=rough)
    final, _ = propagate(problem, history)
    row = {
        "method": f"direct collocation, {mesh.points}",
        "intervals": mesh.intervals,
        "degree": mesh.degree,
        "final_time": solution.objective,
        "converged": solution.converged,
        "iterations": solution.iterations,
        "residual": boundary_error(problem, final),
        "seconds": solution.seconds,
    }
    return row, solution.status


def _indirect(problem: TransferProblem, extremal: pd.DataFrame, *, rough: bool) -> tuple[Row, str]:
    solution, seconds = indirect_collocation(problem, extremal, rough=rough)
    final_time, best = float(solution.p[0]), float(extremal["t"].iloc[-1])
    status = str(solution.message)
    if solution.success and not 0.0 < final_time <= best * (1 + SAME_TIME):
        status = f"another extremal, t_f = {final_time:.6g}"
    converged = bool(solution.success) and 0.0 < final_time <= best * (1 + SAME_TIME)
    residual = np.inf
    if converged:
        found = Extremal(solution.y[:, :1].T, final_time, solution.niter, 0.0, seconds)
        residual = condition_error(problem, propagate_extremal(problem, found, 2)[0])
    row = {
        "method": "indirect collocation, solve_bvp",
        "intervals": solution.x.size - 1,
        "degree": 3,
        "final_time": final_time,
        "converged": converged,
        "iterations": int(solution.niter),
        "residual": residual,
        "seconds": seconds,
    }
    return row, status


def _straight_line(problem: TransferProblem, duration: float, s: np.ndarray) -> np.ndarray:
    """States (5, n) on a straight line between the two orbits, at fractions s (n,) of the time."""
    start = problem.initial_state
    end = np.array(
        [
            problem.final_radius,
            duration * problem.final_speed / problem.final_radius,
            0.0,
            problem.final_speed,
            problem.final_mass(duration),
        ]
    )
    return start[:, None] + (end - start)[:, None] * s


def _collocated_history(
    mesh: Collocation, controls: np.ndarray, final_time: float
) -> ControlHistory:
    times = np.linspace(0.0, final_time, mesh.intervals + 1)
    interpolators = []
    for k, values in enumerate(controls):
        polynomial = BarycentricInterpolator(mesh.nodes, np.unwrap(values))
        interpolators.append(
            lambda t, polynomial=polynomial, k=k: polynomial(
                (t - times[k]) / (times[k + 1] - times[k])
            )
        )
    return ControlHistory(times, interpolators)
