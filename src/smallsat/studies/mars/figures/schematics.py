"""The document's explanatory figures, drawn from the study's own parameters.

Each function returns the figure and the table of what it draws.
"""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.patches import FancyBboxPatch, Rectangle, Wedge
from matplotlib.patheffects import withStroke
from matplotlib.pyplot import figure as new_figure
from matplotlib.pyplot import subplots
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from smallsat.drawing.figure import Drawing
from smallsat.dynamics.orbits.circular_orbits import CircularOrbit, orbit_frame, position
from smallsat.dynamics.units import KM
from smallsat.studies.mars.figures.colours import BODY_COLOURS, DAY_COLOUR, NIGHT_COLOUR
from smallsat.studies.mars.figures.scenes import view
from smallsat.studies.mars.parameters import Parameters


def mission_geometry(parameters: Parameters) -> Drawing:
    """Both orbits at time zero from above the inertial third axis, to scale; the night side."""
    figure, axes = subplots(figsize=(4.6, 4.6))
    mars, gmo_radius = parameters.mars_radius / KM, parameters.gmo.radius / KM
    edge = 1.3 * gmo_radius
    axes.add_patch(Rectangle((-edge, -edge), 2 * edge, edge, color="#e8e8ee", lw=0, zorder=0))
    orbits = {"nano-satellite": (parameters.lmo, "C0"), "mothercraft": (parameters.gmo, "C3")}
    rows = []
    for name, (orbit, colour) in orbits.items():
        period = 2.0 * np.pi / orbit.rate
        track = np.array([position(orbit, t) for t in np.linspace(0.0, period, 361)]) / KM
        axes.plot(*track[:, :2].T, color=colour, lw=1.1)
        x, y, z = np.array(position(orbit, 0.0)) / KM
        axes.plot(x, y, "o", color=colour, ms=6, zorder=4)
        rows.append({"item": name, "x_km": x, "y_km": y, "z_km": z})
    gmo = np.array(position(parameters.gmo, 0.0)) / KM
    towards, half = np.degrees(np.arctan2(gmo[1], gmo[0])), np.degrees(parameters.visibility)
    axes.add_patch(
        Wedge((0, 0), gmo_radius, towards - half, towards + half, color="C3", alpha=0.12, lw=0)
    )
    for start, colour in ((0, DAY_COLOUR), (180, NIGHT_COLOUR)):
        axes.add_patch(Wedge((0, 0), mars, start, start + 180, color=colour, lw=0, zorder=3))
    for x in (-0.6, 0.0, 0.6):
        axes.annotate(
            "",
            (x * gmo_radius, 0.82 * edge),
            (x * gmo_radius, 0.97 * edge),
            arrowprops={"arrowstyle": "->", "color": "C4", "lw": 1.5},
        )
    note: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8}
    axes.text(0.3 * gmo_radius, 0.9 * edge, "sunlight", color="C4", **note)
    axes.text(0.62 * gmo_radius, -0.94 * edge, "night side", color="0.35", **note)
    axes.text(0.0, 0.34 * gmo_radius, "nano-satellite's orbit", color="C0", **note)
    axes.text(-0.48 * gmo_radius, -1.14 * gmo_radius, "mothercraft", color="C3", **note)
    axes.text(-0.2 * gmo_radius, -0.62 * gmo_radius, f"visible\nwithin {half:g}°", **note)
    axes.set(xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal")
    axes.set_xlabel("$n_1$ [km]")
    axes.set_ylabel("$n_2$ [km], towards the Sun")
    axes.grid(visible=False)
    return figure, pd.DataFrame(rows)


def body_frame(parameters: Parameters) -> Drawing:
    """The body axes and what looks along them, on the uniform box with the given inertia."""
    first, second, third = parameters.inertia
    squares = np.array([second + third - first, first + third - second, first + second - third])
    # Side lengths up to a factor; a thin plate is drawn where the inertias allow no box.
    sides = np.sqrt(np.maximum(squares, 0.02 * squares.max()))
    sides /= sides.max()
    figure = new_figure(figsize=(4.6, 3.0))
    figure.set_layout_engine("none")
    axes = view(figure, (-0.05, -0.24, 1.1, 1.3), 1.3, 1.15, elevation=24, azimuth=-60)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * sides / 2
    quads = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
    colours = ["#d9d9d9"] * 5 + ["#9fc3e0"]
    axes.add_collection3d(
        Poly3DCollection(
            corners[np.array(quads)], facecolors=colours, edgecolors="0.4", alpha=0.75, lw=0.7
        )
    )
    uses = ("sensor", "", "solar panel")
    beside = ("left", "left", "center")
    rows = []
    for i, (direction, use) in enumerate(zip(np.eye(3), uses, strict=True)):
        label = f"$b_{i + 1}$" + (f": {use}" if use else "")
        _arrow(
            axes, direction * sides[i] / 2, direction * 0.75, label, BODY_COLOURS[i], side=beside[i]
        )
        rows.append(
            {"axis": f"b{i + 1}", "use": use, "side": sides[i], "inertia": parameters.inertia[i]}
        )
    _arrow(
        axes, [-sides[0] / 2, 0, 0], [-0.85, 0, 0], "$-b_1$: antenna", BODY_COLOURS[0], ":", "right"
    )
    rows.append({"axis": "-b1", "use": "antenna", "side": sides[0], "inertia": first})
    return figure, pd.DataFrame(rows)


def orbit_angles(orbit: CircularOrbit) -> Drawing:
    """Inertial and orbit frame with the three Euler angles, for an orbit at time zero."""
    figure = new_figure(figsize=(5.2, 3.2))
    figure.set_layout_engine("none")
    # From here the orbit lies open, and the inertial axes cross it at once and end clear of it.
    axes = view(figure, (-0.2, -0.577, 1.4, 2.0), 1.0, 0.85, elevation=24, azimuth=-48)
    frame = np.array(orbit_frame(orbit, 0.0))
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    equator = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    node = np.array([np.cos(orbit.raan), np.sin(orbit.raan), 0.0])
    quarter = np.cross(frame[2], node)
    track = np.cos(turn)[:, None] * node + np.sin(turn)[:, None] * quarter
    for points, colour in ((equator, "0.55"), (track, "C0")):
        axes.plot(*points.T, color=colour, lw=1.0)
        axes.add_collection3d(Poly3DCollection([points], facecolors=colour, alpha=0.08))
    axes.plot(*np.array([-node, node]).T, color="0.4", lw=0.8, ls="--")
    for i, direction in enumerate(np.eye(3)):
        _arrow(axes, np.zeros(3), (1.45, 1.1, 0.85)[i] * direction, f"$n_{i + 1}$", "0.3")
    tip = frame[0]
    axes.plot(*np.array([np.zeros(3), tip]).T, color="C0", lw=1.2)
    axes.plot(*tip, "o", color="black", ms=5)
    names = ("$i_r$", r"$i_\theta$", "$i_h$")
    for direction, label, colour in zip(frame, names, BODY_COLOURS, strict=False):
        _arrow(axes, tip, 0.45 * direction, label, colour)

    x_axis, up = np.eye(3)[0], np.array([0.0, 0.0, 1.0])
    across = np.cross(up, x_axis)
    arcs = {
        r"$\Omega$": (0.45, orbit.raan, x_axis, across),
        r"$\theta$": (0.45, orbit.argument_of_latitude, node, quarter),
        # Between the planes, drawn on the side away from the satellite.
        "$i$": (0.8, orbit.inclination, np.cross(node, up), -up),
    }
    rows = []
    for label, (radius, angle, start, end) in arcs.items():
        span = np.linspace(0.0, angle, 41)[:, None]
        arc = radius * (np.cos(span) * start + np.sin(span) * end)
        axes.plot(*arc.T, color="C1", lw=1.4)
        _label(axes, 1.2 * arc[len(arc) // 2], label, "C1")
        rows.append({"angle": label.strip("$\\"), "degrees": np.degrees(angle)})
    return figure, pd.DataFrame(rows)


def state_machine(visibility_deg: float) -> Drawing:
    """The mission's three modes and the conditions that lead to each (Table 7)."""
    figure, axes = subplots(figsize=(6.3, 3.2))
    axes.set(xlim=(0, 10), ylim=(0, 5.2))
    axes.set_axis_off()
    limit = f"{visibility_deg:g}°"
    sunlit, dark = r"$r_{LMO}\cdot n_2 > 0$", r"$r_{LMO}\cdot n_2 \leq 0$"
    near, far = rf"$\alpha \leq {visibility_deg:g}°$", rf"$\alpha > {visibility_deg:g}°$"
    places = {"Sun pointing": (5.0, 4.4), "GMO pointing": (1.5, 0.8), "nadir pointing": (8.5, 0.8)}
    colours = {"Sun pointing": "C4", "GMO pointing": "C2", "nadir pointing": "C0"}
    for name, (x, y) in places.items():
        axes.add_patch(
            FancyBboxPatch(
                (x - 1.15, y - 0.4),
                2.3,
                0.8,
                boxstyle="round,pad=0.08",
                fc="white",
                ec=colours[name],
                lw=1.6,
            )
        )
        axes.text(x, y, name, ha="center", va="center")
    edges = (
        ("GMO pointing", "Sun pointing", sunlit, (1.75, 1.35), (3.7, 4.2), (1.9, 3.1)),
        ("Sun pointing", "GMO pointing", f"{dark}\n{near}", (4.2, 3.9), (2.4, 1.35), (4.15, 2.35)),
        ("Sun pointing", "nadir pointing", f"{dark}\n{far}", (5.8, 3.9), (7.6, 1.35), (5.85, 2.35)),
        ("nadir pointing", "Sun pointing", sunlit, (8.25, 1.35), (6.3, 4.2), (8.1, 3.1)),
        ("GMO pointing", "nadir pointing", f"{dark}, {far}", (2.8, 1.0), (7.2, 1.0), (5.0, 1.25)),
        ("nadir pointing", "GMO pointing", f"{dark}, {near}", (7.2, 0.6), (2.8, 0.6), (5.0, 0.3)),
    )
    for _, _, text, start, end, at in edges:
        axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": "0.3"})
        axes.text(*at, text, ha="center", va="center", fontsize=8)
    axes.text(9.95, 5.0, r"$\alpha$: angle between $r_{LMO}$ and $r_{GMO}$", ha="right", fontsize=8)
    rows = [{"from": a, "to": b, "limit": limit} for a, b, *_ in edges]
    return figure, pd.DataFrame(rows)


def _arrow(
    axes: Axes3D, start, along, label: str, colour: str, style: str = "-", side: str = "center"
) -> None:
    axes.quiver(*start, *along, color=colour, lw=1.6, ls=style, arrow_length_ratio=0.15, zorder=9)
    distance = 1.18 if side == "center" else 1.04
    _label(axes, np.asarray(start) + distance * np.asarray(along), label, colour, side)


def _label(axes: Axes3D, at, label: str, colour: str, side: str = "center") -> None:
    text = axes.text(*at, label, color=colour, ha=side, va="center", zorder=20)
    text.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
