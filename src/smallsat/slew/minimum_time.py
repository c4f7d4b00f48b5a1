"""Least times from rest to rest: collocation from many starts, then refined switching times."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.optimal_control.switching_times import Arcs, arcs_of, refine
from smallsat.slew.flown import fly_held, miss
from smallsat.slew.guidance import Guidance, Model, Result, problem, tilts, turning_guess
from smallsat.slew.parameters import Parameters

# Two starts found the same least time if they agree to this, s or its equivalent.
SAME = 1e-3
AXES = "xyz"


@dataclass(frozen=True)
class LeastTime:
    """A least time with how it was found.

    Attributes
    ----------
    starts
        One row a start: duration, converged, status.
    collocated
        The best converged solution of the pseudospectral method.
    arcs
        Bang-bang control with refined switching times, scaled.
    duration
        By the refined arcs, s.
    converged, status
        Of the refinement.
    attitude_miss, rate_miss
        Of the arcs flown by an independent integrator: rad, and rad/s.
    """

    starts: pd.DataFrame
    collocated: Result
    arcs: Arcs
    duration: float
    converged: bool
    status: str
    attitude_miss: float
    rate_miss: float


def least_time(
    model: Model, initial: np.ndarray, target: np.ndarray, about: float, mesh: Mesh, section: Config
) -> LeastTime:
    """Least time of a turn between two attitudes at rest; ``about`` is a guess of it, s."""
    numerics = section["numerics"]
    stated = problem(model, initial, target, (0.3 * about, 3.0 * about), least_time=True)
    guidance = Guidance(model, stated, mesh)
    results = [
        guidance.solve(turning_guess(model, initial, target, about, tilt), [1.0])
        for tilt in tilts(numerics["starts"], numerics["seed"])
    ]
    starts = pd.DataFrame(
        [
            {"start": k, "duration_s": r.duration, "status": r.solution.status}
            | {"converged": r.solution.converged}
            for k, r in enumerate(results)
        ]
    )
    best = min((r for r in results if r.solution.converged), key=lambda r: r.duration)
    arcs = arcs_of(best.plan.times, best.plan.controls, best.plan.final_time)
    refined, solution = refine(model.rate, stated.initial, stated.terminal, arcs)
    state = fly_held(model, stated.initial, refined.durations, refined.controls)[-1]
    attitude, rate = miss(model, state, target)
    return LeastTime(
        starts=starts,
        collocated=best,
        arcs=refined,
        duration=refined.final_time * model.unit,
        converged=solution.converged,
        status=solution.status,
        attitude_miss=attitude,
        rate_miss=rate,
    )


def cases(section: Config, given: Parameters) -> dict[str, tuple[Model, np.ndarray, float, Mesh]]:
    """The least-time problems of this study: model, target, guess of the time, mesh."""
    unit = given.duration
    half, quarter = given.targets["half"], given.targets["quarter"]
    entry = section["manoeuvre"]["half"]
    mesh = Mesh(entry["segments"], entry["segment_nodes"])

    def model(carried: bool, gradient: bool) -> Model:
        return Model(
            given.inertia, given.torque, given.momentum, unit, carried, given if gradient else None
        )

    # Equal moments of inertia and unit torques: the benchmark of Bilimoria and Wie.
    benchmark = Model(np.eye(3), 1.0, 1e6, 1.0, False, None)
    return {
        "180 deg, wheels and gravity gradient": (model(True, True), half, 115.0, mesh),
        "180 deg, wheels": (model(True, False), half, 115.0, mesh),
        "180 deg, no wheel momentum": (model(False, False), half, 115.0, mesh),
        "90 deg, wheels and gravity gradient": (model(True, True), quarter, 85.0, mesh),
        "90 deg, wheels": (model(True, False), quarter, 85.0, mesh),
        "benchmark, 180 deg": (benchmark, half, 3.5, mesh),
        "benchmark, 90 deg": (benchmark, quarter, 2.5, mesh),
    }


def tables(section: Config, given: Parameters) -> dict[str, pd.DataFrame]:
    """Tables by name: least times, switches, starts, and the seconds of the solves."""
    rows, switches, starts, seconds = [], [], [], []
    for name, (model, target, about, mesh) in cases(section, given).items():
        found = least_time(model, given.initial, target, about, mesh, section)
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
                "hamiltonian_spread": float(f"{np.ptp(h) / abs(np.mean(h)):.1e}"),
                "attitude_miss_rad": float(f"{found.attitude_miss:.1e}"),
                "rate_miss_rad_s": float(f"{found.rate_miss:.1e}"),
            }
        )
        for axis, time in found.arcs.switches():
            switches.append({"case": name, "axis": AXES[axis], "time_s": time * model.unit})
        starts.append(found.starts.assign(case=name))
        seconds.append({"case": name, "seconds": found.collocated.seconds})
    return {
        "minimum-times": pd.DataFrame(rows),
        "switches": pd.DataFrame(switches),
        "minimum-time-starts": pd.concat(starts, ignore_index=True),
        "minimum-times-seconds": pd.DataFrame(seconds),
    }


# --- a bound that needs no optimiser --------------------------------------------------------------


def reach(
    inertia: np.ndarray,
    torque: float,
    duration: float,
    final_momentum: tuple[float, float] = (0.0, 0.0),
    disturbance: float = 0.0,
) -> float:
    """Longest path of the body's x axis on the unit sphere, rad, that the wheels allow in a time.

    From rest, with the wheels at rest, J w = h + H: what the wheels gave and what the environment
    did. A wheel gives at most torque times time, and must come back, so that |h_i| is at most
    u min(t, tf - t) plus what remains at the end and |H|. The x axis moves with the speed
    sqrt(w_y^2 + w_z^2), whatever the order of the turns.

    Parameters
    ----------
    inertia
        Principal moments, shape (3,), kg m^2.
    torque, duration
        N m and s.
    final_momentum
        Momentum about y and z that is left at the end, N m s.
    disturbance
        Largest angular momentum, N m s, that the environment can give in the time.
    """
    time = np.linspace(0.0, duration, 20001)
    speed = np.zeros_like(time)
    for moment, left in zip(inertia[1:], final_momentum, strict=True):
        given = np.minimum(torque * time, torque * (duration - time) + left)
        speed += ((given + 2.0 * disturbance) / moment) ** 2
    speed = np.sqrt(speed)
    # The trapezoidal rule bends kinks inwards; one step of the largest slope covers that.
    bound = float(np.sum(np.maximum(speed[1:], speed[:-1]) * np.diff(time)))
    return bound


def largest_disturbance(given: Parameters, duration: float) -> float:
    """Angular momentum, N m s, that the gravity gradient can give at most in a time, any attitude.

    The torque is 3 mu / r^3 times e x J e, which is at most half the difference of the extreme
    moments for any unit vector e, taken at perigee.
    """
    moments = np.linalg.eigvalsh(given.inertia)
    perigee = given.orbit.semi_major_axis * (1.0 - given.orbit.eccentricity)
    return float(1.5 * given.gravity.mu / perigee**3 * (moments[2] - moments[0]) * duration)


def bound_time(given: Parameters, gradient: bool) -> float:
    """Time, s, below which no plan turns the body by 180 deg about z from rest to rest."""
    moments = np.diag(given.inertia)
    low, high = 1.0, 1000.0
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        disturbance = largest_disturbance(given, middle) if gradient else 0.0
        if reach(moments, given.torque, middle, disturbance=disturbance) < np.pi:
            low = middle
        else:
            high = middle
    return low
