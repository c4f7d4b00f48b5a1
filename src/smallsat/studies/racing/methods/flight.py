"""Plans and solves of the listing flown anew, and what the rings say of them.

A plan is flown by a Runge-Kutta method through all segments without a stop, while the optimiser
used closed forms segment by segment. A solve of the listing is flown by an adaptive method of order
8.
"""

from typing import Any

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.clohessy_wiltshire import costate_transition, rate_matrix
from smallsat.studies.racing.methods.course_program import Plan
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.model.shooting import law_of, rate, thrust_of

# Steps of a held control in a flight, more where the orbit turns by more than this, rad, in one of
# them; the points of a segment that are kept.
STEPS, TURN, MOST = 3, 5e-3, 100.0
POINTS = 61
STATE = ["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"]
THRUST = ["ux_m_s2", "uy_m_s2", "uz_m_s2"]
COSTATE = ["px", "py", "pz", "pvx", "pvy", "pvz"]


@compiled
def _propagate(state, controls, durations, a, steps):
    """States (m, N steps + 1, 6) by the classical method of order 4."""
    segments, intervals = controls.shape[:2]
    flown = np.empty((segments, intervals * steps + 1, 6))
    x = state.copy()
    push = np.zeros(6)
    for k in range(segments):
        h = durations[k] / (intervals * steps)
        flown[k, 0] = x
        for i in range(intervals * steps):
            push[3:] = controls[k, i // steps]
            k1 = a @ x + push
            k2 = a @ (x + 0.5 * h * k1) + push
            k3 = a @ (x + 0.5 * h * k2) + push
            k4 = a @ (x + h * k3) + push
            x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            flown[k, i + 1] = x
    return flown


def propagate_plan(plan: Plan, mean_motion: float) -> np.ndarray:
    """States (m, N steps + 1, 6) of a plan, flown from its start through all segments."""
    return _propagate(
        plan.starts[0],
        plan.controls,
        plan.durations,
        rate_matrix(mean_motion),
        _steps(plan, mean_motion),
    )


def _steps(plan: Plan, mean_motion: float) -> int:
    """Steps of a held control: those of slow races take long."""
    piece = float(np.max(plan.durations)) / plan.controls.shape[1]
    return STEPS * max(1, int(np.ceil(min(MOST, mean_motion * piece / STEPS / TURN))))


def plan_table(plan: Plan, mean_motion: float) -> pd.DataFrame:
    """Tidy table of a flown plan: time, state, thrust and costates by segment."""
    flown = propagate_plan(plan, mean_motion)
    segments, points = flown.shape[:2]
    parts = []
    began = 0.0
    for k in range(segments):
        times = np.linspace(0.0, plan.durations[k], points)
        steps = (points - 1) // plan.controls.shape[1]
        held = np.minimum(np.arange(points) // steps, plan.controls.shape[1] - 1)
        costates = np.array([costate_transition(mean_motion, t) @ plan.costates[k] for t in times])
        parts.append(_part(k, began + times, flown[k], plan.controls[k, held], costates))
        began += plan.durations[k]
    return pd.concat(parts, ignore_index=True)


def _part(
    segment: int, times: np.ndarray, states: np.ndarray, thrust: np.ndarray, costates: np.ndarray
) -> pd.DataFrame:
    table = pd.DataFrame(
        np.column_stack([times, states, thrust, costates]),
        columns=["time_s", *STATE, *THRUST, *COSTATE],
    )
    table.insert(0, "segment", segment)
    return table


def propagate_segment(
    state: np.ndarray,
    costate: np.ndarray,
    duration: float,
    cubesat: CubeSat,
    mean_motion: float,
    deadzone: float,
    tolerance: float,
    transposed: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """Times (p,) and states with costates (p, 12) of a solve of the listing, adaptively flown."""
    law, limits = law_of(cubesat)

    def moved(_, y):
        out = np.empty(12)
        rate(y, mean_motion, transposed, law, limits, deadzone, out)
        return out

    flown = solve_ivp(
        moved,
        (0.0, duration),
        np.r_[state, costate],
        method="DOP853",
        rtol=max(tolerance, 1e-13),
        atol=tolerance,
        t_eval=np.linspace(0.0, duration, POINTS),
    )
    return flown.t, flown.y.T


def segment_table(
    number: int,
    began: float,
    times: np.ndarray,
    flown: np.ndarray,
    cubesat: CubeSat,
    deadzone: float,
) -> pd.DataFrame:
    """Tidy table of a flown solve of the listing, as `plan_table`."""
    law, limits = law_of(cubesat)
    thrust = np.array([thrust_of(y[9:].copy(), law, limits, deadzone) for y in flown])
    return _part(number, began + times, flown[:, :6], thrust, flown[:, 6:])


# Columns of the rows that `ring_rows` makes.
RING = ["ring", "arrival_s", "miss_m", "plane_m", "angle_deg", "speed_m_s", "size_m"]
RING += ["missed", "off_axis"]


def ring_rows(
    course: Course, ends: np.ndarray, arrivals: np.ndarray, plane: float, pointing: float
) -> list[dict[str, Any]]:
    """What each ring says of the state (l, 6) at the end of its segment (Section I, rule 3)."""
    rows = []
    for k in range(course.rings):
        offset, velocity = ends[k, :3] - course.centres[k], ends[k, 3:]
        miss = float(np.linalg.norm(offset))
        out = float(abs(offset @ course.normals[k]))
        speed = float(np.linalg.norm(velocity))
        across = float(np.linalg.norm(np.cross(velocity, course.normals[k])))
        angle = float(np.arctan2(across, velocity @ course.normals[k]))
        rows.append(
            {
                "ring": k + 1,
                "arrival_s": float(arrivals[k]),
                "miss_m": miss,
                "plane_m": out,
                "angle_deg": float(np.degrees(angle)),
                "speed_m_s": speed,
                "size_m": float(course.sizes[k]),
                "missed": bool(miss > course.sizes[k] or out > plane),
                "off_axis": bool(angle > pointing),
            }
        )
    return rows


def least_time(distance: float, speed: float, thrust: float) -> float:
    """Time for a distance on a straight line at full thrust from a speed (Section IV.A)."""
    return (-speed + float(np.sqrt(speed**2 + 2.0 * thrust * distance))) / thrust


def minimum_cost(starts: np.ndarray, course: Course, thrust: float) -> float:
    """The document's "minimum possible cost", from the state at each segment's start.

    Each term is the time on a straight line to the next centre at full thrust, from that speed.
    """
    targets = np.vstack([course.centres, course.end])
    return sum(
        least_time(
            float(np.linalg.norm(target - start[:3])), float(np.linalg.norm(start[3:])), thrust
        )
        for start, target in zip(starts, targets, strict=True)
    )


def residual(plan: Plan, flown: np.ndarray, cubesat: CubeSat, course: Course | None) -> float:
    """Largest error of a flown plan: m off a ring's centre or the finish, m/s off its direction.

    Also what the thrust exceeds its limit by, relative to it.
    """
    ends = flown[:, -1]
    errors = [np.abs(ends - plan.ends).max()]
    if course is not None:
        passed = ends[: course.rings]
        across = np.cross(passed[:, 3:], course.normals)
        errors.append(np.linalg.norm(passed[:, :3] - course.centres, axis=1).max())
        errors.append(np.linalg.norm(across, axis=1).max())
    if cubesat.axis_thrust:
        used = np.abs(plan.controls) / np.array(cubesat.axis_thrust)
    else:
        used = np.linalg.norm(plan.controls, axis=2) / cubesat.thrust
    errors.append(max(used.max() - 1.0, 0.0))
    return float(max(errors))
