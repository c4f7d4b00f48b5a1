"""Minimum-torque plans: the document's two manoeuvres, and what a longer time allows."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from typing import Any

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.gauss_pseudospectral import Mesh, OptimalControlProblem
from smallsat.optimal_control.nonlinear_program import MINIMUM_DEGREE, IpoptSolver, Solution
from smallsat.optimal_control.zero_order_hold import HeldControl
from smallsat.studies.slew.configuration import Numerics
from smallsat.studies.slew.methods.flown import miss, propagate_held
from smallsat.studies.slew.methods.guidance_problem import (
    Guess,
    Guidance,
    Model,
    Result,
    problem,
    tilts,
    turning_guess,
)
from smallsat.studies.slew.parameters import Parameters

AXES = "xyz"
# What is said of a plan's held control.
HELD_SUMMARY = (
    "held_converged",
    "held_status",
    "held_cost_N_m_s",
    "attitude_miss_rad",
    "rate_miss_rad_s",
    "largest_torque_share",
    *(f"held_peak_{axis}_pct" for axis in AXES),
)
HELD_COLUMNS = (
    "plan",
    "time_s",
    *(f"q_{i}" for i in range(1, 5)),
    *(f"{name}_{axis}" for axis in AXES for name in ("omega", "h", "u")),
)
# Starts of a minimum-torque solve in a sweep; the document's two manoeuvres have all.
SWEEP_STARTS = 3


@dataclass(frozen=True)
class HeldPlan:
    """A plan with a held control, flown anew.

    Attributes
    ----------
    solution
        Its status is to be read.
    controls
        Shape (pieces, 3), scaled.
    states
        Flown by the independent integrator: (pieces + 1, 10), scaled.
    cost
        Integral of |u|, N m s: exact for a held control.
    attitude_miss, rate_miss
        At the end, as flown: rad and rad/s.
    """

    solution: Solution
    controls: np.ndarray
    states: np.ndarray
    duration: float
    cost: float
    attitude_miss: float
    rate_miss: float


def guidance_model(
    parameters: Parameters, torque: float | None = None, unit: float = 0.0, *, carried: bool = True
) -> Model:
    """The spacecraft as the guidance knows it: gravity gradient, and wheels that carry momentum."""
    return Model(
        parameters.inertia,
        parameters.torque if torque is None else torque,
        parameters.momentum,
        unit or parameters.duration,
        carried,
        parameters,
    )


@dataclass(frozen=True)
class Slew:
    """A turn from rest to rest that is to be planned.

    Attributes
    ----------
    model
        What the guidance knows.
    initial, target
        Attitudes, quaternions.
    duration
        s.
    mesh
        Segments and points of the collocation.
    """

    model: Model
    initial: np.ndarray
    target: np.ndarray
    duration: float
    mesh: Mesh

    def stated(self, **options: Any) -> OptimalControlProblem:
        """The problem in the given time; ``options`` are those of `problem`."""
        return problem(
            self.model, self.initial, self.target, (self.duration, self.duration), **options
        )

    def guess(self, tilt: tuple[float, float]) -> Guess:
        """A smooth turn, tilted off the eigenaxis."""
        return turning_guess(self.model, self.initial, self.target, self.duration, tilt)


def slew_of(
    model: Model, parameters: Parameters, case: str, mesh: Mesh, duration: float | None = None
) -> Slew:
    """One of the document's turns, in its time unless another, s, is given."""
    time = parameters.duration if duration is None else duration
    return Slew(model, parameters.initial, parameters.targets[case], time, mesh)


def best_plan(slew: Slew, numerics: Numerics, starts: int) -> tuple[Result, pd.DataFrame]:
    """Cheapest converged plan of several starts, and one row a start."""
    guidance = Guidance(slew.model, slew.stated(), slew.mesh)
    results = [
        guidance.solve(slew.guess(tilt), numerics.smoothing)
        for tilt in tilts(starts, numerics.seed)
    ]
    table = pd.DataFrame(
        [
            {
                "start": k,
                "converged": r.solution.converged,
                "status": r.solution.status,
                "cost_N_m_s": r.cost,
            }
            for k, r in enumerate(results)
        ]
    )
    converged = [r for r in results if r.solution.converged]
    return min(converged or results, key=lambda r: r.cost), table


def unsolved(case: str, result: Result, tried: str) -> list[NotConverged]:
    """The one row of a plan that did not converge; none of one that did."""
    solution = result.solution
    if solution.converged:
        return []
    return [NotConverged(case, solution.status, solution.violation, tried)]


def held_if_converged(
    slew: Slew, name: str, result: Result, numerics: Numerics
) -> tuple[HeldPlan | None, list[NotConverged]]:
    """A plan with a held control where there is a plan to start from, and what did not converge."""
    if not result.solution.converged:
        return None, []
    held = hold(slew, result, numerics)
    if held.solution.converged:
        return held, []
    row = NotConverged(
        f"{name}, with a held control",
        held.solution.status,
        held.solution.violation,
        f"{numerics.held_intervals} pieces, from the collocated plan",
    )
    return held, [row]


def hold(slew: Slew, result: Result, numerics: Numerics) -> HeldPlan:
    """Optimise again with a held control, from a collocated plan, and fly it anew."""
    model, pieces, plan = slew.model, numerics.held_intervals, result.plan
    stated = slew.stated()
    method = HeldControl(stated, pieces, 1)
    solver = IpoptSolver(
        method.program,
        tol=1e-9,
        max_iter=600,
        mu_strategy="monotone",
        mu_init=1e-4,
        **MINIMUM_DEGREE,
    )
    guess = method.guess(
        np.r_[0.0, plan.times, plan.final_time],
        np.vstack([stated.initial, plan.states, plan.ends[-1]]),
        np.vstack([plan.controls[0], plan.controls, plan.controls[-1]]),
    )
    solution = solver.solve(guess, [numerics.held_smoothing])
    controls = np.clip(method.controls(solution.variables), -1.0, 1.0)
    length = plan.final_time / pieces
    states = propagate_held(model, stated.initial, np.full(pieces, length), controls)
    attitude, rate = miss(model, states[-1], slew.target)
    return HeldPlan(
        solution=solution,
        controls=controls,
        states=states,
        duration=result.duration,
        cost=float(np.linalg.norm(controls, axis=1).sum() * length * model.momentum_unit),
        attitude_miss=attitude,
        rate_miss=rate,
    )


def asked_once(slew: Slew) -> Solution:
    """What the solver says of a turn as it stands, from one start off the eigenaxis."""
    return (
        Guidance(slew.model, slew.stated(), slew.mesh).solve(slew.guess((0.2, 0.0)), [1.0]).solution
    )


def least_infeasible(
    slew: Slew, numerics: Numerics, rate_weights: Sequence[float] = (1.0,)
) -> list[Result]:
    """The plans that miss their end least, one for each weight of the rate.

    The miss is the squared attitude error, rad^2, plus the squared rate times weight and T.
    """
    soft = Guidance(slew.model, slew.stated(soft=True), slew.mesh)
    started = tilts(numerics.starts, numerics.seed)[: 3 if slew.mesh.segments == 1 else 5]
    found = []
    for weight in rate_weights:
        results = [soft.solve(slew.guess(tilt), [weight]) for tilt in started]
        converged = [r for r in results if r.solution.converged]
        found.append(min(converged or results, key=lambda r: r.solution.objective))
    return found


def node_table(model: Model, result: Result, name: str) -> pd.DataFrame:
    """A plan at its points: time, state, torque and costate, with both ends; SI units."""
    plan = result.plan
    times = np.r_[0.0, plan.times, plan.final_time] * model.unit
    states = np.vstack([plan.ends[0], plan.states, plan.ends[-1]])
    controls = np.vstack([plan.controls[0], plan.controls, plan.controls[-1]]) * model.torque
    table = pd.DataFrame({"plan": name, "time_s": times})
    table["node"] = np.r_[0, np.ones(len(plan.times), dtype=int), 0]
    for i in range(4):
        table[f"q_{i + 1}"] = states[:, i]
    for i, axis in enumerate(AXES):
        table[f"omega_{axis}"] = states[:, 4 + i] / model.unit
        table[f"h_{axis}"] = states[:, 7 + i] * model.momentum_unit
        table[f"u_{axis}"] = controls[:, i]
    table["hamiltonian"] = np.r_[np.nan, result.hamiltonian, np.nan]
    return table


def held_table(model: Model, held: HeldPlan, name: str) -> pd.DataFrame:
    """A held plan at the ends of its pieces, as flown anew, with the torque of the next piece."""
    controls = np.vstack([held.controls, held.controls[-1]]) * model.torque
    table = pd.DataFrame({"plan": name, "time_s": np.linspace(0.0, held.duration, len(controls))})
    for i in range(4):
        table[f"q_{i + 1}"] = held.states[:, i]
    for i, axis in enumerate(AXES):
        table[f"omega_{axis}"] = held.states[:, 4 + i] / model.unit
        table[f"h_{axis}"] = held.states[:, 7 + i] * model.momentum_unit
        table[f"u_{axis}"] = controls[:, i]
    return table


def resampled(table: pd.DataFrame, rate_hz: float) -> np.ndarray:
    """Torques (n, 3) of a plan at equal times, linear between its points (Section V.E)."""
    times = table["time_s"].to_numpy()
    count = round(times[-1] * rate_hz)
    at = np.arange(count + 1) / rate_hz
    return np.column_stack([np.interp(at, times, table[f"u_{axis}"]) for axis in AXES])


def spread(hamiltonian: np.ndarray) -> float:
    """Range of the Hamiltonian over a plan, in shares of its mean, to two digits."""
    return float(f"{np.ptp(hamiltonian) / abs(np.mean(hamiltonian)):.1e}")


def joined(tables: list[pd.DataFrame], columns: tuple[str, ...]) -> pd.DataFrame:
    """Tables below one another; of no rows, with these columns, where there is none."""
    if not tables:
        return pd.DataFrame(columns=list(columns), dtype=float)
    return pd.concat(tables, ignore_index=True)


def summary(
    model: Model, name: str, result: Result, starts: pd.DataFrame, held: HeldPlan | None
) -> dict:
    """One row of what is said of a plan."""
    h = result.hamiltonian
    peaks = 100.0 * np.abs(result.plan.states[:, 7:]).max(axis=0) * model.momentum_unit
    row = {
        "plan": name,
        "duration_s": result.duration,
        "converged": result.solution.converged,
        "status": result.solution.status,
        "starts": len(starts),
        "starts_converged": int(starts["converged"].sum()),
        "cost_N_m_s": result.cost,
        "hamiltonian_mean": float(np.mean(h)),
        "hamiltonian_spread": spread(h),
    }
    row |= {f"peak_{a}_pct": float(p / model.momentum) for a, p in zip(AXES, peaks, strict=True)}
    if held is not None:
        flown = 100.0 * np.abs(held.states[:, 7:]).max(axis=0) * model.momentum_unit
        row |= {
            "held_converged": held.solution.converged,
            "held_status": held.solution.status,
            "held_cost_N_m_s": held.cost,
            "attitude_miss_rad": float(f"{held.attitude_miss:.1e}"),
            "rate_miss_rad_s": float(f"{held.rate_miss:.1e}"),
            "largest_torque_share": float(np.abs(held.controls).max()),
        }
        row |= {
            f"held_peak_{a}_pct": float(p / model.momentum)
            for a, p in zip(AXES, flown, strict=True)
        }
    # Where there is none a table has the columns all the same.
    return row | {name: row.get(name, nan) for name in HELD_SUMMARY}
