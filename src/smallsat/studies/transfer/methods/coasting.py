"""Where thrust is worth its propellant: the switching function, and flights that may coast.

The document's thrust is always on. Were it free between nothing and all, the Hamiltonian would be
linear in it, with the factor T S, where S = |lambda_v| / m - lambda_m / v_e is the switching
function: thrust where it is positive, coast where it is negative. Everything is in canonical units.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import casadi as ca
import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.runge_kutta import integrate, step_function
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.experiments import extremal_table
from smallsat.studies.transfer.methods.extremals import enough_steps
from smallsat.studies.transfer.model.problem import COSTATES, STATES, TransferProblem
from smallsat.studies.transfer.model.trajectory import boundary_error, error_magnitude
from smallsat.studies.transfer.model.units import canonical, units_of

FLIGHT_COLUMNS = ["excess", "final_time", "final_mass", "off", "on", "saved", "residual", "status"]
PATH_COLUMNS = ["excess", "t", "thrusting", *STATES, *COSTATES, "switching"]

# By what share of the shortest flight others are longer, in the order in which one starts the next.
EXCESSES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
# Share of the shortest flight that the first guess coasts, about where thrust is worth least.
GUESSED_COAST = 0.01
# Error of the conditions above which a flight is not solved.
SOLVED = 1e-9
# Rows of a path in each of its arcs.
SAMPLES = 161


@dataclass(frozen=True)
class Coast:
    """A flight of thrust, coast and thrust that spends least propellant in its time.

    Attributes
    ----------
    costate
        At the start, (5,).
    off, on
        When the thrust ends and when it begins again.
    final_time
        Of the flight, which is given.
    residual
        Largest error of the conditions.
    """

    costate: np.ndarray
    off: float
    on: float
    final_time: float
    residual: float


def coasting(section: Configuration) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The shortest flight, and longer ones that spend least propellant.

    Returns
    -------
    flights
        A row for each excess of the time over the shortest, which is the first with an excess of 0:
        FLIGHT_COLUMNS, with times and mass in the configuration's units, saved as a share of the
        shortest flight's propellant, residual the error at the end when flown anew, and nothing but
        a status where no flight of two thrust arcs meets all conditions.
    paths
        A row for each time: PATH_COLUMNS in canonical units. The costate of the shortest flight is
        that of least time, which is the document's less the mass itself; see `of_least_time`.
    """
    configured = TransferProblem.of(section.problem)
    problem, units = canonical(configured), units_of(configured)
    extremal = extremal_table(section)
    if isinstance(extremal, NotConverged):
        return pd.DataFrame(columns=FLIGHT_COLUMNS), pd.DataFrame(columns=PATH_COLUMNS)
    shortest = of_least_time(problem, extremal)
    final_time, mass = float(shortest["t"].iloc[-1]), float(shortest["m"].iloc[-1])
    status = "never coasts" if (shortest["switching"] > 0.0).all() else "would coast"
    end = (final_time * units.time, mass * units.mass)
    rows: list[tuple] = [(0.0, *end, np.nan, np.nan, 0.0, path_error(problem, shortest), status)]
    frames = [shortest.assign(excess=0.0, thrusting=True)]
    guess = first_guess(problem, shortest)
    for excess in EXCESSES:
        longer = (1.0 + excess) * final_time
        steps = enough_steps(section.numerics.steps.indirect, problem, longer)
        coast = solve_coast(problem, guess, longer, steps)
        path = fly(problem, coast)
        if coast.residual > SOLVED or not obeys_switching(path):
            rows.append((excess, longer * units.time, *[np.nan] * 5, "not solved"))
            continue
        guess = np.r_[coast.costate[[0, 2, 3, 4]], coast.off, coast.on]
        left = float(path["m"].iloc[-1])
        times = (coast.off * units.time, coast.on * units.time)
        saved = (left - mass) / (1.0 - mass)
        end = (longer * units.time, left * units.mass)
        rows.append((excess, *end, *times, saved, path_error(problem, path), "coasts"))
        frames.append(path.assign(excess=excess))
    paths = pd.concat(frames, ignore_index=True)[PATH_COLUMNS]
    return pd.DataFrame(rows, columns=FLIGHT_COLUMNS), paths


def switching(problem: TransferProblem, table: pd.DataFrame) -> pd.Series:
    """The switching function S of rows with a mass and a costate."""
    primer = np.hypot(table["lambda_vr"], table["lambda_vtheta"])
    return primer / table["m"] - table["lambda_m"] / problem.exhaust_speed


def of_least_time(problem: TransferProblem, extremal: pd.DataFrame) -> pd.DataFrame:
    """The extremal with the costate of least time, and its switching function.

    The document maximises the final mass, so that its mass costate ends at 1. Where least time is
    the objective, mass left over is worth nothing and the mass costate ends at 0; it obeys the same
    equation, and no other costate changes. As it never falls, it is negative before the end, and S
    is positive: a flight in least time never coasts.
    """
    table = extremal.assign(lambda_m=extremal["lambda_m"] - 1.0)
    return table.assign(switching=switching(problem, table))


def first_guess(problem: TransferProblem, shortest: pd.DataFrame) -> np.ndarray:
    """Unknowns of `solve_coast` near the shortest flight.

    There the multiplier of the mass is small beside the others: the costate is a large multiple of
    that of least time, plus 1 for the mass. The multiple makes S vanish at the level below which
    the guessed share of the flight lies.
    """
    low = shortest["switching"] < shortest["switching"].quantile(GUESSED_COAST)
    level = float(shortest.loc[low, "switching"].max())
    multiple = 1.0 / (problem.exhaust_speed * level)
    start = multiple * shortest.iloc[0][["lambda_r", "lambda_vr", "lambda_vtheta", "lambda_m"]]
    times = shortest.loc[low, "t"]
    return np.array([*start[:-1], start.iloc[-1] + 1.0, times.min(), times.max()], dtype=float)


def solve_coast(
    problem: TransferProblem, guess: np.ndarray, final_time: float, steps: int
) -> Coast:
    """Shooting through thrust, coast and thrust in a given time.

    Parameters
    ----------
    problem
        The transfer.
    guess
        Costates (6,) of r, v_r, v_theta and m at the start, and the two switching times. The
        costate of the free angle vanishes.
    final_time
        Of the flight.
    steps
        Integration steps over the flight, a third of them for each arc.
    """
    unknown = ca.MX.sym("z", 6)
    l_r, l_vr, l_vtheta, l_m, off, on = (unknown[i] for i in range(6))
    y = ca.vertcat(ca.DM(problem.initial_state), l_r, 0.0, l_vr, l_vtheta, l_m)
    ends = []
    durations = (off, on - off, final_time - on)
    for one, duration in zip(_arcs(problem), durations, strict=True):
        step = step_function(_rate(one), 10, 1)
        y = integrate(step, y, duration, 0.0, 1.0, max(1, steps // 3))
        ends.append(y)
    values = [
        ca.sqrt(end[7] ** 2 + end[8] ** 2) / end[4] - end[9] / problem.exhaust_speed
        for end in ends[:2]
    ]
    conditions = ca.vertcat(*problem.terminal_error(y), y[9] - 1.0, *values)
    residual = ca.Function("residual", [unknown], [conditions])
    jacobian = ca.Function("jacobian", [unknown], [ca.jacobian(conditions, unknown)])
    result = least_squares(
        lambda z: np.nan_to_num(residual(z).full().ravel(), nan=1e6),
        guess,
        jac=lambda z: np.nan_to_num(jacobian(z).full()),
        x_scale="jac",
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    ends_at, begins_at = (float(value) for value in result.x[4:])
    costate = np.insert(result.x[:4], 1, 0.0)
    return Coast(costate, ends_at, begins_at, final_time, error_magnitude(result.fun))


def fly(problem: TransferProblem, coast: Coast) -> pd.DataFrame:
    """Fly a coast anew by an integrator of another kind, resetting nothing: PATH_COLUMNS."""
    y = np.concatenate([problem.initial_state, coast.costate])
    ends = [0.0, coast.off, coast.on, coast.final_time]
    if not all(a < b for a, b in pairwise(ends)):
        return pd.DataFrame(columns=PATH_COLUMNS)
    frames = []
    for one, (begin, end) in zip(_arcs(problem), pairwise(ends), strict=True):
        flight = solve_ivp(
            lambda _, y, one=one: one.extremal_rate(y[:5], y[5:]),
            (begin, end),
            y,
            method="LSODA",
            t_eval=np.linspace(begin, end, SAMPLES),
            rtol=1e-12,
            atol=1e-13,
        )
        y = flight.y[:, -1]
        table = pd.DataFrame(flight.y.T, columns=[*STATES, *COSTATES])
        frames.append(table.assign(t=flight.t, thrusting=one.thrust > 0.0))
    path = pd.concat(frames, ignore_index=True)
    return path.assign(switching=switching(problem, path), excess=np.nan)[PATH_COLUMNS]


def path_error(problem: TransferProblem, path: pd.DataFrame) -> float:
    """Largest error of the conditions on r, v_r and v_theta at the end of a path."""
    return boundary_error(problem, path.iloc[-1][list(STATES)].to_numpy(dtype=float))


def obeys_switching(path: pd.DataFrame) -> bool:
    """Whether a path thrusts where S is positive and coasts where it is negative."""
    sign = np.where(path["thrusting"].astype(bool), 1.0, -1.0)
    return bool(len(path)) and bool((sign * path["switching"] > -SOLVED).all())


def _arcs(problem: TransferProblem) -> list[TransferProblem]:
    return [problem, replace(problem, thrust=0.0), problem]


def _rate(problem: TransferProblem):
    return lambda _, y, p: [p * value for value in problem.extremal_rate(y[:5], y[5:])]
