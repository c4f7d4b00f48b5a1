"""The document's block diagrams and the drawing of the spacecraft, from the study's parameters."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch
from matplotlib.patheffects import withStroke
from matplotlib.pyplot import figure as new_figure
from matplotlib.pyplot import subplots
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from smallsat.drawing.figure import Drawing
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.parameters import panels

Boxes = dict[str, tuple[float, float, str]]
Arrows = list[tuple[str, str, str]]
WIDTH, HEIGHT = 2.5, 1.0

LABELS = ("starboard", "fore", "zenith", "port", "aft", "nadir")


def guidance_overview(section: Configuration) -> Drawing:
    """Figure 1: what the guidance takes in and gives out."""
    step, rate = section.onboard.step_s, section.resampling_hz
    boxes: Boxes = {
        "user": (1.6, 4.4, "user inputs\nattitudes, nodes, time,\ntorque limits, guess"),
        "onboard": (1.6, 1.4, f"on-board propagator\n$J_2$ orbit, step {step:g} s"),
        "optimiser": (5.4, 2.9, "Gauss pseudospectral\noptimisation\n(IPOPT here)"),
        "resample": (9.0, 4.4, f"torque profile\nresampled at {rate:g} Hz"),
        "validate": (9.0, 1.4, "open loop in the\nfuller model"),
    }
    arrows: Arrows = [
        ("user", "optimiser", ""),
        ("onboard", "optimiser", "orbital states"),
        ("optimiser", "resample", "node torques"),
        ("resample", "validate", "$u(t)$"),
    ]
    return _diagram(boxes, arrows, (10.8, 5.8), (6.3, 3.0))


def onboard_propagator(section: Configuration) -> Drawing:
    """Figure 17: the on-board propagator."""
    step = section.onboard.step_s
    boxes: Boxes = {
        "elements": (1.6, 4.7, "Keplerian elements\nto state"),
        "orbit": (5.4, 4.7, f"orbit integrator\nthird order, {step:g} s"),
        "gravity": (9.0, 4.7, "gravity with $J_2$"),
        "torque": (1.6, 1.7, "gravity gradient,\ndrag, control"),
        "rates": (5.4, 1.7, "Euler's equation\nwith wheels"),
        "stm": (9.0, 1.7, "closed-form\nattitude transition"),
    }
    arrows: Arrows = [
        ("elements", "orbit", "$r_0, v_0$"),
        ("orbit", "gravity", "$r$"),
        ("gravity", "orbit", "$a$"),
        ("orbit", "torque", "$r, v$"),
        ("torque", "rates", "$T, u$"),
        ("rates", "stm", r"$\omega$"),
        ("stm", "torque", r"$q, \omega$"),
    ]
    return _diagram(boxes, arrows, (10.8, 5.8), (6.3, 3.0))


def fuller_model(section: Configuration) -> Drawing:
    """Figure 18: the fuller model in which plans are flown."""
    rate, step = section.resampling_hz, section.numerics.step_s
    boxes: Boxes = {
        "profile": (1.6, 4.7, f"torque profile\n{rate:g} Hz, linear"),
        "wheels": (5.4, 4.7, "wheels: torque and\nmomentum limits"),
        "body": (9.0, 4.7, f"attitude and rate\nRunge-Kutta, {step:g} s"),
        "orbit": (1.6, 1.7, "orbit with $J_2$"),
        "air": (5.4, 1.7, "exponential\natmosphere, panels"),
        "torques": (9.0, 1.7, "gravity gradient\nand drag torque"),
    }
    arrows: Arrows = [
        ("profile", "wheels", "$u$"),
        ("wheels", "body", "$u, h$"),
        ("orbit", "air", "$r$"),
        ("air", "torques", r"$\rho$"),
        ("orbit", "torques", "$r, v$"),
        ("torques", "body", "$T$"),
        ("body", "torques", "$q$"),
    ]
    return _diagram(boxes, arrows, (10.8, 5.8), (6.3, 3.0))


def spacecraft(section: Configuration) -> Drawing:
    """Figure 19: the body to scale, its panels and axes; the booms are not to scale.

    They lie along the axis of the least moment of inertia, as booms for the gravity gradient do.
    """
    table = panels(section.spacecraft)
    size = section.spacecraft.size_m
    sides = np.array([size.breadth, size.length, size.height])
    figure = new_figure(figsize=(5.2, 3.9))
    figure.set_layout_engine("none")
    axes: Axes3D = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d", computed_zorder=False)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * sides / 2
    quads = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
    axes.add_collection3d(
        Poly3DCollection(
            corners[np.array(quads)], facecolors="#9fc3e0", edgecolors="0.35", alpha=0.45, lw=0.8
        )
    )
    along = int(np.argmin(np.diag(np.array(section.spacecraft.inertia_kg_m2))))
    for sign in (1.0, -1.0):
        ends = np.zeros((2, 3))
        ends[:, along] = sign * sides[along] / 2, sign * 0.2
        axes.plot(*ends.T, color="0.4", lw=1.2)
        axes.plot(*ends[1], "o", color="0.4", ms=5)
    figure.text(
        0.02, 0.08, f"booms along ${'xyz'[along]}$, of the least moment: length not printed",
        fontsize=7, color="0.3",
    )  # fmt: skip
    for direction, name, colour in zip(np.eye(3), "xyz", ("C0", "C1", "C2"), strict=True):
        length = {"x": 0.17, "y": 0.21, "z": 0.13}[name]
        axes.quiver(0, 0, 0, *(length * direction), color=colour, arrow_length_ratio=0.12, zorder=9)
        axes.text(*(1.1 * length * direction), f"${name}$", color=colour, zorder=10)
    rows = []
    for k, (label, row) in enumerate(zip(LABELS, table, strict=True)):
        normal, centre = row[1:4], row[4:7]
        if normal @ np.array([1.0, 1.0, 1.0]) > 0:
            axes.plot(*centre, ".", color="black", ms=4, zorder=8)
            place = centre + 0.045 * normal + np.array([0.0, -0.085 if k != 1 else 0.0, 0.0])
            if k == 1:
                place = centre + np.array([0.0, 0.0, 0.095])
            text = axes.text(
                *place, f"{k + 1} {label}\n{row[0]:g} m²", fontsize=7, ha="center", zorder=10
            )
            text.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
        rows.append({"panel": k + 1, "label": label, "area_m2": row[0]}
                    | {f"normal_{a}": row[1 + i] for i, a in enumerate("xyz")}
                    | {f"centre_{a}_m": row[4 + i] for i, a in enumerate("xyz")})  # fmt: skip
    axes.set(xlim=(-0.21, 0.21), ylim=(-0.21, 0.21), zlim=(-0.21, 0.21))
    axes.set_box_aspect((1, 1, 1), zoom=1.45)
    axes.view_init(elev=22, azim=28)
    axes.set_axis_off()
    figure.text(0.02, 0.04, "opposite: 4 port, 5 aft, 6 nadir", fontsize=7.5)
    return figure, pd.DataFrame(rows)


def _around(axes: Axes, a: np.ndarray, b: np.ndarray, half_height: float, label: str) -> None:
    """An arrow that goes below the boxes between its ends."""
    low = a[1] - half_height - 0.55
    axes.plot([a[0], a[0], b[0]], [a[1] - half_height, low, low], color="0.3", lw=1.0)
    axes.annotate(
        "",
        (b[0], b[1] - half_height),
        (b[0], low),
        arrowprops={"arrowstyle": "-|>", "color": "0.3"},
    )
    axes.text((a[0] + b[0]) / 2.0, low + 0.28, label, ha="center", va="center", fontsize=7.5)


def _diagram(
    boxes: Boxes, arrows: Arrows, extent: tuple[float, float], size: tuple[float, float]
) -> Drawing:
    figure, axes = subplots(figsize=size)
    axes.set(xlim=(0, extent[0]), ylim=(0, extent[1]))
    axes.set_axis_off()
    half_width, half_height = WIDTH / 2 + 0.1, HEIGHT / 2 + 0.15
    for x, y, text in boxes.values():
        axes.add_patch(
            FancyBboxPatch(
                (x - WIDTH / 2, y - HEIGHT / 2),
                WIDTH,
                HEIGHT,
                boxstyle="round,pad=0.1",
                fc="#eef4fa",
                ec="C0",
                lw=1.2,
            )
        )
        axes.text(x, y, text, ha="center", va="center", fontsize=7.5)
    between = {(start, end) for start, end, _ in arrows}
    for start, end, label in arrows:
        a, b = np.array(boxes[start][:2]), np.array(boxes[end][:2])
        way = b - a
        if way[1] == 0.0 and abs(way[0]) > 2.0 * extent[0] / 3.0:
            _around(axes, a, b, half_height, label)
            continue
        # An arrow there and one back lie side by side.
        if (end, start) in between:
            aside = np.array([-way[1], way[0]]) / np.linalg.norm(way)
            a, b = a + 0.22 * aside, b + 0.22 * aside
        # From edge to edge of the boxes.
        share = min(
            half_width / abs(way[0]) if way[0] else np.inf,
            half_height / abs(way[1]) if way[1] else np.inf,
        )
        tail, head = a + share * way, b - share * way
        axes.annotate("", head, tail, arrowprops={"arrowstyle": "-|>", "color": "0.3"})
        if way[0] and way[1]:
            side = np.array([-0.75, 0.4])
        else:
            side = np.array([0.0, 0.32]) if abs(way[0]) > abs(way[1]) else np.array([0.55, 0.0])
            if (end, start) in between:
                side = np.linalg.norm(side) * aside
        x, y = (tail + head) / 2 + side
        axes.text(x, y, label, ha="center", va="center", fontsize=7.5)
    rows = [{"from": boxes[a][2], "to": boxes[b][2], "signal": label} for a, b, label in arrows]
    table = pd.DataFrame(rows).replace("\n", " ", regex=True)
    return figure, table
