"""How the final time's error falls with intervals and degree, beside theory."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from smallsat.drawing.style import BLACK, CYCLE, GREY, WIDTH
from smallsat.studies.transfer.figures.missing import mark_missing
from smallsat.studies.transfer.methods.convergence import (
    FEW_INTERVALS,
    FLOOR,
    INTERVALS,
    SHOOTING,
    refined,
    theoretical_order,
)

# Lower end of the axis, with room for a legend below the floor.
LEAST = 1e-15


def convergence_figure(table: pd.DataFrame) -> Figure:
    """Errors against the number of intervals and against the degree.

    Parameters
    ----------
    table
        Of `smallsat.studies.transfer.methods.convergence.convergence`.
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.9), sharey=True)
    for axes in (left, right):
        axes.set_yscale("log")
        axes.set_ylim(LEAST, 1.0)
        axes.axhline(FLOOR, color=GREY, lw=0.9, ls=":")
        if table.empty:
            mark_missing(axes)
    _by_intervals(left, table)
    _by_degree(right, table)
    left.set_ylabel("error of $t_f$, share of the optimum")
    if len(table):
        left.legend(loc="lower left", fontsize=7)
        right.legend(loc="lower left", fontsize=7)
    handles = [
        Line2D([], [], marker="o", ms=4, lw=0, color=BLACK, label="shooting"),
        Line2D([], [], marker="s", ms=4, lw=0, mfc="none", color=BLACK, label="collocation"),
        Line2D([], [], lw=1, color=BLACK, label="predicted from the extremal"),
        Line2D([], [], lw=0.9, ls="--", color=BLACK, label="slope of theory"),
        Line2D([], [], lw=0.9, ls=":", color=GREY, label="rates are read above"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, fontsize=7)
    return figure


def _by_intervals(axes: Axes, table: pd.DataFrame) -> None:
    for colour, (method, degree, rows) in zip(CYCLE, refined(table), strict=False):
        count, error = rows["intervals"], rows["error"].abs()
        order = theoretical_order(method, degree)
        if method == SHOOTING:
            axes.plot(count, rows["predicted"], color=colour, lw=1)
            label = f"N = {degree}: order {order}"
        else:
            slope = error.iloc[-1] * (count / count.iloc[-1]) ** -float(order)
            axes.plot(count.iloc[-3:], slope.iloc[-3:], "--", color=colour, lw=0.9)
            label = f"{method.removeprefix('collocation, ').capitalize()}, {degree}: order {order}"
        mark, face = ("o", colour) if method == SHOOTING else ("s", "none")
        axes.plot(count, error, mark, ms=4, mfc=face, color=colour, label=label)
    axes.set_xscale("log", base=2)
    axes.set_xticks(INTERVALS, [str(count) for count in INTERVALS])
    axes.set_xlabel("intervals K")


def _by_degree(axes: Axes, table: pd.DataFrame) -> None:
    rows = table[table["intervals"].isin(FEW_INTERVALS)].sort_values("degree")
    for colour, (intervals, group) in zip(CYCLE, rows.groupby("intervals"), strict=False):
        shot = group[(group["method"] == SHOOTING) & (group["degree"] > 0)]
        axes.plot(shot["degree"], shot["predicted"], color=colour, lw=1)
        axes.plot(shot["degree"], shot["error"], "o", ms=4, color=colour, label=f"K = {intervals}")
        other = group[group["method"] == "collocation, legendre"]
        axes.plot(other["degree"], np.abs(other["error"]), "s", ms=4, mfc="none", color=colour)
    axes.set_xlabel("degree N, or points of a collocation")
