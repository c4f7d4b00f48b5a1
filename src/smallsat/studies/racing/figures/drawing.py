"""What the drawings of a race share: colours, names, rings as curves, views."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from smallsat.drawing.style import BLUE, GREEN, PURPLE, VERMILION
from smallsat.results import read_table
from smallsat.studies.racing.methods.races import LISTING
from smallsat.studies.racing.methods.races import WHOLE as OPTIMAL
from smallsat.studies.racing.model.course import Course, course_of
from smallsat.studies.racing.model.course_view import VIEW_AZIMUTH_DEG, VIEW_ELEVATION_DEG

COLOURS = {"Eeny": BLUE, "Meeny": VERMILION, "Miny": GREEN, "Mo": PURPLE}
STYLES = {"Eeny": "-", "Meeny": "--", "Miny": "-.", "Mo": ":"}
RING = "#888888"
TITLES = {LISTING: "our solve of the listing", OPTIMAL: "optimal, whole course"}
AXES_LABELS = ("radial (m)", "along track (m)", "cross track (m)")
# Rings are 1 to 5 m on a course of a kilometre: drawn larger, they can be seen.
ENLARGED = 12.0
# What stands in the place of a path that was not found.
MISSING = "not converged"
ROUND = np.linspace(0.0, 2.0 * np.pi, 41)


def read_course(results: str, scenario: str) -> Course:
    """The course of a scenario."""
    path = Path(results) / f"course-{scenario}.csv"
    return course_of(read_table(path), str(path))


def read_paths(results: str, scenario: str) -> pd.DataFrame:
    """Trajectories of a scenario: our solve of the listing and the whole-course optimum."""
    parts = [
        read_table(Path(results) / f"{kind}-{scenario}-trajectories.parquet")
        for kind in ("listing", "optima")
    ]
    table = pd.concat(parts, ignore_index=True)
    return table[table["solution"].isin((LISTING, OPTIMAL))]


def positions(path: pd.DataFrame) -> np.ndarray:
    """Positions (p, 3), m."""
    return path[["x_m", "y_m", "z_m"]].to_numpy()


def ring_curve(course: Course, k: int, enlarged: float = 1.0) -> np.ndarray:
    """Points (41, 3) around ring k."""
    level, up = course.axes[k]
    a, b = enlarged * course.semi_axes[k]
    around = a * np.cos(ROUND)[:, None] * level + b * np.sin(ROUND)[:, None] * up
    return course.centres[k] + around


def box(axes: Any, points: np.ndarray, margin: float = 0.05) -> None:
    """Limits of a 3D view around points (p, 3), with equal scales."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half = np.maximum(half, 0.12 * half.max()) * (1.0 + margin)
    for setter, m, h in zip(
        (axes.set_xlim, axes.set_ylim, axes.set_zlim), middle, half, strict=True
    ):
        setter(m - h, m + h)
    axes.set_box_aspect(half, zoom=1.05)


def label_axes(axes: Any) -> None:
    """Names and few ticks of a 3D view."""
    for name, text in zip("xyz", AXES_LABELS, strict=True):
        getattr(axes, f"set_{name}label")(text, fontsize=6.5, labelpad=-7 if name == "z" else -5)
    axes.tick_params(labelsize=5.5, pad=-3)
    axes.locator_params(nbins=3)


def look(axes: Any, turned: float = 0.0) -> None:
    """The document's view, or one turned from it, degrees.

    MATLAB counts azimuths from -y, matplotlib from +x.
    """
    axes.view_init(VIEW_ELEVATION_DEG, VIEW_AZIMUTH_DEG - 90.0 + turned)


def zero_line(axes: Axes) -> None:
    """A quiet line at zero."""
    axes.axhline(0.0, color="#bbbbbb", lw=0.6, zorder=0)


def say_missing(axes: Axes) -> None:
    """The word in the middle of a panel whose data no solver found."""
    axes.text(0.5, 0.5, MISSING, transform=axes.transAxes, ha="center", va="center", fontsize=8)
