"""Three-dimensional scenes: Mars, both orbits, both spacecraft, the body axes, the Sun.

All lengths are drawn to scale, except that the body axes are arrows one can see.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.pyplot import figure as new_figure
from mpl_toolkits.mplot3d import Axes3D

from smallsat.dynamics.attitude.mrp import mrp_to_dcm
from smallsat.dynamics.orbits.circular_orbits import CircularOrbit, position
from smallsat.dynamics.units import KM
from smallsat.studies.mars.model.modes import GMO, NADIR, SUN
from smallsat.studies.mars.parameters import Parameters

MODE_TITLES = {SUN: "Sun pointing", NADIR: "nadir pointing", GMO: "GMO pointing"}
BODY_COLOURS = ("C1", "C2", "C0", "C1")
# Keeps labels readable on the planet.
HALO = [withStroke(linewidth=2.0, foreground="white")]
DAY_COLOUR, NIGHT_COLOUR = "#e8b48c", "#7a6a63"

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

# In orbit radii of the nano-satellite: half width of the near view, length of the body axes.
NEAR = 1.25
ARROW = 0.55
ARROW_LABEL = 1.3  # distance of an arrow's label from its start, in lengths of the arrow

Place = tuple[float, float, float, float]  # left, bottom, width, height of axes in the figure


@dataclass(frozen=True)
class Scene:
    """What a scene shows at one time: positions in km, axes as rows in inertial components."""

    time: float
    mode: int
    lmo: np.ndarray
    gmo: np.ndarray
    body_axes: np.ndarray


def scene_in(parameters: Parameters, trajectory: pd.DataFrame, time: float) -> Scene:
    """The scene at a time, s, of a run with the columns ``time_s``, ``sigma_1..3`` and ``mode``."""
    row = trajectory.iloc[int(np.argmin(np.abs(trajectory["time_s"].to_numpy() - time)))]
    sigma = row[["sigma_1", "sigma_2", "sigma_3"]].to_numpy(dtype=float)
    return scene_at(parameters, float(row["time_s"]), sigma, int(row["mode"]))


def scene_at(parameters: Parameters, time: float, sigma: np.ndarray, mode: int) -> Scene:
    """Positions and body axes at a time, s, for an attitude sigma_B/N, shape (3,)."""
    return Scene(
        time=time,
        mode=mode,
        lmo=np.array(position(parameters.lmo, time)) / KM,
        gmo=np.array(position(parameters.gmo, time)) / KM,
        body_axes=np.array(mrp_to_dcm(sigma)),
    )


def scene_data(scene: Scene) -> pd.DataFrame:
    """The points and directions drawn: ``item``, ``x``, ``y``, ``z`` (km or unit vectors)."""
    rows = {
        "nano-satellite [km]": scene.lmo,
        "mothercraft [km]": scene.gmo,
        **{f"b{i + 1}": axis for i, axis in enumerate(scene.body_axes)},
    }
    table = pd.DataFrame.from_dict(rows, orient="index", columns=["x", "y", "z"])
    return table.rename_axis("item").reset_index()


def scene_figure(parameters: Parameters, scene: Scene) -> Figure:
    """The whole scene on the left, the nano-satellite's surroundings on the right."""
    figure = new_figure(figsize=(6.3, 3.4))
    figure.set_layout_engine("none")
    wide = view(figure, (0.0, 0.12, 0.5, 0.85), 0.93 * parameters.gmo.radius / KM, zoom=1.45)
    near = view(figure, (0.5, 0.06, 0.5, 0.88), NEAR * parameters.lmo.radius / KM, zoom=1.05)
    draw_orbit(wide, parameters.gmo, parameters, "C3")
    for axes in (wide, near):
        draw_mars(axes, parameters.mars_radius / KM)
        draw_orbit(axes, parameters.lmo, parameters, "C0")
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
    draw_directions(figure, (0.37, 0.06, 0.24, 0.36))

    note = "" if known else ", attitude not converged"
    figure.text(0.5, 0.94, f"t = {scene.time:g} s: {MODE_TITLES[scene.mode]}{note}", ha="center")
    figure.legend(
        handles=legend_handles(), loc="lower center", ncols=4, fontsize=7, columnspacing=1.2
    )
    return figure


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
    axes: Axes3D = figure.add_axes(place, projection="3d", computed_zorder=False)
    limits = (-half_width, half_width)
    axes.set(xlim=limits, ylim=limits, zlim=limits)
    axes.set_box_aspect((1, 1, 1), zoom=zoom)
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set_axis_off()
    axes.patch.set_visible(False)
    return axes


def draw_mars(axes: Axes3D, radius: float) -> None:
    """The planet, bright on the side of the Sun."""
    around, up = np.meshgrid(np.linspace(0.0, 2 * np.pi, 49), np.linspace(-0.5, 0.5, 25) * np.pi)
    x, y, z = np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)
    middle = y[:-1, :-1] + y[1:, 1:] + y[1:, :-1] + y[:-1, 1:]
    colours = np.where(middle > 0.0, DAY_COLOUR, NIGHT_COLOUR)
    axes.plot_surface(
        radius * x,
        radius * y,
        radius * z,
        facecolors=colours,
        alpha=0.8,
        rcount=49,
        ccount=49,
        lw=0,
        shade=False,
        zorder=2,
    )


def draw_orbit(axes: Axes3D, orbit: CircularOrbit, parameters: Parameters, colour: str) -> None:
    """A full revolution; what lies behind the planet is drawn behind it."""
    period = 2.0 * np.pi / orbit.rate
    points = np.array([position(orbit, t) for t in np.linspace(0.0, period, 241)]) / KM
    front = np.array([in_front(point, parameters) for point in points])
    for shown, order in ((front, 5.0), (~front, 0.0)):
        axes.plot(*np.where(shown[:, None], points, np.nan).T, color=colour, lw=0.9, zorder=order)


def in_front(point: np.ndarray, parameters: Parameters) -> bool:
    """Whether a point, km, is not hidden by the planet."""
    depth = float(point @ TO_CAMERA)
    beside = np.linalg.norm(point - depth * TO_CAMERA)
    return bool(depth > 0.0 or beside > parameters.mars_radius / KM)


def draw_body_axes(axes: Axes3D, scene: Scene, length: float, order: float) -> None:
    """Arrows along the body axes and, dotted, along -b1, where the antenna points."""
    directions = [*scene.body_axes, -scene.body_axes[0]]
    labels, styles = ("$b_1$", "$b_2$", "$b_3$", "$-b_1$"), ("-", "-", "-", ":")
    for direction, label, colour, style in zip(
        directions, labels, BODY_COLOURS, styles, strict=True
    ):
        draw_arrow(axes, scene.lmo, length * direction, label, colour, style, order)


def draw_arrow(axes, start, along, label, colour, style="-", order=10.0) -> None:
    """An arrow with its label beyond the tip; all in km."""
    axes.quiver(
        *start, *along, color=colour, lw=1.5, ls=style, zorder=order, arrow_length_ratio=0.18
    )
    at = np.asarray(start) + ARROW_LABEL * np.asarray(along)
    text = axes.text(*at, label, color=colour, fontsize=9, ha="center", va="center", zorder=20)
    text.set_path_effects(HALO)


def draw_directions(figure: Figure, place: Place) -> None:
    """The inertial axes; the Sun stands along the second one."""
    axes = view(figure, place, 1.3, zoom=1.2)
    for label, direction, colour in zip(
        ("$n_1$", "Sun", "$n_3$"), np.eye(3), ("0.4", "C4", "0.4"), strict=True
    ):
        draw_arrow(axes, np.zeros(3), direction, label, colour)


def legend_handles() -> list[Line2D]:
    """What the legend of a scene explains."""
    orbit = Line2D([], [], color="C0", lw=0.9, marker="o", ms=4.5, label="nano-satellite")
    orbit.set(markerfacecolor="black", markeredgecolor="black")
    return [
        orbit,
        Line2D([], [], color="C3", lw=0.9, marker="o", ms=5, label="mothercraft"),
        Line2D([], [], color="C3", lw=1.0, ls=":", label="line of sight when communicating"),
    ]
