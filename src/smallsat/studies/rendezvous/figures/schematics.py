"""The document's explanatory figures, drawn from the planes, cones and predictions of flown cases.

Each function returns the figure and the table of what it draws.
"""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.dynamics.units import KM
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.figures.cases import (
    INFERRED,
    PHASE_COLOURS,
    PHASE_TITLES,
    draw_cone,
    draw_zone,
)
from smallsat.studies.rendezvous.guidance.controller import memory_for, next_control
from smallsat.studies.rendezvous.guidance.law import PHASES, Law, settings
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.model.environment import orbit_radius
from smallsat.studies.rendezvous.model.geometry import keep_out_normals
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.parameters import law as law_of

EARTH_RADIUS_M = 6378137.0
# Where the Earth of Figure 2.1 is cut off, km from its centre.
FLOOR_KM = 5500.0
# Planes of a horizon that are drawn, counted from the chaser.
DRAWN_PLANES = 7


def predicted(
    law: Law, phase: int, state: np.ndarray, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """States, (N + 1, 6), and velocity changes, (N, 3), that the law plans from a state."""
    record = settings([law])[0]
    stages = law.horizons[phase]
    memory = memory_for(stages)
    next_control(record, phase, state, time, memory, np.zeros(3))
    matrix = transition(rate_matrix(law.mean_motion), law.sample_times[phase])
    states = [state]
    for change in memory.plan:
        moved = states[-1].copy()
        moved[3:] += change
        states.append(matrix @ moved)
    return np.array(states), memory.plan


def frame(section: Flight) -> Drawing:
    """Figure 2.1: the target's frame on its orbit, to scale but for the frame's axes."""
    law = law_of(section, "v-bar")
    radius = orbit_radius(law.mean_motion)
    earth = EARTH_RADIUS_M
    figure, axes = subplots(figsize=(4.6, 2.2))
    turn = np.radians(np.linspace(55.0, 125.0, 141))
    for size, colour in ((earth, "0.35"), (radius, "C0")):
        axes.plot(size / KM * np.cos(turn), size / KM * np.sin(turn), color=colour, lw=1.2)
    axes.fill_between(
        earth / KM * np.cos(turn), earth / KM * np.sin(turn), FLOOR_KM, color="#dfe7ee", lw=0
    )
    place = np.array([0.0, radius / KM])
    axes.plot([0.0, place[0]], [FLOOR_KM, place[1]], color="0.5", lw=0.7, ls="--")
    length = 750.0
    # Counter-clockwise motion as seen from the orbit normal: the velocity points to the left.
    rows = []
    for name, direction, use in (
        ("x", (0.0, 1.0), "radially outwards"),
        ("y", (-1.0, 0.0), "along the velocity"),
    ):
        tip = place + length * np.array(direction)
        axes.annotate(
            "", tuple(tip), tuple(place), arrowprops={"arrowstyle": "-|>", "color": "C1", "lw": 1.6}
        )
        rows.append({"item": name, "right": direction[0], "up": direction[1], "use": use})
    axes.text(80.0, place[1] + 0.8 * length, r"$\hat{x}$ (R-bar)", color="C1")
    axes.text(-1.0 * length, place[1] + 100.0, r"$\hat{y}$ (V-bar)", color="C1", ha="center")
    axes.plot(*place, "o", ms=11, mfc="white", mec="C1", zorder=4)
    axes.plot(*place, "o", ms=3.5, color="C1", zorder=5)
    axes.text(
        place[0] + 90.0,
        earth / KM - 150.0,
        r"$\hat{z}$ out of the page," "\norbit normal",
        color="C1",
        va="top",
    )
    axes.text(-1500.0, 5750.0, "Earth", color="0.35")
    height = (radius - EARTH_RADIUS_M) / KM
    axes.text(
        1050.0, 6850.0, f"target's orbit,\n{height:.0f} km high (inferred)", color="C0", fontsize=8
    )
    axes.set(xlim=(-2600, 2600), ylim=(FLOOR_KM, 7700), aspect="equal")
    axes.set_axis_off()
    rows.append({"item": "z", "right": 0.0, "up": 0.0, "use": "orbit normal, out of the page"})
    rows.append({"item": "orbit radius [km]", "right": 0.0, "up": radius / KM, "use": "inferred"})
    return figure, pd.DataFrame(rows)


def horizon(section: Flight, flights: pd.DataFrame) -> Drawing:
    """Figure 2.2: past, plan and what was flown along the approach axis in Case 1's mid range."""
    law = law_of(section, "v-bar")
    own = flights[(flights["flight"] == "v-bar") & (flights["phase"] != "far")]
    mid = own[own["phase"] == "mid"]
    if mid.empty:
        return _missing("Case 1 does not come to its mid range")
    now = mid.iloc[len(mid) // 3]
    states, changes = predicted(law, 1, now[STATE].to_numpy(dtype=float), float(now["time_s"]))
    step = law.sample_times[1]
    time = (np.arange(len(states))) * step
    past = mid[mid["time_s"] <= now["time_s"]]
    later = own[(own["time_s"] >= now["time_s"]) & (own["time_s"] <= now["time_s"] + time[-1])]
    figure, (top, bottom) = subplots(
        2, 1, figsize=(5.6, 4.0), sharex=True, height_ratios=(1.4, 1.0)
    )
    top.plot(past["time_s"] - now["time_s"], past["y_m"], "o-", color="black", ms=3.5, label="past")
    top.plot(time, states[:, 1], "o--", color="C0", ms=3.5, mfc="white", label="plan at $t_k$")
    top.plot(later["time_s"] - now["time_s"], later["y_m"], color="C1", lw=1.0, label="then flown")
    top.axhline(law.overshoot, color="0.5", lw=0.8, ls=":")
    top.text(
        0.01,
        law.overshoot,
        "$r_2$ (inferred)",
        transform=top.get_yaxis_transform(),
        va="bottom",
        fontsize=7,
        color="0.4",
    )
    top.set_ylabel("along track $y$ [m]")
    top.legend()
    bottom.step(np.r_[past["time_s"] - now["time_s"]], past["dvy_m_s"], where="post", color="black")
    bottom.step(time, np.r_[changes[:, 1], changes[-1, 1]], where="post", color="C0", ls="--")
    bottom.plot(
        0.0, changes[0, 1], "o", color="C1", ms=6, mfc="none", label="applied: the first one"
    )
    bound = law.control_bounds[1]
    for limit in (-bound, bound):
        bottom.axhline(limit, color="0.5", lw=0.8, ls=":")
    bottom.text(
        0.01, bound, "bound", transform=bottom.get_yaxis_transform(), va="top", fontsize=7,
        color="0.4",
    )  # fmt: skip
    bottom.set(xlabel="time from $t_k$ [s]", ylabel=r"$\Delta v_y$ [m/s]")
    bottom.legend(loc="lower right")
    for axes in (top, bottom):
        axes.axvline(0.0, color="0.6", lw=0.8)
        axes.axvspan(0.0, time[-1], color="#f3efe2", zorder=0)
    table = pd.DataFrame(states, columns=STATE).assign(time_s=time, drawn="plan")
    table[CHANGE] = np.vstack([changes, np.full(3, np.nan)])
    return figure, pd.concat(
        [
            past.assign(time_s=past["time_s"] - now["time_s"], drawn="past")[
                ["drawn", "time_s", *STATE, *CHANGE]
            ],
            table,
        ],
        ignore_index=True,
    )


def _missing(words: str) -> Drawing:
    """What stands in the place of a figure whose flight there is not."""
    figure, axes = subplots(figsize=(5.6, 1.5))
    axes.set_axis_off()
    axes.text(0.5, 0.5, words, ha="center", va="center")
    return figure, pd.DataFrame(columns=["drawn", "time_s", *STATE, *CHANGE])


def phases(section: Flight, flights: pd.DataFrame, paths: pd.DataFrame) -> Drawing:
    """Figure 3.1: keep-out zone, approach cone, overshoot plane and docking cone, at two scales."""
    law = law_of(section, "v-bar")
    axis = np.array(law.axis)
    path = paths[paths["flight"] == "v-bar"]
    figure, (wide, near) = subplots(1, 2, figsize=(6.3, 3.4))
    reach = 1.9 * law.keep_out
    limit = 2.1 * law.overshoot
    draw_zone(wide, law.keep_out)
    draw_cone(wide, axis, law.cone_angles[0], 0.0, 1.7 * law.keep_out)
    wide.plot([0.0], [0.0], "ks", ms=4)
    wide.set(xlim=(-0.85 * reach, 1.15 * reach), ylim=(-reach, reach), aspect="equal")
    wide.set_title("rendezvous and approach")
    draw_cone(near, axis, law.cone_angles[1], 0.0, 1.6 * limit, 0.3)
    draw_cone(near, axis, law.cone_angles[2], law.port, 1.6 * limit)
    near.axvline(law.overshoot, color="0.35", lw=1.0, ls="--")
    near.text(law.overshoot, 0.68 * limit / 2, " $r_2$: overshoot\n plane", fontsize=8)
    near.plot([0.0], [0.0], "ks", ms=6)
    near.plot(law.port, 0.0, "^", color="C3", ms=5)
    near.text(law.port, -0.24 * limit / 2, "port", fontsize=8, color="C3", ha="center")
    near.set(xlim=(-0.25 * limit, limit), ylim=(-0.6 * limit, 0.65 * limit), aspect="equal")
    near.set_title("approach and docking")
    wide.text(0.0, -0.6 * law.keep_out, "keep-out\nzone $r_1$", ha="center", fontsize=8)
    wide.text(1.35 * law.keep_out, 0.33 * law.keep_out, "approach\ncone", ha="center", fontsize=8)
    for axes, point, of, name in (
        (wide, law.set_points[0], law.keep_out, "$r_1$"),
        (near, law.set_points[1], law.overshoot, "$r_2$"),
    ):
        axes.plot(point, 0.0, "x", color="black", ms=6, zorder=4)
        axes.annotate(
            f"set point:\n{point / of:.2f} {name}", (point, 0.0), (0.98, 0.03), ha="right",
            textcoords="axes fraction", fontsize=8, arrowprops={"arrowstyle": "-", "lw": 0.6},
        )  # fmt: skip
        for phase in PHASES:
            part = path[path["phase"] == phase]
            axes.plot(
                part["y_m"],
                part["x_m"],
                color=PHASE_COLOURS[phase],
                lw=1.2,
                label=PHASE_TITLES[phase],
                zorder=3,
            )
        axes.set_xlabel("along track $y$ [m]")
        axes.locator_params(nbins=5)
    wide.set_ylabel("radial $x$ [m]")
    handles, labels = wide.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    figure.suptitle(f"Case 1; {INFERRED}, and so are set points", fontsize=7, color="0.4")
    rows = [
        ("keep-out radius r1 [m]", law.keep_out),
        ("overshoot distance r2 [m]", law.overshoot),
        ("port [m]", law.port),
        *[
            (f"half angle, {PHASE_TITLES[name]} [deg]", np.degrees(angle))
            for name, angle in zip(PHASES, law.cone_angles, strict=True)
        ],
        *[
            (f"set point, {PHASE_TITLES[name]} [m]", point)
            for name, point in zip(PHASES, law.set_points, strict=False)
        ],
    ]
    return figure, pd.DataFrame(rows, columns=["item", "value"])


def rotating_planes(section: Flight, flights: pd.DataFrame) -> Drawing:
    """Figure 3.2: the planes of one horizon of the run that is guided around the zone."""
    law = law_of(section, "no-set-point")
    own = flights[(flights["flight"] == "no-set-point") & (flights["phase"] == "far")]
    distance = np.hypot(own["x_m"], own["y_m"])
    near = own[distance < 1.15 * law.keep_out]
    now = near.iloc[len(near) // 3] if len(near) else own.iloc[len(own) // 2]
    state, time = now[STATE].to_numpy(dtype=float), float(now["time_s"])
    stages = law.horizons[0]
    normals = np.empty((stages + 1, 3))
    keep_out_normals(
        state[:3], np.array(law.axis), stages,
        law.plane_rate * law.mean_motion * law.sample_times[0], law.plane_turn, normals,
    )  # fmt: skip
    states, _ = predicted(law, 0, state, time)
    figure, axes = subplots(figsize=(4.8, 4.4))
    draw_zone(axes, law.keep_out)
    draw_cone(axes, np.array(law.axis), law.cone_angles[0], 0.0, 1.7 * law.keep_out)
    chosen = np.unique(np.linspace(0, stages, DRAWN_PLANES).astype(int))
    rows = []
    _planes(axes, normals[chosen], law.keep_out)
    axes.plot(states[:, 1], states[:, 0], "o-", color="C1", ms=2.5, lw=0.9, label="planned states")
    axes.plot(states[chosen, 1], states[chosen, 0], "o", color="C1", ms=5, mfc="white", zorder=4)
    for i in chosen:
        n = normals[i]
        rows.append(
            {
                "stage": int(i),
                "n_x": n[0],
                "n_y": n[1],
                "n_z": n[2],
                "x_m": states[i, 0],
                "y_m": states[i, 1],
            }
        )
    axes.plot(0.0, 0.0, "ks", ms=4)
    edge = 1.75 * law.keep_out
    axes.set(
        xlim=(-edge, edge),
        ylim=(-edge, edge),
        aspect="equal",
        xlabel="along track $y$ [m]",
        ylabel="radial $x$ [m]",
    )
    turn = np.degrees(np.arccos(np.clip(normals[0] @ normals[-1], -1.0, 1.0)))
    axes.set_title(
        f"one horizon of the QP without set point: {len(chosen)} of {stages + 1} planes, turned by "
        f"{turn:.0f}°\n{INFERRED}",
        fontsize=7,
        color="0.4",
    )
    axes.legend(loc="upper left")
    return figure, pd.DataFrame(rows)


def _planes(axes: Axes, normals: np.ndarray, radius: float) -> None:
    """Cuts of planes with the orbit's plane: tangents of the circle, with their normals."""
    for number, normal in enumerate(normals):
        shade = str(0.15 + 0.55 * number / max(len(normals) - 1, 1))
        flat = normal[:2] / np.linalg.norm(normal[:2])
        across = np.array([-flat[1], flat[0]])
        ends = np.array([radius * flat + sign * 0.75 * radius * across for sign in (-1, 1)])
        axes.plot(ends[:, 1], ends[:, 0], color=shade, lw=1.0)
        tip = 1.22 * radius * flat
        axes.annotate(
            "",
            tip[::-1],
            (radius * flat)[::-1],
            arrowprops={"arrowstyle": "-|>", "color": shade, "lw": 0.9},
        )
