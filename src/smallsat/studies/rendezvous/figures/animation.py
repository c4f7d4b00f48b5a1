"""A film of one case in three dimensions: zone, cones, the plane that rotates, thrust and way.

What does not move is drawn once for each of three views, one a phase; a frame restores it and draws
what moves.
"""

from collections.abc import Iterator

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.figures.cases import (
    CONE,
    INFERRED,
    PHASE_COLOURS,
    PHASE_TITLES,
    ZONE,
)
from smallsat.studies.rendezvous.guidance.law import PHASES, Law
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.parameters import law as law_of

SIZE = (960, 544)  # multiples of 16, as the encoder asks for
DPI = 100
RATE = 25
# Seconds of the manoeuvre between frames, and how far each view reaches, in the phase's own length.
FRAME_S = {"far": 5.0, "mid": 2.0, "final": 1.5}


def frames(
    section: Flight, case: str, flights: pd.DataFrame, paths: pd.DataFrame
) -> Iterator[bytes]:
    """RGBA pictures of a case, each of `SIZE` pixels."""
    law = law_of(section, case)
    flight = flights[flights["flight"] == case]
    path = paths[paths["flight"] == case]
    with mpl.rc_context({"figure.constrained_layout.use": False, "font.size": 11}):
        for number, phase in enumerate(PHASES):
            own = path[path["phase"] == phase]
            if own.empty:
                continue
            figure = Figure(figsize=(SIZE[0] / DPI, SIZE[1] / DPI), dpi=DPI)
            canvas = FigureCanvasAgg(figure)
            scene = _Scene(figure, law, number, own)
            canvas.draw()
            still = canvas.copy_from_bbox(figure.bbox)
            steps = flight[flight["phase"] == phase]
            for time in np.arange(own["time_s"].min(), own["time_s"].max() + 1e-6, FRAME_S[phase]):
                canvas.restore_region(still)
                scene.show(time, own, steps)
                yield canvas.buffer_rgba().tobytes()


class _Scene:
    """One phase's view: the still parts drawn, the moving ones as animated artists."""

    def __init__(self, figure: Figure, law: Law, phase: int, path: pd.DataFrame) -> None:
        self.figure, self.law, self.phase = figure, law, phase
        points = path[STATE[:3]].to_numpy()[:, [1, 0, 2]]
        low, high = np.minimum(points.min(axis=0), 0.0), np.maximum(points.max(axis=0), 0.0)
        reach = float((high - low).max())
        if phase == 0:
            reach = max(reach, 2.6 * law.keep_out)
        middle, half = (low + high) / 2.0, 0.5 * reach
        axes: Axes3D = figure.add_axes(
            (0.0, 0.05, 1.0, 0.88), projection="3d", computed_zorder=False
        )
        axes.set(
            xlim=(middle[0] - half, middle[0] + half),
            ylim=(middle[1] - half, middle[1] + half),
            zlim=(middle[2] - half, middle[2] + half),
        )
        axes.set_box_aspect((1, 1, 1), zoom=0.92)
        axes.view_init(elev=32, azim=-62)
        axes.set_xlabel("along track [m]")
        axes.set_ylabel("radial [m]")
        axes.set_zlabel("normal [m]")
        axes.tick_params(labelsize=7)
        axes.locator_params(nbins=4)
        self.axes, self.scale = axes, reach
        if phase == 0:
            _sphere(axes, law.keep_out)
        length = {0: 1.6 * law.keep_out, 1: reach, 2: reach}[phase]
        _cone(
            axes,
            law.axis_at(float(path["time_s"].min())),
            law.cone_angles[phase],
            law.port if phase == 2 else 0.0,
            length,
        )
        axes.plot([0.0], [0.0], [0.0], "ks", ms=5)
        figure.text(0.01, 0.015, INFERRED, fontsize=8, color="0.4")
        colour = PHASE_COLOURS[PHASES[phase]]
        self.title = figure.text(0.5, 0.94, "", ha="center", animated=True)
        self.track = axes.plot([], [], [], color=colour, lw=1.8, animated=True)[0]
        self.chaser = axes.plot([], [], [], "o", color="black", ms=6, animated=True)[0]
        self.thrust = axes.plot([], [], [], color="C3", lw=2.4, animated=True)[0]
        self.plane = Poly3DCollection(
            [np.zeros((4, 3))], facecolor="0.5", alpha=0.3, edgecolor="0.3", animated=True
        )
        axes.add_collection3d(self.plane)

    def show(self, time: float, path: pd.DataFrame, steps: pd.DataFrame) -> None:
        """Put the moving artists where they are at a time, s, and draw them."""
        past = path[path["time_s"] <= time + 1e-9]
        points = past[STATE[:3]].to_numpy()[:, [1, 0, 2]]
        here = points[-1]
        step = steps[steps["time_s"] <= time + 1e-9].iloc[-1]
        change = step[CHANGE].to_numpy(dtype=float)[[1, 0, 2]]
        bound = self.law.control_bounds[self.phase]
        name = PHASES[self.phase]
        self.title.set_text(
            f"Case 1, t = {time:.0f} s: {PHASE_TITLES[name]}, {np.linalg.norm(here):.4g} m away"
        )
        self.track.set_data_3d(*points.T)
        self.chaser.set_data_3d(*here[:, None])
        tip = here + 0.12 * self.scale * change / bound
        self.thrust.set_data_3d(*np.array([here, tip]).T)
        self.plane.set_visible(self.phase == 0)
        if self.phase == 0:
            self.plane.set_verts([_square(here / np.linalg.norm(here), self.law.keep_out)])
            self.plane.do_3d_projection()
        for artist in (self.plane, self.track, self.thrust, self.chaser, self.title):
            self.figure.draw_artist(artist)


def _square(normal: np.ndarray, radius: float) -> np.ndarray:
    """Corners of the keep-out plane's part around its point of contact, shape (4, 3)."""
    across = np.cross(normal, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(across, normal)
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return np.array([radius * (normal + 0.7 * (a * across + b * up)) for a, b in corners])


def _sphere(axes: Axes3D, radius: float) -> None:
    around, up = np.meshgrid(np.linspace(0.0, 2 * np.pi, 37), np.linspace(-0.5, 0.5, 19) * np.pi)
    x, y, z = np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)
    axes.plot_surface(radius * x, radius * y, radius * z, color=ZONE, alpha=0.25, lw=0, zorder=1)


def _cone(axes: Axes3D, axis: np.ndarray, half_angle: float, tip: float, length: float) -> None:
    """The four faces of a cone, in the drawing's axes (along track, radial, normal)."""
    along = axis[[1, 0, 2]]
    across = np.array([-along[1], along[0], 0.0])
    up = np.array([0.0, 0.0, 1.0])
    start = tip * along
    width = length * np.tan(half_angle)
    ends = [
        start + length * along + width * (a * across + b * up)
        for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]
    faces = [[start, ends[k], ends[(k + 1) % 4]] for k in range(4)]
    axes.add_collection3d(
        Poly3DCollection(faces, facecolor=CONE, edgecolor="0.5", alpha=0.25, lw=0.6, zorder=2)
    )
