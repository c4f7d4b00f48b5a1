"""Beyond the document: longer times, closed-loop tracking, and the wheels' degradation."""

from math import nan

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle
from smallsat.evidence.not_converged import NotConverged
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.flights import controller
from smallsat.studies.slew.methods.guidance_problem import tilts
from smallsat.studies.slew.methods.minimum_time import fastest, guess, not_found
from smallsat.studies.slew.methods.one_axis import eigenaxis_time
from smallsat.studies.slew.methods.plans import (
    HELD_COLUMNS,
    SWEEP_STARTS,
    best_plan,
    guidance_model,
    held_if_converged,
    held_table,
    joined,
    slew_of,
    summary,
    unsolved,
)
from smallsat.studies.slew.model.simulation import TRACKING, Command, Plant, open_loop, plant, run
from smallsat.studies.slew.parameters import MILLI, Parameters

STATE = ["q_1", "q_2", "q_3", "q_4", "omega_x", "omega_y", "omega_z"]
TORQUE = ["u_x", "u_y", "u_z"]
# In the degradation sweep the torque-optimal turn takes this much longer than the fastest one.
SLACK = 1.1


def half_mesh(section: Configuration) -> Mesh:
    """Segments of the 180 deg turn."""
    entry = section.manoeuvre.half
    return Mesh(entry.segments, entry.segment_nodes)


Tables = tuple[dict[str, pd.DataFrame], list[NotConverged]]


def trade_off(section: Configuration, parameters: Parameters) -> Tables:
    """Minimum-torque plans of the larger turn for longer times; those that did not converge."""
    model = guidance_model(parameters)
    rows, tables, seconds = [], [], []
    missing: list[NotConverged] = []
    for duration in section.beyond.trade_off_s:
        name = f"{parameters.names['half']}, {duration:g} s"
        slew = slew_of(model, parameters, "half", half_mesh(section), duration)
        result, starts = best_plan(slew, section.numerics, SWEEP_STARTS)
        missing += unsolved(f"trade-off, {name}", result, f"{len(starts)} starts")
        held, failed = held_if_converged(slew, f"trade-off, {name}", result, section.numerics)
        missing += failed
        rows.append(summary(model, name, result, starts, held))
        rows[-1]["held_converged"] = bool(held and held.solution.converged)
        if held and held.solution.converged:
            tables.append(held_table(model, held, name))
        seconds.append({"plan": name, "seconds": result.seconds})
    return {
        "trade-off": pd.DataFrame(rows),
        "trade-off-plans": joined(tables, HELD_COLUMNS),
        "trade-off-seconds": pd.DataFrame(seconds),
    }, missing


def degradation(section: Configuration, parameters: Parameters) -> Tables:
    """Least time of the larger turn, and least torque in a tenth more, over the wheels' torque."""
    wheels, target = section.wheels, parameters.targets["half"]
    healthy = wheels.torque_mN_m * MILLI / (wheels.torque_share_pct / 100.0)
    known = wheels.torque_share_pct
    axis = parameters.axis("half")
    rows = []
    missing: list[NotConverged] = []
    for share in section.beyond.torque_shares_pct:
        torque = healthy * share / 100.0
        # Without other torques, times go with the root of the torque; a guess, nothing more. Where
        # the wheels fill, they go slower than that.
        about = guess(parameters, "half") * np.sqrt(known / share)
        alone = eigenaxis_time(
            np.radians(parameters.angle_deg("half")),
            float(axis @ parameters.inertia @ axis),
            torque,
            parameters.momentum,
        )
        model = guidance_model(parameters, torque, about)
        found = fastest(
            model,
            parameters.initial,
            target,
            about,
            (0.5 * about, max(2.0 * about, 1.5 * alone)),
            half_mesh(section),
            tilts(SWEEP_STARTS, section.numerics.seed),
        )
        row = {
            "torque_share_pct": share,
            "torque_mN_m": torque / MILLI,
            "least_time_s": found.duration,
            "least_time_converged": found.converged,
            "momentum_limited": found.momentum_limited,
            "plan_time_s": nan,
            "plan_converged": False,
            "cost_N_m_s": nan,
            "largest_peak_momentum_pct": nan,
        }
        if not found.converged:
            missing.append(not_found(f"least time with {share:g} % of the torque", found))
        if found.collocated.solution.converged:
            least = found.duration if found.converged else found.collocated.duration
            slew = slew_of(model, parameters, "half", half_mesh(section), SLACK * least)
            plan, starts = best_plan(slew, section.numerics, SWEEP_STARTS)
            peaks = (
                np.abs(plan.plan.states[:, 7:]).max() * model.momentum_unit / parameters.momentum
            )
            row |= {
                "plan_time_s": plan.duration,
                "plan_converged": plan.solution.converged,
            }
            missing += unsolved(
                f"least torque with {share:g} % of the torque", plan, f"{len(starts)} starts"
            )
            if plan.solution.converged:
                row |= {
                    "cost_N_m_s": plan.cost,
                    "largest_peak_momentum_pct": 100.0 * float(peaks),
                }
        rows.append(row)
    return {"degradation": pd.DataFrame(rows)}, missing


def tracking(section: Configuration, parameters: Parameters) -> Tables:
    """The optimal plan followed in closed loop, beside open loop and the eigenaxis law.

    The plan leaves a margin of torque to the controller. Flown in the fuller model with and without
    an error of the inertia; drag is on.
    """
    entry = section.beyond.tracking
    margin = 1.0 - entry.torque_margin_pct / 100.0
    model = guidance_model(parameters, margin * parameters.torque)
    manoeuvre = section.manoeuvre
    turns = {
        parameters.names["quarter"]: ("quarter", parameters.duration),
        parameters.names["half"]: ("half", max(section.beyond.trade_off_s)),
    }
    rows, tables = [], []
    missing: list[NotConverged] = []
    for turn, (case, duration) in turns.items():
        mesh = Mesh(manoeuvre[case].segments, manoeuvre[case].segment_nodes)
        name = f"plan to follow, {turn} in {duration:g} s"
        slew = slew_of(model, parameters, case, mesh, duration)
        result, starts = best_plan(slew, section.numerics, SWEEP_STARTS)
        missing += unsolved(name, result, f"{len(starts)} starts")
        held, failed = held_if_converged(slew, name, result, section.numerics)
        missing += failed
        plan = None
        if held and held.solution.converged:
            plan = _sampled(held_table(model, held, turn), section, duration)
        for error in (0.0, section.beyond.inertia_error_pct):
            real = plant(parameters, inertia_factor=1.0 + error / 100.0)
            step = 1.0 / section.resampling_hz
            commands: dict[str, Command] = {}
            if plan is not None:
                commands["open loop"] = open_loop(parameters, step, plan[:, :3])
                commands["closed loop on the plan"] = _tracking(section, parameters, step, plan)
            commands["eigenaxis law"] = controller(section.controller, parameters, case)
            for name, command in commands.items():
                row, flown = _simulate(section, parameters, real, command, case, duration)
                rows.append(
                    {
                        "turn": turn,
                        "inertia_error_pct": error,
                        "control": name,
                        "plan_converged": plan is not None,
                    }
                    | row
                )
                tables.append(flown.assign(turn=turn, inertia_error_pct=error, control=name))
    return {
        "tracking": pd.DataFrame(rows),
        "tracking-flights": pd.concat(tables, ignore_index=True),
    }, missing


def _sampled(table: pd.DataFrame, section: Configuration, duration: float) -> np.ndarray:
    """A held plan at the resampling rate, shape (n, 10): torque, quaternion, rate."""
    at = np.arange(round(duration * section.resampling_hz) + 1) / section.resampling_hz
    times = table["time_s"].to_numpy()
    # The torque of a piece holds from its start to its end.
    piece = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    return np.column_stack(
        [table[TORQUE].to_numpy()[piece]] + [np.interp(at, times, table[name]) for name in STATE]
    )


def _tracking(
    section: Configuration, parameters: Parameters, step: float, plan: np.ndarray
) -> Command:
    entry = section.beyond.tracking
    wn, zeta = entry.natural_frequency_rad_s, entry.damping_ratio
    # A small turn's error has twice its vector part as angle: stiffness 2 wn^2 makes it wn^2.
    return Command(
        TRACKING,
        2.0 * wn * wn,
        2.0 * zeta * wn,
        2.0 * wn * wn * entry.integral_per_s,
        parameters.inertia,
        parameters.initial,
        0,
        step,
        plan,
    )


def _simulate(
    section: Configuration,
    parameters: Parameters,
    real: Plant,
    command: Command,
    case: str,
    duration: float,
) -> tuple[dict, pd.DataFrame]:
    flown = run(parameters, real, command, duration, section.numerics.step_s)
    target = tuple(parameters.targets[case])
    error = np.degrees(
        [turn_angle(error_quaternion(tuple(q), target)) for q in flown[STATE[:4]].to_numpy()]
    )
    torque = np.linalg.norm(flown[TORQUE], axis=1)
    rate = np.degrees(np.linalg.norm(flown[STATE[4:]].to_numpy()[-1]))
    momentum = np.abs(flown[["h_x", "h_y", "h_z"]].to_numpy()).max() / parameters.momentum
    return (
        {
            "pointing_error_deg": float(error[-1]),
            "rate_deg_s": float(rate),
            "torque_used_N_m_s": float(np.trapezoid(torque, flown["time_s"])),
            "peak_momentum_pct": 100.0 * float(momentum),
        },
        flown[["time_s"]].assign(error_deg=error, torque_N_m=torque),
    )
