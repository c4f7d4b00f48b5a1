"""Least times from rest to rest: collocation from many starts, then refined switching times."""

from dataclasses import dataclass
from math import nan

import numpy as np
import pandas as pd

from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.optimal_control.switching_times import Arcs, arcs_of, refine
from smallsat.studies.slew.configuration import Configuration, Numerics
from smallsat.studies.slew.methods.flown import miss, propagate_held
from smallsat.studies.slew.methods.guidance_problem import (
    Guidance,
    Model,
    Result,
    problem,
    tilts,
    turning_guess,
)
from smallsat.studies.slew.methods.one_axis import eigenaxis_time
from smallsat.studies.slew.methods.plans import spread
from smallsat.studies.slew.parameters import MILLI, Parameters

# Two starts found the same least time if they agree to this, s or its equivalent.
SAME = 1e-3
AXES = "xyz"
# Attitude and rate at the end.
CONDITIONS = 6
# A wheel counts as full from this share of its momentum on.
FULL = 0.995


@dataclass(frozen=True)
class LeastTime:
    """A least time with how it was found; not a number where no start converged.

    Attributes
    ----------
    starts
        One row a start: duration, converged, status.
    collocated
        The fastest converged solution of the pseudospectral method, or else the last one.
    arcs
        Bang-bang control with refined switching times, scaled, or with those of collocation where
        axes switch together; none where a wheel is full, since it then turns on without torque.
    duration
        By the refined arcs, or by collocation where there are none, s.
    converged, status, residual
        How the method that gives the duration ended.
    momentum_limited
        Whether a wheel is full at some time.
    attitude_miss, rate_miss
        Where the arcs end by an independent integrator, beside the target: rad, and rad/s.
    """

    starts: pd.DataFrame
    collocated: Result
    arcs: Arcs | None
    duration: float
    converged: bool
    status: str
    residual: float
    momentum_limited: bool
    attitude_miss: float
    rate_miss: float


def least_time(
    model: Model,
    initial: np.ndarray,
    target: np.ndarray,
    about: float,
    mesh: Mesh,
    numerics: Numerics,
) -> LeastTime:
    """Least time of a turn between two attitudes at rest; ``about`` is a guess of it, s."""
    return fastest(
        model,
        initial,
        target,
        about,
        (0.3 * about, 3.0 * about),
        mesh,
        tilts(numerics.starts, numerics.seed),
    )


def fastest(
    model: Model,
    initial: np.ndarray,
    target: np.ndarray,
    about: float,
    window: tuple[float, float],
    mesh: Mesh,
    tilted: list[tuple[float, float]],
) -> LeastTime:
    """Least time within a window, s, from starts tilted off the eigenaxis; ``about`` is a guess."""
    stated = problem(model, initial, target, window, least_time=True)
    guidance = Guidance(model, stated, mesh)
    results = [
        guidance.solve(turning_guess(model, initial, target, about, tilt), [1.0]) for tilt in tilted
    ]
    starts = pd.DataFrame(
        [
            {"start": k, "duration_s": r.duration, "status": r.solution.status}
            | {"converged": r.solution.converged}
            for k, r in enumerate(results)
        ]
    )
    converged = [r for r in results if r.solution.converged]
    best = min(converged, key=lambda r: r.duration) if converged else results[-1]
    used = np.abs(best.plan.states[:, 7:]).max() * model.momentum_unit / model.momentum
    limited = bool(converged and used > FULL)
    if not converged or limited:
        return LeastTime(
            starts=starts,
            collocated=best,
            arcs=None,
            duration=best.duration if converged else nan,
            converged=bool(converged),
            status=best.solution.status,
            residual=best.solution.violation,
            momentum_limited=limited,
            attitude_miss=nan,
            rate_miss=nan,
        )
    arcs = arcs_of(best.plan.times, best.plan.controls, best.plan.final_time)
    # Where axes switch together there are fewer arcs than conditions: nothing is left to refine.
    refined, solution = arcs, best.solution
    if len(arcs.durations) >= CONDITIONS:
        refined, solution = refine(model.rate, stated.initial, stated.terminal, arcs)
    state = propagate_held(model, stated.initial, refined.durations, refined.controls)[-1]
    attitude, rate = miss(model, state, target)
    return LeastTime(
        starts=starts,
        collocated=best,
        arcs=refined,
        duration=refined.final_time * model.unit if solution.converged else nan,
        converged=solution.converged,
        status=solution.status,
        residual=solution.violation,
        momentum_limited=False,
        attitude_miss=attitude,
        rate_miss=rate,
    )


# Where the search for the least times of the document's two turns begins, s, and what those turns
# take about their axis alone; other turns, bodies and wheels begin in proportion.
DOCUMENT_GUESS = {"quarter": 85.0, "half": 115.0}
DOCUMENT_EIGENAXIS = {
    case: eigenaxis_time(angle, 0.126, 0.1 * MILLI, 10.3 * MILLI)
    for case, angle in (("quarter", np.pi / 2.0), ("half", np.pi))
}
BENCHMARK_GUESS = {"quarter": (2.5, 90.0), "half": (3.5, 180.0)}


def guess(parameters: Parameters, case: str) -> float:
    """A guess of the least time of a turn, s."""
    axis = parameters.axis(case)
    moment = float(axis @ parameters.inertia @ axis)
    alone = eigenaxis_time(
        np.radians(parameters.angle_deg(case)), moment, parameters.torque, parameters.momentum
    )
    return DOCUMENT_GUESS[case] * (alone / DOCUMENT_EIGENAXIS[case])


def benchmark_guess(parameters: Parameters, case: str) -> float:
    """The same for a body of unit moments and torques."""
    about, angle = BENCHMARK_GUESS[case]
    return about * float(np.sqrt(parameters.angle_deg(case) / angle))


def cases(
    section: Configuration, parameters: Parameters
) -> dict[str, tuple[Model, np.ndarray, float, Mesh]]:
    """The least-time problems of this study: model, target, guess of the time, mesh."""
    unit = parameters.duration
    half, quarter = parameters.targets["half"], parameters.targets["quarter"]
    entry = section.manoeuvre.half
    mesh = Mesh(entry.segments, entry.segment_nodes)

    def model(carried: bool, gradient: bool) -> Model:
        return Model(
            parameters.inertia,
            parameters.torque,
            parameters.momentum,
            unit,
            carried,
            parameters if gradient else None,
        )

    # Equal moments of inertia and unit torques: the benchmark of Bilimoria and Wie.
    benchmark = Model(np.eye(3), 1.0, 1e6, 1.0, False, None)
    larger, smaller = parameters.names["half"], parameters.names["quarter"]
    long, short = guess(parameters, "half"), guess(parameters, "quarter")
    return {
        f"{larger}, wheels and gravity gradient": (model(True, True), half, long, mesh),
        f"{larger}, wheels": (model(True, False), half, long, mesh),
        f"{larger}, no wheel momentum": (model(False, False), half, long, mesh),
        f"{smaller}, wheels and gravity gradient": (model(True, True), quarter, short, mesh),
        f"{smaller}, wheels": (model(True, False), quarter, short, mesh),
        f"benchmark, {larger}": (benchmark, half, benchmark_guess(parameters, "half"), mesh),
        f"benchmark, {smaller}": (benchmark, quarter, benchmark_guess(parameters, "quarter"), mesh),
    }


def tables(
    section: Configuration, parameters: Parameters
) -> tuple[dict[str, pd.DataFrame], list[NotConverged]]:
    """Tables by name: least times, switches, starts, seconds of the solves; what failed."""
    rows, switches, starts, seconds = [], [], [], []
    unsolved: list[NotConverged] = []
    for name, (model, target, about, mesh) in cases(section, parameters).items():
        found = least_time(model, parameters.initial, target, about, mesh, section.numerics)
        converged = found.starts[found.starts["converged"]]
        h = found.collocated.hamiltonian
        rows.append(
            {
                "case": name,
                "duration_s": found.duration,
                "collocated_s": found.collocated.duration,
                "converged": found.converged and found.collocated.solution.converged,
                "status": found.status,
                "starts": len(found.starts),
                "starts_converged": len(converged),
                "starts_at_best": int(
                    (converged["duration_s"] - converged["duration_s"].min() < SAME * about).sum()
                ),
                "hamiltonian_mean": float(np.mean(h)),
                "hamiltonian_spread": spread(h),
                "attitude_miss_rad": float(f"{found.attitude_miss:.1e}"),
                "rate_miss_rad_s": float(f"{found.rate_miss:.1e}"),
            }
        )
        if not rows[-1]["converged"]:
            unsolved.append(not_found(f"least time, {name}", found))
        for axis, time in found.arcs.switches() if found.arcs else []:
            switches.append({"case": name, "axis": AXES[axis], "time_s": time * model.unit})
        starts.append(found.starts.assign(case=name))
        seconds.append({"case": name, "seconds": found.collocated.seconds})
    return {
        "minimum-times": pd.DataFrame(rows),
        "switches": pd.DataFrame(switches, columns=["case", "axis", "time_s"]),
        "minimum-time-starts": pd.concat(starts, ignore_index=True),
        "minimum-times-seconds": pd.DataFrame(seconds),
    }, unsolved


def not_found(case: str, found: LeastTime) -> NotConverged:
    """The row of a least time that was not found."""
    tried = f"collocation from {len(found.starts)} starts"
    if found.collocated.solution.converged:
        tried += ", then refined switching times"
    return NotConverged(case, found.status, found.residual, tried)
