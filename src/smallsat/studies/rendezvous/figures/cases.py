"""Figures of the manoeuvres of Section 3.6. Each function returns the figure and what it draws."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from matplotlib.pyplot import figure as new_figure
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.dynamics.units import MINUTE
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.model.columns import CHANGE
from smallsat.studies.rendezvous.parameters import law as law_of

PHASE_COLOURS = {"far": "C0", "mid": "C2", "final": "C1"}
PHASE_TITLES = {"far": "far range", "mid": "mid range", "final": "final approach"}
CASE_COLOURS = {"v-bar": "C1", "no-set-point": "C0", "lp": "C4"}
CASE_TITLES = {"v-bar": "QP, set point", "no-set-point": "QP, no set point", "lp": "LP"}
ZONE = "#d9a3a3"
CONE = "#9fc3e0"
INFERRED = "zones, cones, margins and rotation are inferred"


def draw_zone(axes: Axes, radius: float) -> None:
    """The keep-out circle, in the orbit's plane; y to the right, x up."""
    axes.add_patch(Circle((0.0, 0.0), radius, fc=ZONE, ec="0.5", lw=0.8, alpha=0.45, zorder=0))


def cone_outline(axis: np.ndarray, half_angle: float, tip: float, length: float) -> np.ndarray:
    """Corners (y, x) of a cone's cut with the orbit's plane, tip on the axis, shape (3, 2)."""
    along = axis[:2]
    across = np.array([-along[1], along[0]])
    start = tip * along
    ends = [start + length * (along + sign * np.tan(half_angle) * across) for sign in (-1, 1)]
    return np.array([start, *ends])[:, ::-1]


def draw_cone(axes: Axes, axis, half_angle: float, tip: float, length: float, alpha=0.45) -> None:
    """A cone's cut with the orbit's plane."""
    axes.add_patch(
        Polygon(
            cone_outline(axis, half_angle, tip, length),
            fc=CONE,
            ec="0.5",
            lw=0.6,
            alpha=alpha,
            zorder=0.5,
        )
    )


def manoeuvre(section: Flight, case: str, flights: pd.DataFrame, paths: pd.DataFrame) -> Drawing:
    """One case: the way in the orbit's plane at three scales, and the thrust over time."""
    law = law_of(section, case)
    flight = flights[flights["flight"] == case]
    path = paths[paths["flight"] == case]
    figure = new_figure(figsize=(6.3, 5.4))
    grid = figure.add_gridspec(2, 3, height_ratios=(1.25, 1.0))
    wide, near, dock = (figure.add_subplot(grid[0, i]) for i in range(3))
    thrust = figure.add_subplot(grid[1, :])

    starts = {phase: _first(flight, phase) for phase in PHASES}
    ends = {"far": starts["mid"], "mid": starts["final"], "final": flight.iloc[-1]}
    _way(wide, path)
    draw_zone(wide, law.keep_out)
    reach = np.hypot(ends["far"]["x_m"], ends["far"]["y_m"])
    draw_cone(wide, law.axis_at(ends["far"]["time_s"]), law.cone_angles[0], 0.0, 1.2 * reach)
    _arrows(wide, flight[flight["phase"] == "far"], 700.0)
    wide.set_title("whole manoeuvre")

    _way(near, path[path["phase"] != "far"])
    for moment, alpha in ((ends["far"]["time_s"], 0.2), (ends["mid"]["time_s"], 0.5)):
        draw_cone(near, law.axis_at(moment), law.cone_angles[1], 0.0, 1.1 * reach, alpha)
    near.add_patch(Circle((0, 0), law.overshoot, fc="none", ec="0.3", lw=0.8))
    _arrows(near, flight[flight["phase"] == "mid"], 0.55 * reach)
    near.set_title("mid range")

    _way(dock, path[path["phase"] == "final"])
    limit = np.hypot(ends["mid"]["x_m"], ends["mid"]["y_m"])
    for moment, alpha in ((ends["mid"]["time_s"], 0.2), (ends["final"]["time_s"], 0.5)):
        axis = law.axis_at(moment)
        draw_cone(dock, axis, law.cone_angles[2], law.port, 1.1 * limit, alpha)
        dock.plot(law.port * axis[1], law.port * axis[0], "k^", ms=4, zorder=4)
    dock.set_title("final approach")
    for axes, phase in ((near, "mid"), (dock, "final")):
        if not (flight["phase"] == phase).any():
            axes.text(0.5, 0.5, "not reached", transform=axes.transAxes, ha="center", va="center")
    for axes in (wide, near, dock):
        axes.plot(0.0, 0.0, "ks", ms=3, zorder=4)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("along track $y$ [m]")
        axes.locator_params(nbins=3)
    wide.set_ylabel("radial $x$ [m]")

    pulses = thrust_history(section, flight)
    for phase in PHASES:
        own = pulses[pulses["phase"] == phase]
        thrust.vlines(
            own["time_s"], 0.0, own["force_N"], color=PHASE_COLOURS[phase], lw=0.9,
            label=PHASE_TITLES[phase],
        )  # fmt: skip
        thrust.plot(own["time_s"], own["force_N"], ".", color=PHASE_COLOURS[phase], ms=3)
    thrust.set(
        xlabel="time [s]", ylabel="resultant thrust,\nmean over longest pulse [N]", ylim=(0.0, None)
    )
    thrust.set_xlim(0.0, float(flight["time_s"].iloc[-1]))
    thrust.legend(ncols=3, loc="upper right")
    thrust.set_title(INFERRED, fontsize=7, loc="left", color="0.4")
    return figure, _drawn(path, pulses)


def thrust_history(section: Flight, flight: pd.DataFrame) -> pd.DataFrame:
    """Resultant thrust of each step, N, averaged over the longest pulse that its phase allows.

    Thrusters are on or off; a step's velocity change over the bound on it is the part of the
    longest pulse for which they burn.
    """
    force = section.spacecraft.thruster_N
    rows = []
    for row in flight[flight["phase"] != "end"].to_dict("records"):
        bound = section.phases[row["phase"]].control_bound_m_s
        length = np.linalg.norm([row[name] for name in CHANGE])
        rows.append((row["phase"], row["time_s"], force * length / bound))
    return pd.DataFrame(rows, columns=["phase", "time_s", "force_N"])


def comparison(section: Flight, flights: pd.DataFrame, paths: pd.DataFrame) -> Drawing:
    """Figure 3.6: the far range with and without set point, and as a linear program."""
    law = law_of(section, "v-bar")
    figure, (wide, near) = subplots(1, 2, figsize=(6.3, 3.5))
    drawn = []
    for case, colour in CASE_COLOURS.items():
        path = paths[paths["flight"] == case]
        if path.empty:
            continue
        seconds = float(flights[flights["flight"] == case]["time_s"].iloc[-1])
        minutes = seconds / MINUTE
        # The time limit ends what has no room for a step more.
        in_time = seconds + law.sample_times[2] <= law.time_limit
        docked = in_time and (flights[flights["flight"] == case]["phase"] == "final").any()
        label = f"{CASE_TITLES[case]}: " + (f"{minutes:.1f} min" if docked else "does not dock")
        for axes in (wide, near):
            axes.plot(path["y_m"], path["x_m"], color=colour, lw=1.1, label=label)
        drawn.append(path)
    edge = 1.9 * law.keep_out
    for axes in (wide, near):
        draw_zone(axes, law.keep_out)
        draw_cone(axes, np.array(law.axis), law.cone_angles[0], 0.0, 1.6 * law.keep_out)
        axes.plot(0.0, 0.0, "ks", ms=3)
        axes.set_xlabel("along track $y$ [m]")
        axes.locator_params(nbins=5)
    wide.set_aspect("equal", adjustable="datalim")
    near.set(
        xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal", title="around the keep-out zone"
    )
    wide.set_ylabel("radial $x$ [m]")
    wide.set_title(INFERRED, fontsize=7, loc="left", color="0.4")
    figure.legend(*wide.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure, pd.concat(drawn)[["flight", "phase", "time_s", "x_m", "y_m", "z_m"]]


def _first(flight: pd.DataFrame, phase: str) -> pd.Series:
    rows = flight[flight["phase"] == phase]
    return rows.iloc[0] if len(rows) else flight.iloc[-1]


def _way(axes: Axes, path: pd.DataFrame) -> None:
    for phase, part in path.groupby("phase", sort=False):
        axes.plot(part["y_m"], part["x_m"], color=PHASE_COLOURS[str(phase)], lw=1.2, zorder=3)


def _arrows(axes: Axes, steps: pd.DataFrame, length: float) -> None:
    """Thrust, opposite to the plume: an arrow a step, the longest of the given length in metres."""
    largest = float(np.hypot(steps["dvx_m_s"], steps["dvy_m_s"]).max()) if len(steps) else 0.0
    if largest > 0.0:
        axes.quiver(
            steps["y_m"], steps["x_m"], steps["dvy_m_s"], steps["dvx_m_s"], angles="xy",
            scale_units="xy", scale=2.5 * largest / length, width=0.006, color="0.35", zorder=2,
        )  # fmt: skip


def _drawn(path: pd.DataFrame, pulses: pd.DataFrame) -> pd.DataFrame:
    way = path[["phase", "time_s", "x_m", "y_m", "z_m"]].assign(drawn="path")
    return pd.concat([way, pulses.assign(drawn="thrust")], ignore_index=True)
