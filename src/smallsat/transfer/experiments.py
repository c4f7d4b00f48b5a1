"""The runs of the study: which cases, from which start, with which settings, and their check.

Every run returns a table of cases and a table of flown trajectories. ``residual`` is the largest
error of the conditions at the end when the solution is flown anew by LSODA from the initial orbit.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from smallsat.optimal_control.nonlinear_program import IpoptSolver, SlsqpSolver, Solution
from smallsat.transfer.direct import (
    Case,
    control_history,
    fitted_guess,
    published_guess,
    shooting_program,
)
from smallsat.transfer.indirect import condition_error, fly_extremal, solve_extremal
from smallsat.transfer.problem import TransferProblem
from smallsat.transfer.trajectory import boundary_error, fly

Config = dict[str, Any]
Row = dict[str, Any]
Tables = tuple[pd.DataFrame, pd.DataFrame]

# Rows of a trajectory over the whole flight, shared among its intervals.
SAMPLES = 480

# Bounds of the converged runs, wide of every solution: they keep IPOPT's first steps from
# controls so wild that fixed steps cannot follow them, and none of them is active at the end.
STATE_BOUNDS = ((0.0, 4.0), (0.0, 4.0), (-1.0, 4.0), (0.0, 4.0), (0.0, 4.0))
COEFFICIENT_BOUNDS = (-12.0, 12.0)
TIME_BOUNDS = (3.0, 4.0)


def indirect(config: Config) -> Tables:
    """Indirect shooting and indirect multiple shooting (Tables 1 and 2)."""
    problem = TransferProblem.from_config(config)
    rows, frames = [], []
    for intervals in (1, *config["intervals"]):
        extremal = solve_extremal(
            problem, intervals, config["guess"], config["numerics"]["steps"]["indirect"]
        )
        final, table = fly_extremal(problem, extremal, SAMPLES // intervals + 1)
        row = {
            "method": "indirect",
            "run": "as published",
            "degree": 0,
            "intervals": intervals,
            "unknowns": 10 * intervals - 4,
            "final_time": extremal.final_time,
            "final_mass": final[4],
            "converged": True,
            "status": "residual vanished",
            "iterations": extremal.iterations,
            "residual": condition_error(problem, final),
            "seconds": extremal.seconds,
        }
        rows.append(row)
        frames.append(_labelled(table, row))
    return pd.DataFrame(rows), pd.concat(frames, ignore_index=True)


def as_published(config: Config, intervals: int) -> Tables:
    """Direct shooting from the document's guess, in its basis and bounds, by an SQP method.

    Each case is also stopped early, at the looser tolerances of the configuration; only the run at
    ``as_published_tolerance`` keeps its trajectory.
    """
    problem = TransferProblem.from_config(config)
    numerics, bounds = config["numerics"], config["bounds"]
    strict = numerics["as_published_tolerance"]
    multiple = intervals > 1
    rows, frames = [], []
    for degree in config["degrees"]:
        case = Case(degree, intervals, "global")
        program = shooting_program(
            problem,
            case,
            numerics["steps"]["as_published"],
            coefficient_bounds=tuple(bounds["coefficient"]),
            state_bounds=tuple(bounds["interior_state"]),
            time_bounds=tuple(bounds["final_time_multiple" if multiple else "final_time_single"]),
        )
        solver = SlsqpSolver(program)
        guess = published_guess(case, config["guess"])
        for tolerance in (strict, *numerics["early_stopping_tolerances"]):
            solution = solver.solve(guess, tolerance)
            row = _direct_row("as published", case, solution) | {"tolerance": tolerance}
            if tolerance == strict:
                final, table = fly(problem, control_history(case, solution.variables), _share(case))
                row |= _flown(problem, final)
                frames.append(_labelled(table, row))
            rows.append(row)
    return pd.DataFrame(rows), pd.concat(frames, ignore_index=True)


def converged(config: Config) -> Tables:
    """Direct multiple shooting in a local basis, started from the indirect solution, by IPOPT."""
    problem = TransferProblem.from_config(config)
    extremal = _extremal_table(problem, config)
    cases = [Case(n, k, "local") for n in config["degrees"] for k in config["intervals"]]
    return _collect(
        problem, (_solve_near(problem, case, extremal, config, "converged") for case in cases)
    )


def continuous(config: Config) -> Tables:
    """The same with a control that is continuous at the interval ends (the future work)."""
    problem = TransferProblem.from_config(config)
    extremal = _extremal_table(problem, config)
    cases = [Case(n, k, "local") for n in config["degrees"] for k in config["intervals"]]
    return _collect(
        problem,
        (
            _solve_near(problem, case, extremal, config, "continuous", continuous=True)
            for case in cases
        ),
    )


def multistart(config: Config) -> tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]:
    """Best single polynomial of each degree over many random starts.

    Returns
    -------
    cases, trajectories
        The best solution of each degree, solved once more with fine steps.
    starts
        One row a start: degree, start, final_time, converged.
    """
    problem = TransferProblem.from_config(config)
    numerics = config["numerics"]
    starts: list[Row] = []
    best: list[tuple[Case, Solution]] = []
    for degree, seed in zip(
        config["degrees"],
        np.random.SeedSequence(numerics["seed"]).spawn(len(config["degrees"])),
        strict=True,
    ):
        case = Case(degree, 1, "local")
        bounds: dict[str, Any] = {
            "coefficient_bounds": tuple(config["bounds"]["coefficient"]),
            "time_bounds": (0.0, 0.9 * problem.longest_time),
        }
        coarse = SlsqpSolver(
            shooting_program(problem, case, numerics["steps"]["as_published"], **bounds),
            expand=True,
        )
        found = []
        for start, child in enumerate(seed.spawn(numerics["multistart"])):
            solution = coarse.solve(_random_guess(case, np.random.default_rng(child)), 1e-8, 200)
            good = solution.converged and solution.violation < 1e-8
            # A control too wild for the fixed steps shows in a flight with an adaptive method.
            if good:
                final, _ = fly(problem, control_history(case, solution.variables))
                good = boundary_error(problem, final) < 1e-5
            starts.append(
                {
                    "degree": degree,
                    "start": start,
                    "final_time": solution.objective,
                    "converged": good,
                }
            )
            if good:
                found.append(solution)
        winner = min(found, key=lambda solution: solution.objective)
        fine = IpoptSolver(
            shooting_program(problem, case, numerics["steps"]["converged"], **bounds),
            mu_init=1e-6,
        )
        best.append((case, fine.solve(winner.variables)))
    rows = ((_direct_row("converged", case, solution), case, solution) for case, solution in best)
    cases, trajectories = _collect(problem, rows)
    return cases, trajectories, pd.DataFrame(starts)


def _solve_near(
    problem: TransferProblem,
    case: Case,
    extremal: pd.DataFrame,
    config: Config,
    run: str,
    *,
    continuous: bool = False,
) -> tuple[Row, Case, Solution]:
    program = shooting_program(
        problem,
        case,
        config["numerics"]["steps"]["converged"],
        coefficient_bounds=COEFFICIENT_BOUNDS,
        time_bounds=TIME_BOUNDS,
        continuous=continuous,
    )
    interior = 5 * (case.intervals - 1)
    program.lower[:interior] = np.tile([low for low, _ in STATE_BOUNDS], case.intervals - 1)
    program.upper[:interior] = np.tile([high for _, high in STATE_BOUNDS], case.intervals - 1)
    solver = IpoptSolver(program, mu_init=1e-4)
    solution = solver.solve(fitted_guess(case, extremal))
    slack = np.minimum(solution.variables - program.lower, program.upper - solution.variables).min()
    row = _direct_row(run, case, solution) | {"bound_slack": float(slack)}
    return row, case, solution


def _collect(problem: TransferProblem, solved: Iterator[tuple[Row, Case, Solution]]) -> Tables:
    rows, frames = [], []
    for row, case, solution in solved:
        final, table = fly(problem, control_history(case, solution.variables), _share(case))
        row |= _flown(problem, final)
        rows.append(row)
        frames.append(_labelled(table, row))
    return pd.DataFrame(rows), pd.concat(frames, ignore_index=True)


def _extremal_table(problem: TransferProblem, config: Config) -> pd.DataFrame:
    extremal = solve_extremal(problem, 1, config["guess"], config["numerics"]["steps"]["indirect"])
    return fly_extremal(problem, extremal, SAMPLES + 1)[1]


def _direct_row(run: str, case: Case, solution: Solution) -> Row:
    return {
        "method": "direct",
        "run": run,
        "degree": case.degree,
        "intervals": case.intervals,
        "unknowns": case.size,
        "final_time": solution.objective,
        "final_mass": np.nan,
        "converged": solution.converged,
        "status": solution.status,
        "iterations": solution.iterations,
        "residual": np.nan,
        "seconds": solution.seconds,
    }


def _flown(problem: TransferProblem, final: np.ndarray) -> Row:
    return {"final_mass": final[4], "residual": boundary_error(problem, final)}


def _labelled(table: pd.DataFrame, row: Row) -> pd.DataFrame:
    label = {name: row[name] for name in ("method", "run", "degree", "intervals")}
    return table.assign(**label)[[*label, *table.columns]]


def _share(case: Case) -> int:
    return SAMPLES // case.intervals + 1


def _random_guess(case: Case, random: np.random.Generator) -> np.ndarray:
    # Angles of a few radians at the interval's ends, and a flight of plausible length.
    coefficients = random.normal(0.0, 3.0, case.degree + 1)
    return np.concatenate([coefficients, [random.uniform(3.0, 6.0)]])
