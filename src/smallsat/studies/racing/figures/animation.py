"""Films of the races: our solve of the listing and the optimum side by side, on one clock."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from smallsat.studies.racing.figures.drawing import (
    COLOURS,
    ENLARGED,
    LISTING,
    OPTIMAL,
    RING,
    TITLES,
    box,
    label_axes,
    look,
    positions,
    ring_curve,
)
from smallsat.studies.racing.model.course import Course

# Multiples of 16, as the encoder asks for.
WIDTH, HEIGHT, DPI = 1120, 560, 100
TAIL_S = 60.0


def write_film(pictures: Iterator[bytes], path: Path | str, rate: int) -> None:
    """Encode RGBA pictures as H.264, atomically."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".partial-{path.name}")
    writer = imageio_ffmpeg.write_frames(
        str(partial), (WIDTH, HEIGHT), fps=rate, pix_fmt_in="rgba", output_params=["-threads", "1"]
    )
    writer.send(None)
    for picture in pictures:
        writer.send(picture)
    writer.close()
    partial.replace(path)


def frames(course: Course, paths: pd.DataFrame, step: float) -> Iterator[bytes]:
    """RGBA pictures of a race every ``step`` s, until the last optimal CubeSat has finished."""
    ends = paths[paths["solution"] == OPTIMAL].groupby("cubesat")["time_s"].max()
    with mpl.rc_context({"figure.constrained_layout.use": False}):
        figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        canvas = FigureCanvasAgg(figure)
        moving: list[tuple[Any, ...]] = []
        for place, solution in enumerate((LISTING, OPTIMAL)):
            axes: Any = figure.add_axes((0.5 * place, 0.06, 0.5, 0.84), projection="3d")
            way = np.vstack([course.start, course.centres, course.end])
            box(axes, way, 0.2)
            limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
            axes.plot(*way.T, color="#dddddd", lw=0.7)
            for k in range(course.rings):
                axes.plot(*ring_curve(course, k, ENLARGED).T, color=RING, lw=0.9)
            label_axes(axes)
            look(axes)
            axes.set_title(TITLES[solution], pad=0)
            for name, colour in COLOURS.items():
                own = paths[(paths["solution"] == solution) & (paths["cubesat"] == name)]
                line = axes.plot([], [], [], color=colour, lw=1.4, animated=True)[0]
                dot = axes.plot([], [], [], "o", color=colour, ms=6, animated=True, label=name)[0]
                moving.append((own["time_s"].to_numpy(), positions(own), limits, line, dot))
        figure.legend(
            handles=[entry[4] for entry in moving[: len(COLOURS)]], loc="lower center", ncols=4
        )
        clock = figure.text(0.5, 0.95, "", ha="center", animated=True)
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        for time in np.arange(0.0, ends.max() + step, step):
            canvas.restore_region(still)
            clock.set_text(f"t = {time:.0f} s")
            figure.draw_artist(clock)
            for times, points, limits, line, dot in moving:
                when = np.linspace(max(time - TAIL_S, 0.0), time, 30)
                spots = np.column_stack([np.interp(when, times, column) for column in points.T])
                # Out of view a CubeSat is not shown.
                outside = ((spots < limits[:, 0]) | (spots > limits[:, 1])).any(axis=1)
                spots = np.where(np.atleast_2d(outside).T, np.nan, spots)
                line.set_data_3d(*spots.T)
                dot.set_data_3d(*spots[-1:].T)
                figure.draw_artist(line)
                figure.draw_artist(dot)
            yield canvas.buffer_rgba().tobytes()
