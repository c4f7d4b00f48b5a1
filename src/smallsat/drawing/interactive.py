"""Scenes that a reader turns, zooms and plays: three-dimensional Plotly figures."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go

# Instants of a play; more make the page heavier and no clearer.
FRAMES = 120
# From where it is seen at first, on each axis, in half widths of the scene.
EYE = 1.25
TRANSPARENT = "rgba(0,0,0,0)"
DIMENSIONS = ("x", "y", "z")


@dataclass(frozen=True)
class Track:
    """A path that is flown; a marker moves along it.

    Attributes
    ----------
    name, colour
        How it is called and drawn.
    times
        Shape (n,), s, ascending.
    points
        Shape (n, 3), in the scene's unit.
    """

    name: str
    colour: str
    times: np.ndarray
    points: np.ndarray


@dataclass(frozen=True)
class Scene:
    """What a reader sees.

    Attributes
    ----------
    name
        Unique in its study.
    title
        Heading above it.
    described
        What it shows, for who does not see it.
    fallback
        Figure that stands in its place until it is asked for, without suffix.
    unit
        Of the axes; empty for directions.
    tracks
        What moves.
    still
        What stands: Plotly traces.
    """

    name: str
    title: str
    described: str
    fallback: str
    unit: str
    tracks: Sequence[Track]
    still: Sequence[Any] = ()


def line(points: np.ndarray, colour: str, name: str = "", width: float = 3.0) -> go.Scatter3d:
    """A line through points, shape (n, 3); one without a name is not in the legend."""
    return go.Scatter3d(
        **_coordinates(points),
        mode="lines",
        line={"color": colour, "width": width},
        name=name,
        showlegend=bool(name),
        hoverinfo="skip" if not name else "name",
    )


def sphere(radius: float, colour: str, name: str, opacity: float = 0.25) -> go.Surface:
    """A sphere around the origin."""
    around, up = np.meshgrid(np.linspace(0, 2 * np.pi, 49), np.linspace(0, np.pi, 25))
    return go.Surface(
        x=radius * np.cos(around) * np.sin(up),
        y=radius * np.sin(around) * np.sin(up),
        z=radius * np.cos(up),
        colorscale=[[0, colour], [1, colour]],
        showscale=False,
        opacity=opacity,
        name=name,
        hoverinfo="name",
    )


def figure(scene: Scene) -> go.Figure:
    """The scene with an instant a frame; the page has the button that plays them."""
    still = [*scene.still, *(line(t.points, t.colour, t.name) for t in scene.tracks)]
    end = max(track.times[-1] for track in scene.tracks)
    instants = np.linspace(0.0, end, FRAMES)
    movers = list(range(len(still), len(still) + len(scene.tracks)))
    axis = {"title": {"text": scene.unit}, "backgroundcolor": TRANSPARENT, "gridcolor": "#8888"}
    return go.Figure(
        data=[*still, *_markers(scene.tracks, 0.0)],
        frames=[
            go.Frame(data=_markers(scene.tracks, time), traces=movers, name=f"{time:.0f} s")
            for time in instants
        ],
        layout={
            "scene": {
                "aspectmode": "data",
                "camera": {"eye": dict.fromkeys(DIMENSIONS, EYE)},
                **{f"{name}axis": axis for name in DIMENSIONS},
            },
            "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
            "paper_bgcolor": TRANSPARENT,
            "legend": {"orientation": "h"},
        },
    )


def _markers(tracks: Sequence[Track], time: float) -> list[go.Scatter3d]:
    """Where everything that moves is at a time, s; after its end it stays."""
    return [
        go.Scatter3d(
            **_coordinates(np.array([[np.interp(time, t.times, own) for own in t.points.T]])),
            mode="markers",
            marker={"color": t.colour, "size": 5},
            name=t.name,
            showlegend=False,
        )
        for t in tracks
    ]


def _coordinates(points: np.ndarray) -> dict[str, list[float]]:
    # Six digits are finer than a screen.
    return {
        name: [float(f"{value:.6g}") for value in points[:, place]]
        for place, name in enumerate(DIMENSIONS)
    }
