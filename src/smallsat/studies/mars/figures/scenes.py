"""Three-dimensional scenes: Mars, both orbits with their frames, both spacecraft, the body axes.

The projection is a parallel one, and all lengths are to scale but those of frames' axes, which are
as long as they can be seen.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.pyplot import figure as new_figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from smallsat.dynamics.attitude.mrp import mrp_to_dcm
from smallsat.dynamics.orbits.circular_orbits import CircularOrbit, orbit_frame, position
from smallsat.dynamics.units import KM
from smallsat.studies.mars.figures.colours import BODY_COLOURS, DAY_COLOUR, NIGHT_COLOUR
from smallsat.studies.mars.model.frames import SUN_FRAME
from smallsat.studies.mars.model.modes import GMO, NADIR, SUN
from smallsat.studies.mars.parameters import Parameters

MODE_TITLES = {SUN: "Sun pointing", NADIR: "nadir pointing", GMO: "GMO pointing"}
# Keeps labels readable on the planet.
HALO = [withStroke(linewidth=2.0, foreground="white")]
FRAME_COLOUR = "0.25"
TO_SUN = np.array(SUN_FRAME[2])

# The document's point of view; matplotlib counts azimuth from another axis.
AZIMUTH_DEG = 30.0
ELEVATION_DEG = 35.0
MATPLOTLIB_AZIMUTH = AZIMUTH_DEG - 90.0
_AZIMUTH, _ELEVATION = np.radians(MATPLOTLIB_AZIMUTH), np.radians(ELEVATION_DEG)
TO_CAMERA = np.array(
    [
        np.cos(_ELEVATION) * np.cos(_AZIMUTH),
        np.cos(_ELEVATION) * np.sin(_AZIMUTH),
        np.sin(_ELEVATION),
    ]
)

# In orbit radii of the spacecraft that a view is about: half width, length of the axes of its
# orbit's frame, and of those of the body.
WIDE, NEAR = 1.05, 1.3
WIDE_FRAME, NEAR_FRAME = 0.72, 1.22
ARROW = 0.6
ARROW_LABEL = 1.38  # distance of an arrow's label from its start, in lengths of the arrow
FRAME_LABEL = 1.12

# Height of a scene's box in its width, and how far the box fills its place.
FLAT = 0.7
SCENE_ZOOM = 0.97

Place = tuple[float, float, float, float]  # left, bottom, width, height of axes in the figure


@dataclass(frozen=True)
class Scene:
    """What a scene shows at one time: positions in km, axes as rows in inertial components."""

    time: float
    mode: int
    lmo: np.ndarray
    gmo: np.ndarray
    lmo_frame: np.ndarray
    gmo_frame: np.ndarray
    body_axes: np.ndarray


def scene_in(parameters: Parameters, trajectory: pd.DataFrame, time: float) -> Scene:
    """The scene at a time, s, of a run with the columns ``time_s``, ``sigma_1..3`` and ``mode``."""
    row = trajectory.iloc[int(np.argmin(np.abs(trajectory["time_s"].to_numpy() - time)))]
    sigma = row[["sigma_1", "sigma_2", "sigma_3"]].to_numpy(dtype=float)
    return scene_at(parameters, float(row["time_s"]), sigma, int(row["mode"]))


def scene_at(parameters: Parameters, time: float, sigma: np.ndarray, mode: int) -> Scene:
    """Positions and axes at a time, s, for an attitude sigma_B/N, shape (3,)."""
    return Scene(
        time=time,
        mode=mode,
        lmo=np.array(position(parameters.lmo, time)) / KM,
        gmo=np.array(position(parameters.gmo, time)) / KM,
        lmo_frame=np.array(orbit_frame(parameters.lmo, time)),
        gmo_frame=np.array(orbit_frame(parameters.gmo, time)),
        body_axes=np.array(mrp_to_dcm(sigma)),
    )


def scene_data(scene: Scene) -> pd.DataFrame:
    """The points and directions drawn: ``item``, ``x``, ``y``, ``z`` (km or unit vectors)."""
    rows = {
        "nano-satellite [km]": scene.lmo,
        "mothercraft [km]": scene.gmo,
        **{f"b{i + 1}": axis for i, axis in enumerate(scene.body_axes)},
    }
    for name, frame in (("nano-satellite", scene.lmo_frame), ("mothercraft", scene.gmo_frame)):
        for axis, direction in zip(("r", "theta", "h"), frame, strict=True):
            rows[f"i_{axis} of the {name}'s orbit"] = direction
    table = pd.DataFrame.from_dict(rows, orient="index", columns=["x", "y", "z"])
    return table.rename_axis("item").reset_index()


def scene_figure(parameters: Parameters, scene: Scene) -> Figure:
    """The whole scene on the left, the nano-satellite's surroundings on the right."""
    figure = new_figure(figsize=(6.3, 3.3))
    figure.set_layout_engine("none")
    wide, near = scene_views(figure, parameters)
    draw_still(wide, near, parameters)
    draw_frame(wide, scene.gmo_frame, WIDE_FRAME * parameters.gmo.radius / KM, parameters)
    draw_frame(near, scene.lmo_frame, NEAR_FRAME * parameters.lmo.radius / KM, parameters)
    order = 10.0 if in_front(scene.lmo, parameters) else 0.5
    wide.plot(*scene.gmo, "o", color="C3", ms=6, zorder=9)
    for axes in (wide, near):
        axes.plot(*scene.lmo, "o", color="black", ms=4.5, zorder=order)
    known = bool(np.isfinite(scene.body_axes).all())
    if known:
        draw_body_axes(near, scene, ARROW * parameters.lmo.radius / KM, order)
    if scene.mode == GMO:
        ends = np.array([scene.lmo, scene.gmo])
        wide.plot(*ends.T, color="C3", lw=1.0, ls=":", zorder=8)

    note = "" if known else ", attitude not converged"
    figure.text(0.5, 0.95, f"t = {scene.time:g} s: {MODE_TITLES[scene.mode]}{note}", ha="center")
    frames = Line2D([], [], color=FRAME_COLOUR, lw=0.8, label="frame of the orbit")
    figure.legend(
        handles=legend_handles(frames), loc="lower center", ncols=3, fontsize=7.5, columnspacing=1.5
    )
    return figure


def scene_views(figure: Figure, parameters: Parameters) -> tuple[Axes3D, Axes3D]:
    """The wide view of both orbits, and the near one of the nano-satellite's."""
    wide = view(figure, (-0.01, 0.07, 0.49, 0.935), WIDE * parameters.gmo.radius / KM, SCENE_ZOOM)
    near = view(figure, (0.47, 0.07, 0.49, 0.935), NEAR * parameters.lmo.radius / KM, SCENE_ZOOM)
    for axes in (wide, near):
        _show_scale(axes)
    return wide, near


def view(
    figure: Figure,
    place: Place,
    half_width: float,
    zoom: float,
    elevation: float = ELEVATION_DEG,
    azimuth: float = MATPLOTLIB_AZIMUTH,
) -> Axes3D:
    """Bare three-dimensional axes around the origin, from the document's point of view if not told.

    Artists are drawn in the order of their ``zorder``, not of their depth. Angles are in degrees.
    """
    axes: Axes3D = figure.add_axes(place, projection="3d", proj_type="ortho", computed_zorder=False)
    limits = (-half_width, half_width)
    axes.set(xlim=limits, ylim=limits, zlim=limits)
    axes.set_box_aspect((1, 1, 1), zoom=zoom)
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set_axis_off()
    axes.patch.set_visible(False)
    return axes


def _show_scale(axes: Axes3D) -> None:
    """The inertial axes in thousands of km, with faint grids on the walls of a flat box."""
    axes.set_axis_on()
    bottom, top = axes.get_zlim()
    axes.set_zlim(FLAT * bottom, FLAT * top)
    axes.set_box_aspect((1, 1, FLAT), zoom=SCENE_ZOOM)
    names = ("$n_1$", "$n_2$, to the Sun", "$n_3$")
    for axis, name in zip((axes.xaxis, axes.yaxis, axes.zaxis), names, strict=True):
        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter(lambda value, _: f"{value / 1000.0:g}")
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis.set_tick_params(labelsize=6.5, pad=-3.5)
        axis.labelpad = -7.0
        axis.set_label_text(f"{name} [Mm]", fontsize=7.5)


def draw_still(wide: Axes3D, near: Axes3D, parameters: Parameters) -> None:
    """The planet and the orbits."""
    draw_orbit(wide, parameters.gmo, parameters, "C3")
    for axes in (wide, near):
        draw_mars(axes, parameters.mars_radius / KM)
        draw_orbit(axes, parameters.lmo, parameters, "C0")


def draw_mars(axes: Axes3D, radius: float) -> None:
    """The planet's disc as it is seen, its day side bounded by limb and terminator."""
    tip = np.cross(TO_SUN, TO_CAMERA)
    tip /= np.linalg.norm(tip)
    across = np.cross(TO_CAMERA, tip)  # on the limb, on the side of the Sun
    middle = np.cross(tip, TO_SUN)  # of the terminator, on the side of the camera
    middle *= np.sign(middle @ TO_CAMERA)
    half = np.linspace(0.0, np.pi, 61)[:, None]
    limb = np.cos(half) * tip + np.sin(half) * across
    terminator = np.cos(half[::-1]) * tip + np.sin(half[::-1]) * middle
    night = np.vstack([limb, np.cos(half[::-1]) * tip - np.sin(half[::-1]) * across])
    for outline, colour, order in (
        (night, NIGHT_COLOUR, 2.0),
        (np.vstack([limb, terminator]), DAY_COLOUR, 2.1),
    ):
        axes.add_collection3d(
            Poly3DCollection([radius * outline], facecolors=colour, lw=0, zorder=order)
        )


def draw_orbit(axes: Axes3D, orbit: CircularOrbit, parameters: Parameters, colour: str) -> None:
    """A full revolution."""
    period = 2.0 * np.pi / orbit.rate
    points = np.array([position(orbit, t) for t in np.linspace(0.0, period, 241)]) / KM
    _draw_path(axes, points, parameters, color=colour, lw=0.9)


def draw_frame(axes: Axes3D, frame: np.ndarray, length: float, parameters: Parameters) -> None:
    """The axes of an orbit's frame from the planet's centre, as rows of the frame, length in km."""
    for direction, label in zip(frame, ("$i_r$", r"$i_\theta$", "$i_h$"), strict=True):
        path = np.linspace(0.0, length, 121)[:, None] * direction
        _draw_path(axes, path, parameters, color=FRAME_COLOUR, lw=0.8)
        tip = length * direction
        order = 10.0 if in_front(tip, parameters) else 0.5
        axes.quiver(
            *(0.85 * tip),
            *(0.15 * tip),
            color=FRAME_COLOUR,
            lw=0.8,
            zorder=order,
            arrow_length_ratio=0.8,
        )
        at = FRAME_LABEL * tip
        text = axes.text(
            *at, label, color=FRAME_COLOUR, fontsize=8, ha="center", va="center", zorder=order
        )
        text.set_path_effects(HALO)


def _draw_path(axes: Axes3D, points: np.ndarray, parameters: Parameters, **style: Any) -> None:
    """A line, (n, 3), km; what lies behind the planet, or in it, is drawn behind it."""
    front = np.array([in_front(point, parameters) for point in points])
    for shown, order in ((front, 5.0), (~front, 0.0)):
        axes.plot(*np.where(shown[:, None], points, np.nan).T, zorder=order, **style)


def in_front(point: np.ndarray, parameters: Parameters) -> bool:
    """Whether a point, km, is not hidden by the planet."""
    depth = float(point @ TO_CAMERA)
    radius = parameters.mars_radius / KM
    surface = radius**2 - float(np.sum((point - depth * TO_CAMERA) ** 2))
    return surface < 0.0 or depth > np.sqrt(surface)


def draw_body_axes(axes: Axes3D, scene: Scene, length: float, order: float) -> None:
    """Arrows along the body axes and, dotted, along -b1, where the antenna points."""
    directions = [*scene.body_axes, -scene.body_axes[0]]
    labels, styles = ("$b_1$", "$b_2$", "$b_3$", "$-b_1$"), ("-", "-", "-", ":")
    for direction, label, colour, style in zip(
        directions, labels, BODY_COLOURS, styles, strict=True
    ):
        along = length * direction
        axes.quiver(
            *scene.lmo,
            *along,
            color=colour,
            lw=1.5,
            ls=style,
            zorder=order,
            arrow_length_ratio=0.18,
        )
        at = scene.lmo + ARROW_LABEL * along
        text = axes.text(*at, label, color=colour, fontsize=9, ha="center", va="center", zorder=20)
        text.set_path_effects(HALO)


def legend_handles(*more: Line2D) -> list[Line2D | Patch]:
    """What the legend of a scene explains, and more."""
    orbit = Line2D([], [], color="C0", lw=0.9, marker="o", ms=4.5, label="nano-satellite")
    orbit.set(markerfacecolor="black", markeredgecolor="black")
    return [
        orbit,
        Line2D([], [], color="C3", lw=0.9, marker="o", ms=5, label="mothercraft"),
        Line2D([], [], color="C3", lw=1.0, ls=":", label="line of sight when communicating"),
        *more,
        Patch(color=DAY_COLOUR, label="Mars, day side"),
        Patch(color=NIGHT_COLOUR, label="Mars, night side"),
    ]
