"""Beyond the document: longer times, closed-loop tracking, and the wheels' degradation."""

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.dynamics.quaternions import error_quaternion, turn_angle
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.optimal_control.switching_times import arcs_of, refine
from smallsat.slew.flights import controller
from smallsat.slew.guidance import Guidance, problem, tilts, turning_guess
from smallsat.slew.parameters import MILLI, Parameters
from smallsat.slew.plans import (
    SWEEP_STARTS,
    best_plan,
    guidance_model,
    held_table,
    hold,
    summary,
)
from smallsat.slew.simulation import TRACKING, Command, Plant, open_loop, plant, run

STATE = ["q_1", "q_2", "q_3", "q_4", "omega_x", "omega_y", "omega_z"]
TORQUE = ["u_x", "u_y", "u_z"]
# In the degradation sweep the torque-optimal turn takes this much longer than the fastest one.
SLACK = 1.1
# A wheel counts as full from this share of its momentum on.
FULL = 0.995


def half_mesh(section: Config) -> Mesh:
    """Segments of the 180 deg turn."""
    entry = section["manoeuvre"]["half"]
    return Mesh(entry["segments"], entry["segment_nodes"])


def trade_off(section: Config, given: Parameters) -> dict[str, pd.DataFrame]:
    """Feasible minimum-torque plans of the 180 deg turn for longer times."""
    model = guidance_model(given)
    rows, tables, seconds = [], [], []
    for duration in section["beyond"]["trade_off_s"]:
        name = f"180 deg, {duration:g} s"
        result, starts = best_plan(
            model, given, "half", duration, half_mesh(section), section, SWEEP_STARTS
        )
        held = hold(model, given, "half", result, section)
        rows.append(summary(model, given, name, result, starts, held))
        tables.append(held_table(model, held, name))
        seconds.append({"plan": name, "seconds": result.seconds})
    return {
        "trade-off": pd.DataFrame(rows),
        "trade-off-plans": pd.concat(tables, ignore_index=True),
        "trade-off-seconds": pd.DataFrame(seconds),
    }


def degradation(section: Config, given: Parameters) -> pd.DataFrame:
    """Least time of the 180 deg turn, and least torque in a tenth more, over the wheels' torque."""
    wheels, target = section["wheels"], given.targets["half"]
    healthy = wheels["torque_mN_m"] * MILLI / (wheels["torque_share_pct"] / 100.0)
    known = wheels["torque_share_pct"]
    rows = []
    for share in section["beyond"]["torque_shares_pct"]:
        torque = healthy * share / 100.0
        # Without other torques, times go with the root of the torque; a guess, nothing more.
        about = 115.0 * np.sqrt(known / share)
        model = guidance_model(given, torque, about)
        stated = problem(model, given.initial, target, (0.5 * about, 2.0 * about), least_time=True)
        guidance = Guidance(model, stated, half_mesh(section))
        results = [
            guidance.solve(turning_guess(model, given.initial, target, about, tilt), [1.0])
            for tilt in tilts(SWEEP_STARTS, section["numerics"]["seed"])
        ]
        best = min((r for r in results if r.solution.converged), key=lambda r: r.duration)
        least, converged = best.duration, True
        used = np.abs(best.plan.states[:, 7:]).max() * model.momentum_unit / given.momentum
        limited = bool(used > FULL)
        # Where a wheel is full it turns on without torque, and the plan is no longer bang-bang.
        if not limited:
            arcs, solution = refine(
                model.rate,
                stated.initial,
                stated.terminal,
                arcs_of(best.plan.times, best.plan.controls, best.plan.final_time),
            )
            least, converged = arcs.final_time * model.unit, solution.converged
        plan, _ = best_plan(
            model, given, "half", SLACK * least, half_mesh(section), section, SWEEP_STARTS
        )
        peaks = np.abs(plan.plan.states[:, 7:]).max() * model.momentum_unit / given.momentum
        rows.append(
            {
                "torque_share_pct": share,
                "torque_mN_m": torque / MILLI,
                "least_time_s": least,
                "least_time_converged": converged,
                "momentum_limited": limited,
                "plan_time_s": plan.duration,
                "plan_converged": plan.solution.converged,
                "cost_N_m_s": plan.cost,
                "largest_peak_momentum_pct": 100.0 * float(peaks),
            }
        )
    return pd.DataFrame(rows)


def tracking(section: Config, given: Parameters) -> dict[str, pd.DataFrame]:
    """The optimal plan followed in closed loop, beside open loop and the eigenaxis law.

    The plan leaves a margin of torque to the controller. Flown in the fuller model with and without
    an error of the inertia; drag is on.
    """
    entry = section["beyond"]["tracking"]
    margin = 1.0 - entry["torque_margin_pct"] / 100.0
    model = guidance_model(given, margin * given.torque)
    manoeuvre = section["manoeuvre"]
    turns = {
        "90 deg": ("quarter", given.duration),
        "180 deg": ("half", max(section["beyond"]["trade_off_s"])),
    }
    rows, tables = [], []
    for turn, (case, duration) in turns.items():
        mesh = Mesh(manoeuvre[case]["segments"], manoeuvre[case]["segment_nodes"])
        result, _ = best_plan(model, given, case, duration, mesh, section, SWEEP_STARTS)
        held = hold(model, given, case, result, section)
        table = held_table(model, held, turn)
        at = np.arange(round(duration * section["resampling_hz"]) + 1) / section["resampling_hz"]
        times = table["time_s"].to_numpy()
        # The torque of a piece holds from its start to its end.
        piece = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
        plan = np.column_stack(
            [table[TORQUE].to_numpy()[piece]]
            + [np.interp(at, times, table[name]) for name in STATE]
        )
        for error in (0.0, section["beyond"]["inertia_error_pct"]):
            real = plant(given, inertia_factor=1.0 + error / 100.0)
            step = 1.0 / section["resampling_hz"]
            commands = {
                "open loop": open_loop(given, step, plan[:, :3]),
                "closed loop on the plan": _tracking(section, given, step, plan),
                "eigenaxis law": controller(section, given, case),
            }
            for name, command in commands.items():
                row, flown = _fly(section, given, real, command, case, duration)
                converged = held.solution.converged and result.solution.converged
                rows.append(
                    {
                        "turn": turn,
                        "inertia_error_pct": error,
                        "control": name,
                        "plan_converged": converged,
                    }
                    | row
                )
                tables.append(flown.assign(turn=turn, inertia_error_pct=error, control=name))
    return {
        "tracking": pd.DataFrame(rows),
        "tracking-flights": pd.concat(tables, ignore_index=True),
    }


def _tracking(section: Config, given: Parameters, step: float, plan: np.ndarray) -> Command:
    entry = section["beyond"]["tracking"]
    wn, zeta = entry["natural_frequency_rad_s"], entry["damping_ratio"]
    # A small turn's error has twice its vector part as angle: stiffness 2 wn^2 makes it wn^2.
    return Command(
        TRACKING,
        2.0 * wn * wn,
        2.0 * zeta * wn,
        2.0 * wn * wn * entry["integral_per_s"],
        given.inertia,
        given.initial,
        0,
        step,
        plan,
    )


def _fly(
    section: Config, given: Parameters, real: Plant, command: Command, case: str, duration: float
) -> tuple[dict, pd.DataFrame]:
    flown = run(given, real, command, duration, section["numerics"]["step_s"])
    target = tuple(given.targets[case])
    error = np.degrees(
        [turn_angle(error_quaternion(tuple(q), target)) for q in flown[STATE[:4]].to_numpy()]
    )
    torque = np.linalg.norm(flown[TORQUE], axis=1)
    rate = np.degrees(np.linalg.norm(flown[STATE[4:]].to_numpy()[-1]))
    momentum = np.abs(flown[["h_x", "h_y", "h_z"]].to_numpy()).max() / given.momentum
    return (
        {
            "pointing_error_deg": float(error[-1]),
            "rate_deg_s": float(rate),
            "torque_used_N_m_s": float(np.trapezoid(torque, flown["time_s"])),
            "peak_momentum_pct": 100.0 * float(momentum),
        },
        flown[["time_s"]].assign(error_deg=error, torque_N_m=torque),
    )
