"""Films of the mission: the scene of Figs. 11 to 15 in motion.

Mars and the orbits are drawn once; each frame restores them and draws only what moves.
"""

from collections.abc import Iterator
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from smallsat.dynamics.units import KM
from smallsat.studies.mars.figures.colours import BODY_COLOURS
from smallsat.studies.mars.figures.scenes import (
    ARROW,
    ARROW_LABEL,
    HALO,
    MODE_TITLES,
    Scene,
    draw_still,
    in_front,
    legend_handles,
    scene_in,
    scene_views,
)
from smallsat.studies.mars.model.modes import GMO
from smallsat.studies.mars.parameters import Parameters

# Multiples of 16, as the encoder asks for.
WIDTH, HEIGHT, DPI = 960, 544, 100
HIDDEN_ALPHA = 0.3  # of a spacecraft behind the planet


def frames(parameters: Parameters, trajectory: pd.DataFrame, times: np.ndarray) -> Iterator[bytes]:
    """RGBA pictures of the scene at the times, s, each of ``WIDTH`` by ``HEIGHT`` pixels."""
    with mpl.rc_context({"figure.constrained_layout.use": False, "font.size": 11}):
        figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        canvas = FigureCanvasAgg(figure)
        moving = _Moving(figure, parameters)
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        for time in times:
            canvas.restore_region(still)
            moving.show(scene_in(parameters, trajectory, float(time)))
            yield canvas.buffer_rgba().tobytes()


class _Moving:
    """The artists that change from frame to frame, on a figure with everything that does not."""

    def __init__(self, figure: Figure, parameters: Parameters) -> None:
        self.parameters = parameters
        self.length = ARROW * parameters.lmo.radius / KM
        wide, near = scene_views(figure, parameters)
        draw_still(wide, near, parameters)
        figure.legend(handles=legend_handles(), loc="lower center", ncols=3, frameon=False)

        new: dict[str, Any] = {"animated": True}
        self.sight = wide.plot([], [], [], color="C3", lw=1.0, ls=":", **new)[0]
        self.mothercraft = wide.plot([], [], [], "o", color="C3", ms=7, **new)[0]
        self.satellite = [a.plot([], [], [], "ko", ms=5, **new)[0] for a in (wide, near)]
        styles = ("-", "-", "-", ":")
        self.axes = [
            near.plot([], [], [], color=colour, ls=style, lw=2.0, **new)[0]
            for colour, style in zip(BODY_COLOURS, styles, strict=True)
        ]
        labels = ("$b_1$", "$b_2$", "$b_3$", "$-b_1$")
        centred: dict[str, Any] = {"ha": "center", "va": "center"}
        self.labels = [
            near.text(0, 0, 0, label, color=colour, **centred, **new)
            for label, colour in zip(labels, BODY_COLOURS, strict=True)
        ]
        for label in self.labels:
            label.set_path_effects(HALO)
        self.title = figure.text(0.5, 0.95, "", ha="center", **new)
        self.figure = figure

    def show(self, scene: Scene) -> None:
        """Put the artists where a scene has them and draw them."""
        self.title.set_text(f"t = {scene.time:.0f} s: {MODE_TITLES[scene.mode]}")
        self.mothercraft.set_data_3d(*scene.gmo[:, None])
        self.sight.set_data_3d(*np.array([scene.lmo, scene.gmo]).T)
        self.sight.set_visible(scene.mode == GMO)
        alpha = 1.0 if in_front(scene.lmo, self.parameters) else HIDDEN_ALPHA
        for dot in self.satellite:
            dot.set_data_3d(*scene.lmo[:, None])
        directions = [*scene.body_axes, -scene.body_axes[0]]
        for line, label, direction in zip(self.axes, self.labels, directions, strict=True):
            along = self.length * direction
            line.set_data_3d(*np.array([scene.lmo, scene.lmo + along]).T)
            label.set_position_3d(scene.lmo + ARROW_LABEL * along)
        for artist in (*self.satellite, *self.axes, *self.labels):
            artist.set_alpha(alpha)
        for artist in (
            self.title,
            self.sight,
            self.mothercraft,
            *self.satellite,
            *self.axes,
            *self.labels,
        ):
            self.figure.draw_artist(artist)
