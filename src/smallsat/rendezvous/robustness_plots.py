"""Figures of chapter 5 and of what goes beyond it.

Each function returns the figure and the table of exactly what it draws.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.pyplot import subplots

from smallsat.drawing.style import BLACK, BLUE, ORANGE, VERMILION

Drawing = tuple[Figure, pd.DataFrame]
MINUTE, HOUR = 60.0, 3600.0
GREY = "#9a9a9a"


def thrust_errors(errors: pd.DataFrame, deviation: float, stated: float) -> Drawing:
    """Sample paths of the thrust amplitude error, with three times its steady deviation.

    Columns of ``errors``: ``path``, ``time_s``, ``error`` (of the nominal thrust). ``deviation`` is
    the steady standard deviation, ``stated`` the printed one; both of the nominal thrust.
    """
    figure, axes = subplots(figsize=(6.3, 3.2))
    for _, path in errors.groupby("path"):
        axes.plot(path["time_s"] / HOUR, 100.0 * path["error"], lw=0.6, color=BLUE, alpha=0.5)
    for sign in (-1.0, 1.0):
        axes.axhline(300.0 * sign * deviation, ls=":", color=BLACK, lw=1.3)
    axes.axhspan(-100.0 * stated, 100.0 * stated, color=ORANGE, alpha=0.15, lw=0)
    end = errors["time_s"].max() / HOUR
    axes.annotate("3 sigma", (end, 300.0 * deviation), ha="right", va="bottom",
                  textcoords="offset points", xytext=(0, 2))  # fmt: skip
    axes.annotate("stated range", (0, 100.0 * stated), ha="left", va="bottom", color="#a06a00",
                  textcoords="offset points", xytext=(3, 2))  # fmt: skip
    axes.set(xlabel="time [h]", ylabel="error of the thrust [%]", xlim=(0, end))
    return figure, errors


def averages(disturbed: pd.DataFrame, undisturbed: pd.DataFrame) -> Drawing:
    """Mean delta-v against mean time of each initial state, with deviations over its runs.

    Both tables are those of `smallsat.rendezvous.robustness_claims.by_state`.
    """
    data = pd.concat(
        [table.reset_index().assign(case=name) for name, table in
         (("disturbed", disturbed), ("undisturbed", undisturbed))], ignore_index=True,
    )  # fmt: skip
    data["mean_time_min"] = data["time_s"] / MINUTE
    data["deviation_time_min"] = data["deviation_time_s"] / MINUTE
    figure, axes = subplots(figsize=(5.6, 3.8))
    rows = data[data["case"] == "disturbed"]
    axes.errorbar(
        rows["mean_time_min"],
        rows["delta_v_m_s"],
        xerr=rows["deviation_time_min"],
        yerr=rows["deviation_delta_v_m_s"],
        fmt="o",
        ms=3.2,
        color=BLUE,
        ecolor=BLUE,
        elinewidth=0.6,
        alpha=0.5,
        label="runs from a state: mean, deviation",
    )
    calm = data[data["case"] == "undisturbed"]
    axes.plot(calm["mean_time_min"], calm["delta_v_m_s"], "o", ms=3.0, color=GREY,
              label="undisturbed")  # fmt: skip
    axes.set(xlabel="mean manoeuvre time [min]", ylabel=r"mean $\Delta v$ [m/s]")
    axes.set_ylim(0, None)
    axes.set_xlim(0, None)
    figure.legend(loc="outside upper center", ncols=2)
    columns = ["case", "sample", "mean_time_min", "delta_v_m_s", "deviation_time_min",
               "deviation_delta_v_m_s"]  # fmt: skip
    return figure, data[columns]


def bounce_map(
    table: pd.DataFrame, printed_delta_v: float, printed_time_min: float, baseline: float
) -> Drawing:
    """Mean deviations over docking distance and time limit, and the printed ones as lines.

    Columns of ``table``: ``end_distance_m``, ``time_limit_min``, ``deviation_delta_v_m_s``,
    ``deviation_time_min``, ``docked_share``. ``baseline`` is the docking distance of all other
    studies, m.
    """
    figure, axes = subplots(1, 3, figsize=(7.0, 3.1), sharey=True)
    panels = (
        ("deviation_delta_v_m_s", r"deviation of $\Delta v$ [m/s]", printed_delta_v),
        ("deviation_time_min", "deviation of time [min]", printed_time_min),
        ("docked_share", "share that docks", None),
    )
    for panel, (name, label, printed) in zip(axes, panels, strict=True):
        grid = table.pivot(index="time_limit_min", columns="end_distance_m", values=name)
        values = grid.to_numpy(dtype=float)
        x, y = range(grid.shape[1]), range(grid.shape[0])
        image = panel.pcolormesh(x, y, values, cmap="cividis", shading="nearest", vmin=0)
        middle = 0.5 * float(np.nanmax(values))
        for i in y:
            for j in x:
                value = values[i, j]
                panel.text(j, i, f"{value:.3g}", ha="center", va="center", fontsize=6.5,
                           color="white" if value < middle else "black")  # fmt: skip
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        if printed is not None and low < printed < high:
            panel.contour(x, y, values, levels=[printed], colors=VERMILION, linewidths=2)
        title = label if printed is None else f"{label}\nprinted: {printed:g}"
        panel.set_title(title, loc="left")
        panel.set_xticks(x, [f"{100 * one:g}" for one in grid.columns])
        panel.set_yticks(y, [f"{one:g}" for one in grid.index])
        panel.set_xlabel(r"docking distance $r_3$ [cm]")
        panel.grid(visible=False)
        for at in np.flatnonzero(np.isclose(grid.columns.to_numpy(dtype=float), baseline)):
            panel.get_xticklabels()[at].set_fontweight("bold")
        figure.colorbar(image, ax=panel, location="bottom", shrink=0.9, aspect=25)
    axes[0].set_ylabel("time limit [min]")
    return figure, table


def variants(table: pd.DataFrame, columns: Sequence[tuple[str, str]]) -> Drawing:
    """Median and quantiles of the paired change that each variant makes, one line a variant.

    Columns of ``table``: ``variant``, and for each of ``columns`` (name, label) the quantiles
    ``<name>_low``, ``<name>_median``, ``<name>_high`` of the change.
    """
    height = 0.9 + 0.26 * len(table)
    figure, axes = subplots(1, len(columns), figsize=(6.8, height), sharey=True)
    lines = np.arange(len(table))[::-1]
    for panel, (name, label) in zip(np.atleast_1d(axes), columns, strict=True):
        panel.axvline(0.0, color=BLACK, lw=0.8)
        panel.hlines(lines, table[f"{name}_low"], table[f"{name}_high"], color=BLUE, lw=1.6)
        panel.plot(table[f"{name}_median"], lines, "o", ms=4, color=BLUE)
        panel.set_yticks(lines, table["variant"])
        panel.set_xlabel(label)
        panel.set_ylim(-0.7, len(table) - 0.3)
        panel.grid(axis="y", visible=False)
    return figure, table
