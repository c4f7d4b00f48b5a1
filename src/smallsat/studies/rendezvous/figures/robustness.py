"""Figures of chapter 5 and of what goes beyond it.

Each function returns the figure and the table of exactly what it draws.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLACK, BLUE, GREY, ORANGE, VERMILION
from smallsat.dynamics.units import HOUR, MINUTE

# The range "within 1 sigma" of Section 5.1, and the bounds that Figure 5.1 dots.
STATED_PCT, SIGMAS = 7.0, 3.0

# An axis ends at so many times the usual range of a variant.
CUT = 4.0


def thrust_errors(errors: pd.DataFrame) -> Drawing:
    """Sample paths of the thrust's amplitude error, with the steady bounds.

    ``errors`` is what `smallsat.studies.rendezvous.model.actuation_noise.sampling` returns.
    """
    figure, axes = subplots(figsize=(6.3, 3.2))
    for _, path in errors.groupby("sample"):
        axes.plot(path["time_s"] / HOUR, path["error_percent"], lw=0.6, color=BLUE, alpha=0.5)
    bound, end = float(errors["three_sigma_percent"].iloc[0]), errors["time_s"].max() / HOUR
    for sign in (-1.0, 1.0):
        axes.axhline(sign * bound, ls=":", color=BLACK, lw=1.3)
    axes.axhspan(-STATED_PCT, STATED_PCT, color=ORANGE, alpha=0.15, lw=0)
    at_end: dict[str, Any] = {"textcoords": "offset points", "va": "bottom", "ha": "right"}
    axes.annotate(f"{SIGMAS:g} sigma", (end, bound), xytext=(0, 2), **at_end)
    axes.annotate(
        "stated range",
        (end, STATED_PCT),
        xytext=(-2, 2),
        color="#8a5a00",
        bbox={"facecolor": "white", "alpha": 0.8, "lw": 0, "pad": 1},
        **at_end,
    )
    axes.set(xlabel="time [h]", ylabel="error of the thrust [%]", xlim=(0, end))
    return figure, errors


def averages(disturbed: pd.DataFrame, undisturbed: pd.DataFrame) -> Drawing:
    """Mean delta-v against mean time of each initial state, with deviations over its runs.

    Both tables are those of `smallsat.studies.rendezvous.evidence.robustness_claims.by_state`.
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
        fmt="none",
        ecolor=BLUE,
        elinewidth=0.4,
        alpha=0.3,
    )
    axes.plot(
        rows["mean_time_min"],
        rows["delta_v_m_s"],
        "o",
        ms=3.2,
        color=BLUE,
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


def bounce_map(table: pd.DataFrame, baseline: float, printed: Mapping[str, float]) -> Drawing:
    """Mean deviations over docking distance and time limit, and the printed ones as lines.

    Columns of ``table``: ``end_distance_m``, ``time_limit_min``, ``deviation_delta_v_m_s``,
    ``deviation_time_min``, ``docked_share``. ``baseline`` is the docking distance of all other
    studies, m. ``printed`` has the document's mean deviations by the names of their columns.
    """
    figure, axes = subplots(1, 3, figsize=(7.0, 3.1), sharey=True)
    table = table.assign(docked_pct=100.0 * table["docked_share"])
    panels = (
        ("deviation_delta_v_m_s", r"deviation of $\Delta v$ [m/s]"),
        ("deviation_time_min", "deviation of time [min]"),
        ("docked_pct", "share that docks [%]"),
    )
    for panel, (name, label) in zip(axes, panels, strict=True):
        stated = printed.get(name)
        grid = table.pivot(index="time_limit_min", columns="end_distance_m", values=name)
        values = grid.to_numpy(dtype=float)
        x, y = range(grid.shape[1]), range(grid.shape[0])
        image = panel.pcolormesh(x, y, values, cmap="cividis", shading="nearest", vmin=0)
        middle = 0.5 * float(np.nanmax(values))
        for i in y:
            for j in x:
                value = values[i, j]
                text = f"{value:.0f}" if value >= 9.95 else f"{value:.1f}"
                shade = "white" if value < middle else "black"
                panel.text(j, i, text, ha="center", va="center", fontsize=6.5, color=shade)
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        if stated is not None and low < stated < high:
            panel.contour(x, y, values, levels=[stated], colors=VERMILION, linewidths=2)
        title = label if stated is None else f"{label}\nprinted: {stated:g}"
        panel.set_title(title, loc="left")
        panel.set_xticks(x, [f"{100 * one:g}" for one in grid.columns], fontsize=7)
        panel.set_yticks(y, [f"{one:g}" for one in grid.index])
        panel.set_xlabel(r"docking distance $r_3$ [cm]")
        panel.grid(visible=False)
        at = float(np.interp(baseline, grid.columns.to_numpy(dtype=float), np.array(x)))
        panel.axvline(at, color="white", lw=1.0, ls="--")
        figure.colorbar(image, ax=panel, location="bottom", shrink=0.9, aspect=25)
    axes[0].set_ylabel("time limit [min]")
    return figure, table


def variants(table: pd.DataFrame) -> Drawing:
    """Change that each variant makes: median and 5 to 95 % of the initial states.

    ``table`` holds one topic of `smallsat.studies.rendezvous.monte_carlo.summaries.variants`.
    """
    figure, axes = subplots(1, 2, figsize=(6.8, 0.9 + 0.26 * len(table)), sharey=True)
    lines = np.arange(len(table))[::-1]
    for panel, name, label in zip(axes, ("delta_v", "time"), (r"$\Delta v$", "time"), strict=True):
        panel.axvline(0.0, color=BLACK, lw=0.8)
        panel.hlines(lines, table[f"{name}_low_pct"], table[f"{name}_high_pct"], color=BLUE, lw=1.6)
        panel.plot(table[f"{name}_median_pct"], lines, "o", ms=4, color=BLUE)
        _cut_outliers(panel, table, lines, name)
        panel.set_yticks(lines, table["variant"])
        panel.set_xlabel(f"change of {label} [%]")
        panel.set_ylim(-0.7, len(table) - 0.3)
        panel.grid(axis="y", visible=False)
    return figure, table


def _cut_outliers(panel: Axes, table: pd.DataFrame, lines: np.ndarray, name: str) -> None:
    """End the axis where one variant would squeeze all others, and say how far that one goes."""
    low, high = table[f"{name}_low_pct"].to_numpy(), table[f"{name}_high_pct"].to_numpy()
    usual = CUT * float(np.median(np.maximum(np.abs(low), np.abs(high))))
    most = max(float(np.abs(low).max()), float(np.abs(high).max()))
    if most <= usual or usual == 0.0:
        return
    panel.set_xlim(max(1.1 * low.min(), -usual), min(1.1 * high.max(), usual))
    for line, end in zip(lines, high, strict=True):
        if end > usual:
            panel.text(0.99 * usual, line + 0.12, f"to {end:.0f}", fontsize=6, ha="right")
