"""Figures 1 to 4: particle, frames, thrust and forces, drawn from the parameters."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from smallsat.drawing.style import BLACK, BLUE, GREEN, ORANGE, VERMILION
from smallsat.studies.transfer.figures.missing import mark_missing
from smallsat.studies.transfer.model.problem import TransferProblem

SIZE = (3.3, 3.0)


def orbit_figure(problem: TransferProblem, path: pd.DataFrame) -> tuple[Figure, pd.DataFrame]:
    """Figure 1: the spacecraft on its way between the two orbits, in the inertial plane."""
    figure, axes = _plane()
    turn = np.linspace(0, 2 * np.pi, 181)
    for radius, style in ((problem.initial_radius, "-"), (problem.final_radius, "--")):
        axes.plot(radius * np.cos(turn), radius * np.sin(turn), style, color="#999999", lw=0.8)
    x, y = path["r"] * np.cos(path["theta"]), path["r"] * np.sin(path["theta"])
    axes.plot(x, y, color=BLUE)
    here = len(path) // 3
    _arrow(axes, (0, 0), (x.iloc[here], y.iloc[here]), BLACK, "$r_{P/O}$", at=0.55)
    axes.plot(x.iloc[here], y.iloc[here], "o", color=BLACK, ms=4)
    axes.annotate("P, m", (x.iloc[here], y.iloc[here]), (6, 4), textcoords="offset points")
    axes.plot(0, 0, "o", color=ORANGE, ms=9)
    axes.annotate("O (Sun)", (0, 0), (-8, -14), textcoords="offset points")
    reach = 1.25 * max(problem.initial_radius, problem.final_radius)
    for tip, name in (((reach, 0), "$e_x$"), ((0, reach), "$e_y$")):
        _arrow(axes, (0, 0), tip, "#666666", name)
    axes.set_xlim(-reach, 1.15 * reach)
    axes.set_ylim(-reach, 1.15 * reach)
    return figure, pd.DataFrame({"x": x, "y": y})


def frame_figure(problem: TransferProblem, state: pd.Series) -> tuple[Figure, pd.DataFrame]:
    """Figure 2: the polar basis turned by theta from the inertial one, at a state of the path."""
    figure, axes = _plane()
    theta = float(state["theta"])
    vectors = {
        "$e_x$": (1.0, 0.0),
        "$e_y$": (0.0, 1.0),
        "$u_r$": (np.cos(theta), np.sin(theta)),
        r"$u_\theta$": (-np.sin(theta), np.cos(theta)),
    }
    for name, tip in vectors.items():
        _arrow(axes, (0, 0), tip, BLUE if "u" in name else "#666666", name)
    arc = np.linspace(0, theta, 40)
    axes.plot(0.35 * np.cos(arc), 0.35 * np.sin(arc), color=VERMILION)
    middle = theta / 2
    axes.text(0.43 * np.cos(middle), 0.43 * np.sin(middle), r"$\theta$", color=VERMILION)
    axes.text(0.05, -0.14, "$u_z = e_z$ out of the page", color="#666666", fontsize=7)
    axes.set_xlim(-1.25, 1.3)
    axes.set_ylim(-0.3, 1.3)
    return figure, _vector_table(vectors)


def thrust_figure(problem: TransferProblem, state: pd.Series) -> tuple[Figure, pd.DataFrame]:
    """Figure 3: the thrust at the angle beta above the local horizontal, in the polar basis."""
    figure, axes = _plane()
    beta = float(state["beta"])
    thrust = (np.cos(beta), np.sin(beta))
    vectors = {r"$u_\theta$": (1.0, 0.0), "$u_r$": (0.0, 1.0), "T": thrust}
    for name, tip in vectors.items():
        _arrow(axes, (0, 0), tip, VERMILION if name == "T" else BLUE, name)
    arc = np.linspace(0, beta, 40)
    axes.plot(0.4 * np.cos(arc), 0.4 * np.sin(arc), color=BLACK, lw=0.9)
    axes.text(0.48 * np.cos(beta / 2), 0.48 * np.sin(beta / 2), r"$\beta$")
    axes.plot(0, 0, "o", color=BLACK, ms=4)
    axes.annotate("P", (0, 0), (-12, -10), textcoords="offset points")
    axes.set_xlim(-0.4, 1.3)
    axes.set_ylim(-0.4, 1.3)
    return figure, _vector_table(vectors)


def force_figure(problem: TransferProblem, state: pd.Series) -> tuple[Figure, pd.DataFrame]:
    """Figure 4: gravity and thrust on the spacecraft, to one scale."""
    figure, axes = _plane()
    beta = float(state["beta"])
    gravity = problem.mu * state["m"] / state["r"] ** 2
    vectors = {
        "$F_G$": (0.0, -gravity),
        "$F_T$": (problem.thrust * np.cos(beta), problem.thrust * np.sin(beta)),
    }
    _arrow(axes, (0, 0), vectors["$F_G$"], GREEN, "$F_G$")
    # Thrust is small beside gravity: its name stands clear of the short arrow.
    _arrow(axes, (0, 0), vectors["$F_T$"], VERMILION, "$F_T$", at=1.9)
    unit = 0.35 * gravity
    _arrow(axes, (0, 0), (unit, 0), "#aaaaaa", r"$u_\theta$")
    _arrow(axes, (0, 0), (0, unit), "#aaaaaa", "$u_r$")
    axes.plot(0, 0, "o", color=BLACK, ms=5)
    axes.annotate("P", (0, 0), (-12, 2), textcoords="offset points")
    axes.set_xlim(-0.6 * gravity, 0.7 * gravity)
    axes.set_ylim(-1.15 * gravity, 0.6 * gravity)
    return figure, _vector_table(vectors)


def missing_figure() -> tuple[Figure, pd.DataFrame]:
    """In place of any of these, where there is no optimal path to draw from."""
    figure, axes = _plane()
    mark_missing(axes)
    return figure, pd.DataFrame(columns=["x", "y"])


def _plane() -> tuple[Figure, Axes]:
    figure, axes = plt.subplots(figsize=SIZE)
    axes.set_aspect("equal")
    axes.axis("off")
    return figure, axes


def _arrow(
    axes: Axes,
    start: tuple[float, float],
    tip: tuple[float, float],
    colour: str,
    name: str,
    at: float = 1.08,
) -> None:
    axes.annotate(
        "", tip, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.2, "shrinkB": 0}
    )
    x, y = np.array(start) + at * (np.array(tip) - np.array(start))
    axes.text(
        x,
        y,
        name,
        color=colour,
        ha="center",
        va="center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
    )


def _vector_table(vectors: dict[str, tuple[float, float]]) -> pd.DataFrame:
    rows = [{"vector": name.strip("$"), "x": x, "y": y} for name, (x, y) in vectors.items()]
    return pd.DataFrame(rows)
