"""From how far off each method still finds the optimum: starts that are off in all unknowns.

A start is the optimum plus noise. Each unknown is off by up to a share, the spread, of the largest
magnitude that its quantity has along the optimum; each method has the unknowns that it takes, and
draws all of them independently. The same sample is drawn nearer and farther off.
"""

from collections.abc import Callable

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.collocation import Collocation, collocation_guess
from smallsat.optimal_control.nonlinear_program import UNPERMUTED, IpoptSolver
from smallsat.statistics.random_streams import stream
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.collocation import extremal_guess, transcription
from smallsat.studies.transfer.methods.experiments import extremal_table
from smallsat.studies.transfer.methods.extremals import SAME_TIME, enough_steps
from smallsat.studies.transfer.methods.indirect import (
    ConvergenceError,
    equal_steps,
    solve_extremal,
)
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem
from smallsat.studies.transfer.model.units import canonical

# What a start ends at: a final time (canonical), or not a number.
Shoot = Callable[[np.ndarray], float]

COLUMNS = ["method", "unknowns", "spread", "start", "final_time"]

SPREADS = (0.25, 0.5, 1.0, 2.0)
# Numbers of intervals of indirect shooting, and the mesh of direct collocation, whose own error is
# below the difference at which two final times are two.
INTERVALS = (1, 4)
MESH = Collocation(20, 4, "legendre")
# Iterations of the interior-point method: from the extremal it takes five.
MOST_ITERATIONS = 50


def basin(section: Configuration) -> pd.DataFrame:
    """Where random starts end.

    Returns
    -------
    DataFrame
        Columns method, unknowns, spread, start, and final_time as a share of the optimum, not a
        number where nothing was found. Without rows where there is no optimum.
    """
    problem = canonical(TransferProblem.of(section.problem))
    extremal = extremal_table(section)
    if isinstance(extremal, NotConverged):
        return pd.DataFrame(columns=COLUMNS)
    optimum = float(extremal["t"].iloc[-1])
    numerics = section.numerics
    steps = enough_steps(numerics.steps.indirect, problem, optimum)
    methods: list[tuple[str, np.ndarray, np.ndarray, Shoot]] = [
        *(_shooting(problem, extremal, count, steps) for count in INTERVALS),
        _collocation(problem, extremal),
    ]
    rows = []
    for name, best, magnitude, end in methods:
        for start in range(numerics.basin):
            noise = magnitude * stream(numerics.seed, start).uniform(-1.0, 1.0, len(best))
            rows += [
                (name, len(best), spread, start, end(best + spread * noise) / optimum)
                for spread in SPREADS
            ]
    return pd.DataFrame(rows, columns=COLUMNS)


def shares(table: pd.DataFrame) -> pd.DataFrame:
    """Share of the starts that end at the optimum, with Wilson's interval of 95 %.

    Parameters
    ----------
    table
        Of `basin`.

    Returns
    -------
    DataFrame
        Columns method, unknowns, spread, starts, optimum, low, high, elsewhere: shares of the
        starts, the last of those that end at another final time.
    """
    rows = []
    for key, group in table.groupby(["method", "unknowns", "spread"], sort=False):
        there = (group["final_time"] - 1.0).abs() <= SAME_TIME
        elsewhere = float((group["final_time"].notna() & ~there).mean())
        test = binomtest(int(there.sum()), len(group))
        interval = test.proportion_ci(method="wilson")
        rows.append((*key, len(group), test.statistic, interval.low, interval.high, elsewhere))
    columns = ["method", "unknowns", "spread", "starts", "optimum", "low", "high", "elsewhere"]
    return pd.DataFrame(rows, columns=columns)


def _shooting(
    problem: TransferProblem, extremal: pd.DataFrame, intervals: int, steps: int
) -> tuple[str, np.ndarray, np.ndarray, Shoot]:
    names = [*STATES, *COSTATES]
    final_time = float(extremal["t"].iloc[-1])
    times = np.linspace(0.0, final_time, intervals, endpoint=False)
    nodes = np.array([np.interp(times, extremal["t"], extremal[name]) for name in names]).T
    magnitude = np.tile(extremal[names].abs().max(), intervals)
    lengths = equal_steps(intervals, steps)

    def end(start: np.ndarray) -> float:
        try:
            # A flight that overflows is one that leads nowhere.
            with np.errstate(all="ignore"):
                return solve_extremal(problem, intervals, start, lengths).final_time
        except ConvergenceError:
            return float("nan")

    # The state at the start is known.
    best, scale = (np.append(all_of[5:], final_time) for all_of in (nodes.ravel(), magnitude))
    name = "indirect shooting" if intervals == 1 else f"indirect shooting, K = {intervals}"
    return name, best, scale, end


def _collocation(
    problem: TransferProblem, extremal: pd.DataFrame
) -> tuple[str, np.ndarray, np.ndarray, Shoot]:
    final_time = float(extremal["t"].iloc[-1])
    largest = extremal[list(STATES)].abs().max().to_numpy()
    angle = float(np.abs(np.unwrap(extremal["beta"])).max())
    magnitude = collocation_guess(MESH, final_time, lambda _: largest, lambda _: angle)
    program = transcription(problem, MESH, (0.0, problem.longest_time))
    solver = IpoptSolver(program, max_iter=MOST_ITERATIONS, **UNPERMUTED)

    def end(start: np.ndarray) -> float:
        solution = solver.solve(start)
        return solution.objective if solution.converged else float("nan")

    name = f"direct collocation, K = {MESH.intervals}"
    return name, extremal_guess(extremal, MESH), magnitude, end
