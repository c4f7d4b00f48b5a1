"""How fast the transfer cases are solved, beside a plain SciPy port of the document's listings.

The port integrates each interval with an adaptive method at the document's tolerance, lets SLSQP
take finite differences, and starts where the document starts. Both run in this process, one after
the other, so the ratios hold on any machine.
"""

import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize

from smallsat.config import default_config
from smallsat.optimal_control.nonlinear_program import SlsqpSolver
from smallsat.studies.transfer.methods import experiments
from smallsat.studies.transfer.methods.direct import (
    Case,
    interval_ends,
    published_guess,
    shooting_program,
)
from smallsat.studies.transfer.model.problem import TransferProblem

ROOT = Path(__file__).parents[1]
# Cases that the port solves in reasonable time.
CASES = ((2, 1), (4, 1), (6, 1), (2, 2), (4, 2), (2, 4))
TOLERANCE = 1e-6


def port_of_the_listing(problem: TransferProblem, case: Case, guess: np.ndarray, bounds: list):
    """Listings 6 to 11 in plain SciPy: nothing compiled, no derivatives."""

    def errors(z: np.ndarray) -> np.ndarray:
        interior, coefficients, final_time = case.split(z)
        nodes = np.concatenate([problem.initial_state, interior]).reshape(-1, 5)
        rows = np.reshape(coefficients, (case.intervals, -1))
        found = []
        for k, row in enumerate(rows):

            def rate(tau: float, x: np.ndarray, row: np.ndarray = row) -> np.ndarray:
                beta = np.polyval(row, tau)
                return final_time / 2 * np.array(problem.state_rate(x, np.sin(beta), np.cos(beta)))

            end = solve_ivp(rate, interval_ends(case, k), nodes[k], method="LSODA", rtol=1e-6)
            state = end.y[:, -1]
            if k < case.intervals - 1:
                found.append(state - nodes[k + 1])
            else:
                found.append(np.array(problem.terminal_error(state)))
        return np.concatenate(found)

    return minimize(
        lambda z: z[-1],
        guess,
        bounds=bounds,
        constraints={"type": "eq", "fun": errors},
        method="SLSQP",
        options={"ftol": TOLERANCE, "maxiter": 1000},
    )


def measure() -> dict[str, float]:
    """Seconds and ratios; every ratio is port over ours in this same run."""
    section = default_config(ROOT).transfer
    problem = TransferProblem.of(section.problem)
    ours = port = 0.0
    for degree, intervals in CASES:
        case = Case(degree, intervals, "global")
        limits = section.bounds
        program = shooting_program(
            problem,
            case,
            section.numerics.steps.as_published,
            coefficient_bounds=limits.coefficient,
            state_bounds=limits.interior_state,
            time_bounds=limits.final_time_multiple,
        )
        guess = published_guess(case, section.guess)
        began = time.perf_counter()
        SlsqpSolver(program).solve(guess, TOLERANCE)
        ours += time.perf_counter() - began
        began = time.perf_counter()
        port_of_the_listing(
            problem, case, guess, list(zip(program.lower, program.upper, strict=True))
        )
        port += time.perf_counter() - began
    converged = experiments.converged(section).cases
    return {
        "as published, six cases: port / ours": port / ours,
        "20 converged solves (s; goal 3, the document 729)": float(converged["seconds"].sum()),
    }


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name}: {value:.3g}")
