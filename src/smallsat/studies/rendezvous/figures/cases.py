"""Figures of the manoeuvres of Section 3.6. Each function returns the figure and what it draws."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import WIDTH
from smallsat.dynamics.units import MINUTE
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.guidance.law import PHASES, Law
from smallsat.studies.rendezvous.model.columns import CHANGE
from smallsat.studies.rendezvous.parameters import law as law_of

PHASE_COLOURS = {"far": "C0", "mid": "C2", "final": "C1"}
PHASE_TITLES = {"far": "far range", "mid": "mid range", "final": "final approach"}
CASE_COLOURS = {"v-bar": "C1", "no-set-point": "C0", "lp": "C4"}
CASE_TITLES = {"v-bar": "QP, set point", "no-set-point": "QP, no set point", "lp": "LP"}
ZONE = "#d9a3a3"
CONE = "#9fc3e0"
# An axis that lies to the right in the frame of the approach axis, and the place there.
ALONG, ACROSS = np.array([0.0, 1.0, 0.0]), ("along_m", "across_m")
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
    """One case: the way in the orbit's plane, thrust over time, and both later phases.

    These are drawn along and across the approach axis, which turns with the target: there a cone
    stands still, and every point of the way can be compared with it.
    """
    law = law_of(section, case)
    flight, path = (_along_axis(law, table[table["flight"] == case]) for table in (flights, paths))
    figure, ((wide, thrust), (near, dock)) = subplots(
        2, 2, figsize=(WIDTH, 4.45), height_ratios=(1.15, 1.0)
    )
    _way(wide, path, ("y_m", "x_m"))
    _arrows(wide, flight[flight["phase"] == "far"], 700.0, ("y_m", "x_m"), ("dvy_m_s", "dvx_m_s"))
    draw_zone(wide, law.keep_out)
    begins = sorted({float(_first(flight, phase)["time_s"]) for phase in ("mid", "final")})
    for moment, alpha in zip(begins, (0.5, 0.2), strict=False):
        draw_cone(wide, law.axis_at(moment), law.cone_angles[0], 0.0, 1.7 * law.keep_out, alpha)
    wide.set(xlabel="along track $y$ [m]", ylabel="radial $x$ [m]")
    wide.set_title("(a) whole manoeuvre", loc="left")

    for axes, phase, letter, tip in ((near, "mid", "c", 0.0), (dock, "final", "d", law.port)):
        own = path[path["phase"] == phase]
        axes.set(xlabel="along the approach axis [m]", ylabel="across [m]")
        axes.set_title(f"({letter}) {PHASE_TITLES[phase]}", loc="left")
        if own.empty:
            axes.text(0.5, 0.5, "not reached", transform=axes.transAxes, ha="center", va="center")
            continue
        # Towards the cone's tip, and what is left of the next phase.
        _way(axes, path[path["time_s"] >= own["time_s"].iloc[0]], ACROSS)
        half_angle = law.cone_angles[PHASES.index(phase)]
        draw_cone(axes, ALONG, half_angle, tip, 1.1 * own["along_m"].max() - tip)
        outside = abs(own["across_m"].iloc[0]) - np.tan(half_angle) * (own["along_m"].iloc[0] - tip)
        if outside > 0.01:
            axes.set_title(f"begins {outside:.1f} m outside", loc="right", fontsize=8)
    steps = flight[flight["phase"] == "mid"]
    _arrows(near, steps, 0.5 * law.keep_out, ACROSS, ("along_m_s", "across_m_s"))
    near.axvline(law.overshoot, color="0.35", lw=0.9, ls="--")
    near.text(law.overshoot, 0.97, " $r_2$", transform=near.get_xaxis_transform(), va="top")
    dock.plot(law.port, 0.0, "k^", ms=4, zorder=4)
    for axes in (wide, near, dock):
        axes.plot(0.0, 0.0, "ks", ms=3, zorder=4)
        axes.set_aspect("equal", adjustable="datalim")
        axes.locator_params(axis="x", nbins=6)
        axes.locator_params(axis="y", nbins=4)

    pulses = thrust_history(section, flight)
    for phase in PHASES:
        pulse = pulses[pulses["phase"] == phase]
        thrust.vlines(
            pulse["time_s"], 0.0, pulse["force_N"], color=PHASE_COLOURS[phase], lw=0.8,
            label=PHASE_TITLES[phase],
        )  # fmt: skip
        thrust.plot(pulse["time_s"], pulse["force_N"], ".", color=PHASE_COLOURS[phase], ms=2.5)
    thrust.set(xlabel="time [s]", ylabel="mean over longest pulse [N]", ylim=(0.0, None))
    thrust.set_title("(b) resultant thrust", loc="left")
    thrust.set_xlim(0.0, float(flight["time_s"].iloc[-1]))
    figure.legend(*thrust.get_legend_handles_labels(), loc="outside upper right", ncols=3)
    figure.text(0.01, 0.99, INFERRED, fontsize=7, color="0.4", va="top")
    return figure, _drawn(path, pulses)


def _along_axis(law: Law, table: pd.DataFrame) -> pd.DataFrame:
    """States with their place, and where there is one their velocity change, along the axis.

    Adds ``along_m`` and ``across_m``, in the orbit's plane: along the approach axis at that time,
    and across it, a quarter turn from the axis as the figures show the plane; changes likewise.
    """
    axis = np.array([law.axis_at(time)[:2] for time in table["time_s"]]).reshape(-1, 2)
    turned = {}
    for names, ends in ((("x_m", "y_m"), "m"), (("dvx_m_s", "dvy_m_s"), "m_s")):
        if set(names) <= set(table.columns):
            x, y = (table[name].to_numpy() for name in names)
            turned[f"along_{ends}"] = axis[:, 0] * x + axis[:, 1] * y
            turned[f"across_{ends}"] = axis[:, 1] * x - axis[:, 0] * y
    return table.assign(**turned)


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
    figure, (wide, near) = subplots(1, 2, figsize=(WIDTH, 3.2), width_ratios=(1.35, 1.0))
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
    edge = 1.45 * law.keep_out
    marked = {law_of(section, case).set_points[0] for case in CASE_COLOURS} - {0.0}
    for axes in (wide, near):
        draw_zone(axes, law.keep_out)
        draw_cone(axes, np.array(law.axis), law.cone_angles[0], 0.0, 1.4 * law.keep_out)
        axes.plot(0.0, 0.0, "ks", ms=3)
        axes.plot(sorted(marked), np.zeros(len(marked)), "kx", ms=5, zorder=4)
        axes.set_xlabel("along track $y$ [m]")
        axes.locator_params(nbins=5)
    wide.set_aspect("equal", adjustable="datalim")
    near.set(xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal")
    wide.set_ylabel("radial $x$ [m]")
    wide.set_title("whole manoeuvre")
    near.set_title("around the keep-out zone")
    points = "cross: set point of QP and LP" if len(marked) == 1 else "crosses: set points"
    figure.suptitle(f"{points}; {INFERRED}, and so are the LP's weights", fontsize=7, color="0.4")
    figure.legend(*wide.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure, pd.concat(drawn)[["flight", "phase", "time_s", "x_m", "y_m", "z_m"]]


def _first(flight: pd.DataFrame, phase: str) -> pd.Series:
    rows = flight[flight["phase"] == phase]
    return rows.iloc[0] if len(rows) else flight.iloc[-1]


def _way(axes: Axes, path: pd.DataFrame, place: tuple[str, str]) -> None:
    for phase, part in path.groupby("phase", sort=False):
        right, up = (part[name] for name in place)
        axes.plot(right, up, color=PHASE_COLOURS[str(phase)], lw=1.2, zorder=3)


def _arrows(
    axes: Axes, steps: pd.DataFrame, length: float, place: tuple[str, str], change: tuple[str, str]
) -> None:
    """Thrust, opposite to the plume: an arrow a step, the longest of the given length in metres."""
    right, up = (steps[name] for name in change)
    largest = float(np.hypot(right, up).max()) if len(steps) else 0.0
    if largest > 0.0:
        axes.quiver(
            *(steps[name] for name in place), right, up, angles="xy", scale_units="xy",
            scale=2.5 * largest / length, width=0.005, color="0.35", zorder=2,
        )  # fmt: skip


def _drawn(path: pd.DataFrame, pulses: pd.DataFrame) -> pd.DataFrame:
    way = path[["phase", "time_s", "x_m", "y_m", "z_m", "along_m", "across_m"]].assign(drawn="path")
    return pd.concat([way, pulses.assign(drawn="thrust")], ignore_index=True)
