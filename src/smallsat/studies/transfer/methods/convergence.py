"""How fast the direct transcriptions approach the optimum, as intervals and degrees grow.

Each is solved from the extremal to a tolerance far below the errors that are asked for. The
reference is the extremal of single shooting.
"""

from typing import Literal

import numpy as np
import pandas as pd
from numpy.polynomial import legendre

from smallsat.optimal_control.collocation import Collocation
from smallsat.optimal_control.nonlinear_program import IpoptSolver, Solution
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.bounds import near_bounds, time_bounds
from smallsat.studies.transfer.methods.collocation import extremal_guess, transcription
from smallsat.studies.transfer.methods.direct import Case, fitted_guess, shooting_program
from smallsat.studies.transfer.methods.extremals import Found, enough_steps, find_extremals
from smallsat.studies.transfer.methods.indirect import (
    Extremal,
    equal_steps,
    propagate_extremal,
    solve_extremal,
)
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical, units_of

COLUMNS = ["method", "degree", "intervals", "final_time", "error", "predicted", "reference_error"]
SHOOTING = "direct shooting"

Points = Literal["legendre", "radau"]

# Of the interior-point method. What it leaves of the final time is ten times as much, and a rate is
# read from errors that are ten times larger again.
TOLERANCE = 1e-13
FLOOR = 100 * TOLERANCE

# Degrees of shooting's control and collocation points whose order in the intervals is measured.
INTERVALS = tuple(2**power for power in range(3, 9))
SHOOTING_DEGREES = (0, 1, 2)
MESHES: tuple[tuple[Points, int], ...] = (
    ("legendre", 1),
    ("legendre", 2),
    ("radau", 1),
    ("radau", 2),
)
# Numbers of intervals in which the degree is raised, and how far.
FEW_INTERVALS = (2, 8)
RAISED_DEGREES = range(1, 11)
# As many points as CasADi tabulates, at most.
RAISED_POINTS = range(1, 10)

# Rows of the extremal, and points of a quadrature in an interval, with which the loss is predicted.
SAMPLES, QUADRATURE = 8193, 40


def convergence(section: Configuration) -> pd.DataFrame:
    """Final times of the transcriptions beside the optimum.

    Returns
    -------
    DataFrame
        Columns method, degree (of shooting's control; points of a collocation), intervals,
        final_time (in the configuration's unit), and as shares of the optimum: error (of the final
        time), predicted (what `predicted_loss` says of shooting) and reference_error (by how much
        the optimum changes with half the steps). Without rows where there is no extremal, and not a
        number where a solve did not converge.
    """
    configured = TransferProblem.of(section.problem)
    problem, units = canonical(configured), units_of(configured)
    steps = section.numerics.steps
    found = find_extremals(problem, units, (1,), section.guess, steps.indirect)[1]
    if not isinstance(found, Found):
        return pd.DataFrame(columns=COLUMNS)
    optimum = found.extremal.final_time
    _, table = propagate_extremal(problem, found.extremal, SAMPLES)
    accuracy = _reference_error(problem, found.extremal, steps.indirect)
    fine = enough_steps(steps.converged, problem, optimum)
    cases = [(n, k) for n in SHOOTING_DEGREES for k in INTERVALS]
    cases += [(n, k) for k in FEW_INTERVALS for n in RAISED_DEGREES if (n, k) not in cases]
    meshes = [Collocation(k, d, points) for points, d in MESHES for k in INTERVALS]
    meshes += [Collocation(k, d, "legendre") for k in FEW_INTERVALS for d in RAISED_POINTS]
    rows = []
    for degree, intervals in cases:
        case = Case(degree, intervals, "local")
        solution = shoot(problem, case, table, max(fine, intervals))
        loss = predicted_loss(problem, table, case) / optimum
        rows.append((SHOOTING, degree, intervals, *_times(solution, optimum), loss))
    for mesh in dict.fromkeys(meshes):
        solution = collocate(problem, mesh, table)
        name = collocation_name(mesh.points)
        rows.append((name, mesh.degree, mesh.intervals, *_times(solution, optimum), np.nan))
    result = pd.DataFrame([(*row, accuracy) for row in rows], columns=COLUMNS)
    return result.assign(final_time=result["final_time"] * units.time)


def collocation_name(points: Points) -> str:
    """How the tables name a collocation."""
    return f"collocation, {points}"


def shoot(problem: TransferProblem, case: Case, extremal: pd.DataFrame, steps: int) -> Solution:
    """Direct shooting from the extremal, a table of `propagate_extremal`, without bounds."""
    guess = fitted_guess(case, extremal, (-np.inf, np.inf))
    program = shooting_program(problem, case, steps)
    program.lower[:], program.upper[:] = near_bounds(case, guess, extremal)
    return IpoptSolver(program, mu_init=1e-4, tol=TOLERANCE).solve(guess)


def collocate(problem: TransferProblem, mesh: Collocation, extremal: pd.DataFrame) -> Solution:
    """Direct collocation from the extremal, a table of `propagate_extremal`."""
    program = transcription(problem, mesh, time_bounds(float(extremal["t"].iloc[-1])))
    return IpoptSolver(program, tol=TOLERANCE).solve(extremal_guess(extremal, mesh))


def predicted_loss(problem: TransferProblem, extremal: pd.DataFrame, case: Case) -> float:
    """Time that the best control of a case loses, from the extremal alone, to second order.

    A thrust that is off by d loses T / m |lambda_v| (1 - cos d) of the Hamiltonian, and so half of
    that with d^2 of the final mass for each unit of time; a unit of mass costs v_e / T of time. The
    best control is then the extremal's projection on the polynomials, in each interval with the
    weight |lambda_v| / m. What the state changes by is of higher order: the rest of a projection
    oscillates, and its integral against anything smooth vanishes.

    Parameters
    ----------
    problem, case
        In canonical units.
    extremal
        Table of `propagate_extremal`, with rows so dense that a line joins them.

    Returns
    -------
    float
        Canonical time.
    """
    points, weights = legendre.leggauss(QUADRATURE)
    time = extremal["t"].to_numpy()
    angle = np.unwrap(extremal["beta"])
    worth = np.hypot(extremal["lambda_vr"], extremal["lambda_vtheta"]) / extremal["m"]
    width = time[-1] / case.intervals
    basis = legendre.legvander(points, case.degree)
    loss = 0.0
    for k in range(case.intervals):
        here = (k + (points + 1.0) / 2.0) * width
        root = np.sqrt(np.interp(here, time, worth) * weights * width / 2.0)
        wanted = root * np.interp(here, time, angle)
        fitted = root[:, None] * basis
        rest = wanted - fitted @ np.linalg.lstsq(fitted, wanted, rcond=None)[0]
        loss += float(rest @ rest)
    return problem.exhaust_speed / 2.0 * loss


def theoretical_order(method: str, degree: int) -> int:
    """Order of the final time's error in the length of the intervals.

    A control of degree N is off by order N + 1, and the final time, being optimal, by twice that.
    Gauss-Legendre and Radau collocation keep their orders 2 d and 2 d - 1 of the equations of
    motion for the costate, and so for the optimum (Hager, Numerische Mathematik 87, 2000).
    """
    if method == SHOOTING:
        return 2 * (degree + 1)
    return 2 * degree - (method == collocation_name("radau"))


def refined(table: pd.DataFrame) -> list[tuple[str, int, pd.DataFrame]]:
    """Method, degree and rows of a table of `convergence`, where they have all INTERVALS."""
    rows = table[table["intervals"].isin(INTERVALS)].sort_values("intervals")
    groups = [
        (str(name), int(str(degree)), group)
        for name in table["method"].unique()
        for degree, group in rows[rows["method"] == name].groupby("degree")
    ]
    return [one for one in groups if len(one[2]) == len(INTERVALS)]


def orders(table: pd.DataFrame) -> pd.DataFrame:
    """Order in the intervals, measured between the two finest meshes above the floor.

    Parameters
    ----------
    table
        Of `convergence`.

    Returns
    -------
    DataFrame
        Columns method, degree, intervals (of the finer mesh), error (of it), measured, theory.
    """
    rows = []
    for method, degree, group in refined(table):
        finest = group[group["error"].abs() > FLOOR].tail(2)
        if len(finest) < 2:
            continue
        (coarse, fine), (far, near) = finest["intervals"], finest["error"].abs()
        measured = np.log(far / near) / np.log(fine / coarse)
        rows.append((method, degree, fine, near, measured, theoretical_order(method, degree)))
    columns = ["method", "degree", "intervals", "error", "measured", "theory"]
    return pd.DataFrame(rows, columns=columns)


def _times(solution: Solution, optimum: float) -> tuple[float, float]:
    final_time = solution.objective if solution.converged else np.nan
    return final_time, final_time / optimum - 1.0


def _reference_error(problem: TransferProblem, extremal: Extremal, steps: int) -> float:
    steps = enough_steps(steps, problem, extremal.final_time)
    start = np.append(extremal.nodes.ravel()[5:], extremal.final_time)
    half = solve_extremal(problem, 1, start, equal_steps(1, steps // 2))
    return abs(half.final_time / extremal.final_time - 1.0)
