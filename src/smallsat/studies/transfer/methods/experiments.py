"""The runs of the study: which cases, from which start, with which settings, and their check.

Every run returns a table of cases, a table of flown trajectories, and the cases that no start of
ours solved. ``residual`` is the largest error of the conditions at the end, in canonical units,
when the solution is flown anew by LSODA from the initial orbit; infinite where none was flown.

What is the document's own (`as_published`) runs in the configuration's units, everything else in
canonical ones.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.nonlinear_program import (
    IpoptSolver,
    SlsqpSolver,
    Solution,
    StoppingRule,
)
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.bounds import (
    Bounds,
    Interval,
    near_bounds,
    relative_length,
    wide_bounds,
)
from smallsat.studies.transfer.methods.direct import (
    Basis,
    Case,
    control_history,
    fitted_guess,
    largest_coefficient,
    program_numbers,
    published_guess,
    shooting_program,
)
from smallsat.studies.transfer.methods.extremals import (
    FINE,
    PUBLISHED_GUESS,
    Found,
    enough_steps,
    find_extremals,
)
from smallsat.studies.transfer.methods.indirect import condition_error, propagate_extremal
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import (
    COLUMNS,
    boundary_error,
    error_magnitude,
    propagate,
)
from smallsat.studies.transfer.model.units import Units, canonical, units_of

Row = dict[str, Any]
# What was tried, its solution, and columns of its row beside the usual ones.
Try = tuple[str, Solution, Row]

# Rows of a trajectory over the whole flight, shared among its intervals.
SAMPLES = 480

LABEL = ("method", "run", "degree", "intervals")
TYPES = {"method": str, "run": str, "degree": int, "intervals": int, "segment": int}
NO_EXTREMAL = "no extremal to start from"
# Random starts beyond those asked for, where none of these converged.
FURTHER_STARTS = 40
# Solutions of random starts that are tried again with fine steps.
WINNERS = 5
# How many times more steps a solution gets that another integrator does not confirm.
FINER = 4
# A run that meets its stopping rule may miss the end by so many times the rule's constraint error
# when it is flown through: the errors at the interval ends add up and grow on the way.
FLOWN = 10.0


@dataclass(frozen=True)
class Solved:
    """Tables of an experiment.

    Attributes
    ----------
    cases
        One row a case; what is not solved has no final time and an infinite residual.
    trajectories
        Trajectories of the cases that were flown.
    not_converged
        Cases that no start of ours solved.
    """

    cases: pd.DataFrame
    trajectories: pd.DataFrame
    not_converged: list[NotConverged]

    def tables(self, name: str) -> dict[str, pd.DataFrame]:
        """Cases and trajectories by file name; seconds apart, which differ from build to build."""
        return {
            f"{name}.csv": self.cases.drop(columns="seconds"),
            f"{name}.parquet": self.trajectories,
            f"{name}-seconds.csv": self.cases[[*LABEL, "seconds"]],
        }


def indirect(section: Configuration) -> Solved:
    """Indirect shooting and indirect multiple shooting (Tables 1 and 2)."""
    problem, units = _canonical(section)
    found = find_extremals(
        problem,
        units,
        (1, *section.intervals),
        section.guess,
        section.numerics.steps.indirect,
    )
    rows, frames, missing = [], [], []
    for intervals, result in found.items():
        row = {
            "method": "indirect",
            "run": "as published",
            "degree": 0,
            "intervals": intervals,
            "unknowns": 10 * intervals - 4,
            "final_time": np.nan,
            "final_mass": np.nan,
            "converged": False,
            "status": "",
            "iterations": np.nan,
            "residual": np.inf,
            "seconds": np.nan,
        }
        if isinstance(result, Found):
            extremal = result.extremal
            final, table = propagate_extremal(problem, extremal, SAMPLES // intervals + 1)
            by_continuation = "" if result.start == PUBLISHED_GUESS else f", by {result.start}"
            row |= {
                "final_time": extremal.final_time * units.time,
                "final_mass": final[4] * units.mass,
                "converged": True,
                "status": f"residual vanished{by_continuation}",
                "iterations": extremal.iterations,
                "residual": condition_error(problem, final),
                "seconds": extremal.seconds,
            }
            frames.append(_labelled(_in_units(table, units), row))
        else:
            row["status"] = result.status
            missing.append(result)
        rows.append(row)
    empty = [*LABEL, *COLUMNS, *COSTATES, "hamiltonian"]
    return Solved(pd.DataFrame(rows), _joined(frames, empty), missing)


def as_published(section: Configuration, intervals: int) -> tuple[Solved, pd.DataFrame]:
    """Direct shooting from the document's guess, in its basis and bounds, by an SQP method.

    Each run stops where the document's solver does. One that ends elsewhere, or whose flight by
    another integrator misses the end, has not converged: it keeps its row and says how it ended,
    but has neither final time nor trajectory. It is no case that we could not solve.

    Returns
    -------
    solved
        One row a degree.
    path
        One row an iterate: degree, intervals, iteration, final_time, violation, optimality.
    """
    problem = TransferProblem.of(section.problem)
    units = units_of(problem)
    numerics, bounds, stop = section.numerics, section.bounds, section.numerics.stop
    multiple = intervals > 1
    rule = StoppingRule(
        stop.optimality_multiple if multiple else stop.optimality_single, stop.feasibility
    )
    rows, frames, paths = [], [], []
    for degree in section.degrees:
        case = Case(degree, intervals, "global")
        program = shooting_program(
            problem,
            case,
            numerics.steps.as_published,
            coefficient_bounds=bounds.coefficient,
            state_bounds=bounds.interior_state,
            time_bounds=bounds.final_time_multiple if multiple else bounds.final_time_single,
        )
        numbers = program_numbers(problem, case, numerics.steps.as_published)
        solution = SlsqpSolver(program, numbers).solve_until(
            published_guess(case, section.guess), rule, numerics.as_published_tolerance
        )
        paths.append(_path(case, solution))
        history = control_history(case, solution.variables)
        final, table = propagate(problem, history, _share(case))
        errors = np.array(problem.terminal_error(final)) / units.state[[0, 2, 3]]
        residual = error_magnitude(errors)
        if solution.converged and residual <= FLOWN * stop.feasibility:
            row = _direct_row("as published", case, solution)
            row |= {"final_mass": final[4], "residual": residual}
            frames.append(_labelled(table, row))
        else:
            ended = f"{solution.status}, t_f = {solution.objective:.6g}, error {residual:.1e}"
            row = _missing_row("as published", case, ended)
        rows.append(row)
    solved = Solved(pd.DataFrame(rows), _joined(frames, [*LABEL, *COLUMNS]), [])
    return solved, pd.concat(paths, ignore_index=True)


def converged(section: Configuration) -> Solved:
    """The document's direct multiple shooting, within its coefficient bounds, solved by IPOPT."""
    bounds = section.bounds.coefficient
    return _near_extremal(section, "converged", section.intervals, coefficients=bounds)


def unbounded(section: Configuration) -> Solved:
    """The same without bounds on the coefficients, in a local basis."""
    return _near_extremal(section, "unbounded", section.intervals)


def continuous(section: Configuration) -> Solved:
    """The same with a control that is continuous at the interval ends (the future work)."""
    return _near_extremal(section, "continuous", section.intervals, continuous=True)


def tighter_bounds(section: Configuration) -> Solved:
    """The cases with most intervals within tighter bounds, as before the document opened them.

    The document does not print these bounds, so that a case without a solution is none that we
    could not solve.
    """
    solved = [
        _near_extremal(
            section, f"bounds {bound:g}", [max(section.intervals)], coefficients=(-bound, bound)
        )
        for bound in section.numerics.tighter_bounds
    ]
    cases = pd.concat([one.cases for one in solved], ignore_index=True)
    return Solved(cases, pd.concat([one.trajectories for one in solved], ignore_index=True), [])


def multistart(section: Configuration) -> tuple[Solved, pd.DataFrame]:
    """Best single polynomial of each degree over many random starts.

    Returns
    -------
    solved
        The best solution of each degree, solved once more with fine steps.
    starts
        One row a start: degree, start, final_time, converged.
    """
    problem, units = _canonical(section)
    numerics = section.numerics
    extremal = extremal_table(section)
    seeds = np.random.SeedSequence(numerics.seed).spawn(len(section.degrees))
    starts: list[Row] = []
    attempts = []
    for degree, seed in zip(section.degrees, seeds, strict=True):
        case = Case(degree, 1, "local")
        if isinstance(extremal, NotConverged):
            attempts.append(_not_started(case, "converged", extremal))
            continue
        final_time = float(extremal["t"].iloc[-1])
        bounds: dict[str, Any] = {
            "coefficient_bounds": section.bounds.coefficient,
            "time_bounds": (0.0, 0.9 * problem.longest_time),
        }
        steps = {
            name: enough_steps(numerics.steps[name], problem, final_time)
            for name in ("as_published", "converged")
        }
        coarse = SlsqpSolver(
            shooting_program(problem, case, steps["as_published"], **bounds),
            program_numbers(problem, case, steps["as_published"]),
        )
        found: list[Solution] = []
        asked = numerics.multistart
        for start in range(asked + FURTHER_STARTS):
            if start >= asked and found:
                break
            (child,) = seed.spawn(1)
            guess = _random_guess(case, final_time, np.random.default_rng(child))
            solution = coarse.solve(guess, 1e-8, 200)
            good = solution.converged and solution.violation < 1e-8
            # A control too wild for the fixed steps shows in a flight with an adaptive method.
            if good:
                final, _ = propagate(problem, control_history(case, solution.variables))
                good = boundary_error(problem, final) < 1e-5
            starts.append(
                {
                    "degree": degree,
                    "start": start,
                    "final_time": solution.objective * units.time,
                    "converged": good,
                }
            )
            if good:
                found.append(solution)
        winners = sorted(found, key=lambda one: one.objective)[:WINNERS]
        tries = _polished(problem, case, winners, steps["converged"], bounds)
        nothing = "" if found else f"{asked + FURTHER_STARTS} random starts: none converged"
        attempts.append(_first_converged(problem, case, "converged", tries, nothing))
    columns = ["degree", "start", "final_time", "converged"]
    return _collect(units, attempts), pd.DataFrame(starts, columns=columns)


def extremal_table(section: Configuration) -> pd.DataFrame | NotConverged:
    """The extremal of single shooting as a table of `propagate_extremal`, in canonical units."""
    problem, units = _canonical(section)
    steps = section.numerics.steps.indirect
    result = find_extremals(problem, units, (1,), section.guess, steps)[1]
    if isinstance(result, NotConverged):
        return result
    return propagate_extremal(problem, result.extremal, SAMPLES + 1)[1]


@dataclass(frozen=True)
class _Attempted:
    row: Row
    trajectory: pd.DataFrame
    not_converged: NotConverged | None = None


def _near_extremal(
    section: Configuration,
    run: str,
    intervals: Sequence[int],
    *,
    coefficients: Interval | None = None,
    continuous: bool = False,
) -> Solved:
    problem, units = _canonical(section)
    extremal = extremal_table(section)
    # Bounds are those of the document's basis; without them the better conditioned one is taken.
    basis: Basis = "global" if coefficients else "local"
    steps = section.numerics.steps.converged
    return _collect(
        units,
        [
            _not_started(case, run, extremal)
            if isinstance(extremal, NotConverged)
            else _first_converged(
                problem,
                case,
                run,
                _tries(problem, case, extremal, steps, continuous, coefficients),
                "",
            )
            for case in (Case(n, k, basis) for n in section.degrees for k in intervals)
        ],
    )


def _tries(
    problem: TransferProblem,
    case: Case,
    extremal: pd.DataFrame,
    steps: int,
    continuous: bool,
    coefficients: Interval | None,
) -> Iterator[Try]:
    """Solutions from the extremal: near it, farther off, with finer steps."""
    guess = fitted_guess(case, extremal, coefficients or (-np.inf, np.inf))
    steps = enough_steps(steps, problem, float(extremal["t"].iloc[-1]))
    near = near_bounds(case, guess, extremal, coefficients)
    wide = wide_bounds(case, problem, coefficients)
    ways: tuple[tuple[str, Bounds, int, Row], ...] = (
        ("near the extremal", near, steps, {"mu_init": 1e-4}),
        ("in wide bounds", wide, steps, {}),
        ("near the extremal with finer steps", near, FINER * steps, {"mu_init": 1e-4}),
    )
    for name, (lower, upper), count, options in ways:
        program = shooting_program(problem, case, count, continuous=continuous)
        program.lower[:], program.upper[:] = lower, upper
        solution = IpoptSolver(program, **options).solve(guess)
        z = solution.variables
        slack = np.minimum(z - lower, upper - z)
        if coefficients:
            # Only the bounds of ours must stay inactive.
            interior, _, final_time = case.split(slack)
            slack = np.append(interior, final_time)
        yield name, solution, {"bound_slack": float(slack.min())}


def _polished(
    problem: TransferProblem, case: Case, winners: list[Solution], steps: int, bounds: Row
) -> Iterator[Try]:
    """Solutions of random starts, best first, solved once more with fine steps, then finer ones."""
    for count in (steps, FINER * steps):
        program = shooting_program(problem, case, count, **bounds)
        solver = IpoptSolver(program, mu_init=1e-6)
        for place, one in enumerate(winners):
            yield f"random start {place + 1}, {count} steps", solver.solve(one.variables), {}


def _first_converged(
    problem: TransferProblem,
    case: Case,
    run: str,
    tries: Iterable[Try],
    nothing: str,
) -> _Attempted:
    """The first solution that converged and meets the end when flown by another integrator."""
    tried, residual = [nothing] if nothing else [], np.inf
    for name, solution, columns in tries:
        final, table = propagate(problem, control_history(case, solution.variables), _share(case))
        residual = boundary_error(problem, final)
        if solution.converged and residual < FINE:
            row = _direct_row(run, case, solution) | columns
            row |= {"final_mass": final[4], "residual": residual}
            row |= {"largest_coefficient": largest_coefficient(case, solution.variables)}
            return _Attempted(row, _labelled(table, row))
        tried.append(f"{name}: {solution.status}, error at the end {residual:.1e}")
    return _Attempted(
        _missing_row(run, case, tried[-1]),
        pd.DataFrame(),
        NotConverged(_name(run, case), tried[-1], residual, "; ".join(tried)),
    )


def _not_started(case: Case, run: str, extremal: NotConverged) -> _Attempted:
    return _Attempted(
        _missing_row(run, case, NO_EXTREMAL),
        pd.DataFrame(),
        NotConverged(_name(run, case), NO_EXTREMAL, np.inf, extremal.tried),
    )


def _collect(units: Units, attempts: Iterable[_Attempted]) -> Solved:
    rows, frames, missing = [], [], []
    for one in attempts:
        scale = {"final_time": units.time, "final_mass": units.mass}
        rows.append(one.row | {name: one.row[name] * unit for name, unit in scale.items()})
        if one.not_converged:
            missing.append(one.not_converged)
        else:
            frames.append(_in_units(one.trajectory, units))
    return Solved(pd.DataFrame(rows), _joined(frames, [*LABEL, *COLUMNS]), missing)


def _canonical(section: Configuration) -> tuple[TransferProblem, Units]:
    problem = TransferProblem.of(section.problem)
    return canonical(problem), units_of(problem)


def _in_units(table: pd.DataFrame, units: Units) -> pd.DataFrame:
    """A trajectory in canonical units as one in the configuration's."""
    scales = dict(zip(STATES, units.state, strict=True))
    scales |= dict(zip(COSTATES, units.costate, strict=True))
    scales |= {"t": units.time, "hamiltonian": units.mass / units.time}
    return table.assign(**{n: table[n] * unit for n, unit in scales.items() if n in table})


def _joined(frames: list[pd.DataFrame], columns: Iterable[str]) -> pd.DataFrame:
    flown = [frame for frame in frames if len(frame)]
    if flown:
        return pd.concat(flown, ignore_index=True)
    return pd.DataFrame({name: pd.Series(dtype=TYPES.get(name, float)) for name in columns})


def _name(run: str, case: Case) -> str:
    method = "direct shooting" if case.intervals == 1 else "direct multiple shooting"
    return f"{method}, {run}, N = {case.degree}, K = {case.intervals}"


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


def _path(case: Case, solution: Solution) -> pd.DataFrame:
    path = pd.DataFrame(solution.path, columns=["final_time", "violation", "optimality"])
    path.insert(0, "iteration", np.arange(1, len(path) + 1))
    path.insert(0, "intervals", case.intervals)
    path.insert(0, "degree", case.degree)
    return path


def _missing_row(run: str, case: Case, status: str) -> Row:
    nothing = Solution(np.empty(0), np.nan, False, status, 0, np.inf, np.nan)
    return _direct_row(run, case, nothing) | {"iterations": np.nan, "residual": np.inf}


def _labelled(table: pd.DataFrame, row: Row) -> pd.DataFrame:
    return table.assign(**{name: row[name] for name in LABEL})[[*LABEL, *table.columns]]


def _share(case: Case) -> int:
    return SAMPLES // case.intervals + 1


def _random_guess(case: Case, final_time: float, random: np.random.Generator) -> np.ndarray:
    # Angles of a few radians at the interval's ends, and a flight of plausible length: for the
    # document's transfer, of 3 to 6 time units.
    coefficients = random.normal(0.0, 3.0, case.degree + 1)
    scale = relative_length(final_time)
    return np.concatenate([coefficients, [random.uniform(3.0 * scale, 6.0 * scale)]])
