"""The document's future work: direct and indirect collocation, beside what it did."""

import time
import warnings
from typing import Any

import casadi as ca
import numpy as np
import pandas as pd
from scipy.integrate import solve_bvp
from scipy.interpolate import BarycentricInterpolator

from smallsat.optimal_control.collocation import (
    Collocation,
    collocation_control,
    collocation_guess,
    collocation_program,
)
from smallsat.optimal_control.nonlinear_program import IpoptSolver
from smallsat.transfer.indirect import Extremal, condition_error, fly_extremal
from smallsat.transfer.problem import STATES, TransferProblem
from smallsat.transfer.trajectory import ControlHistory, boundary_error, fly

MESHES = (
    Collocation(20, 3, "radau"),
    Collocation(80, 3, "radau"),
    Collocation(40, 4, "legendre"),
    Collocation(80, 4, "legendre"),
)


# A rough guess that knows nothing of the solution but a plausible duration.
GUESS_TIME = 3.3


def _straight_line(problem: TransferProblem, s: np.ndarray) -> np.ndarray:
    """States (5, n) on a straight line between the two orbits, at fractions s (n,) of the time."""
    start = problem.initial_state
    end = np.array(
        [
            problem.final_radius,
            GUESS_TIME * problem.final_speed / problem.final_radius,
            0.0,
            problem.final_speed,
            problem.final_mass(GUESS_TIME),
        ]
    )
    return start[:, None] + (end - start)[:, None] * s


def direct_collocation(problem: TransferProblem) -> pd.DataFrame:
    """Direct collocation on several meshes, each flown anew with its interpolated control.

    The guess is a straight line of states and a thrust angle that turns once.
    """
    rows = []
    for mesh in MESHES:

        def rate(x: Any, u: Any) -> list[Any]:
            return problem.state_rate(x, ca.sin(u), ca.cos(u))

        program = collocation_program(
            rate, problem.initial_state, problem.terminal_error, mesh, (3.0, 4.0)
        )
        guess = collocation_guess(
            mesh,
            GUESS_TIME,
            lambda t: _straight_line(problem, np.array([t / GUESS_TIME])).ravel(),
            lambda t: 2 * np.pi * t / GUESS_TIME,
        )
        solution = IpoptSolver(program).solve(guess)
        controls = collocation_control(mesh, len(STATES), solution.variables)
        final, _ = fly(problem, _collocated_history(mesh, controls, solution.objective))
        rows.append(
            {
                "method": f"direct collocation, {mesh.points}",
                "intervals": mesh.intervals,
                "degree": mesh.degree,
                "final_time": solution.objective,
                "converged": solution.converged,
                "iterations": solution.iterations,
                "residual": boundary_error(problem, final),
                "seconds": solution.seconds,
            }
        )
    return pd.DataFrame(rows)


def indirect_collocation(problem: TransferProblem, costate_guess: np.ndarray) -> pd.DataFrame:
    """Indirect collocation of the costate problem with SciPy's solve_bvp.

    Parameters
    ----------
    problem
        The transfer.
    costate_guess
        Costate (5,), constant along the guess.
    """
    s = np.linspace(0.0, 1.0, 41)
    costates = np.repeat(costate_guess[:, None], s.size, axis=1)
    guess = np.vstack([_straight_line(problem, s), costates])

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
        solution = solve_bvp(rate, conditions, s, guess, p=[GUESS_TIME], tol=1e-8, max_nodes=20000)
    seconds = time.perf_counter() - began
    extremal = Extremal(solution.y[:, :1].T, float(solution.p[0]), solution.niter, 0.0, seconds)
    residual = np.nan
    if solution.success:
        residual = condition_error(problem, fly_extremal(problem, extremal, 2)[0])
    row = {
        "method": "indirect collocation, solve_bvp",
        "intervals": solution.x.size - 1,
        "degree": 3,
        "final_time": extremal.final_time,
        "converged": bool(solution.success),
        "iterations": int(solution.niter),
        "residual": residual,
        "seconds": seconds,
    }
    return pd.DataFrame([row])


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
