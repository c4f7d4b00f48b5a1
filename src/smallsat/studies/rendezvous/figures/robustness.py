"""Figures of chapter 5 and of what goes beyond it.

Each function returns the figure and the table of exactly what it draws.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.pyplot import subplots
from matplotlib.ticker import FuncFormatter

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLACK, BLUE, GREY, ORANGE, VERMILION, WIDTH
from smallsat.dynamics.units import HOUR, MINUTE

# The range "within 1 sigma" of Section 5.1, and the bounds that Figure 5.1 dots.
STATED_PCT, SIGMAS = 7.0, 3.0

# So many times the usual range of a variant would squeeze it.
FAR = 4.0


def thrust_errors(errors: pd.DataFrame) -> Drawing:
    """Sample paths of the thrust's amplitude error, with the steady bounds.

    ``errors`` is what `smallsat.studies.rendezvous.model.actuation_noise.sampling` returns.
    """
    figure, axes = subplots(figsize=(WIDTH, 3.2))
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


def averages(
    disturbed: pd.DataFrame, undisturbed: pd.DataFrame, printed: Mapping[str, float]
) -> Drawing:
    """Mean delta-v against mean time of each initial state, and the deviations over its runs.

    Both tables are those of `smallsat.studies.rendezvous.evidence.robustness_claims.by_state`.
    ``printed`` has the document's mean deviations by the names of their columns.
    """
    data = pd.concat(
        [table.reset_index().assign(case=name) for name, table in
         (("disturbed", disturbed), ("undisturbed", undisturbed))], ignore_index=True,
    )  # fmt: skip
    data["mean_time_min"] = data["time_s"] / MINUTE
    data["deviation_time_min"] = data["deviation_time_s"] / MINUTE
    figure, (means, spread) = subplots(1, 2, figsize=(WIDTH, 3.1))
    for case, colour, label in (
        ("undisturbed", GREY, "undisturbed"),
        ("disturbed", BLUE, "disturbed: runs from one state"),
    ):
        rows = data[data["case"] == case]
        means.plot(
            rows["mean_time_min"], rows["delta_v_m_s"], "o", ms=3.2, alpha=0.8, color=colour,
            label=label,
        )  # fmt: skip
    means.set(xlabel="mean manoeuvre time [min]", ylabel=r"mean $\Delta v$ [m/s]")
    rows = data[data["case"] == "disturbed"]
    time, delta_v = rows["deviation_time_min"], rows["deviation_delta_v_m_s"]
    spread.plot(time, delta_v, "o", ms=3.2, alpha=0.8, color=BLUE)
    spread.plot(time.mean(), delta_v.mean(), "D", ms=7, color=BLACK, label="mean over the states")
    spread.plot(
        printed["deviation_time_min"], printed["deviation_delta_v_m_s"], "X", ms=9,
        color=VERMILION, label="mean, as printed",
    )  # fmt: skip
    spread.set(xlabel="deviation of time [min]", ylabel=r"deviation of $\Delta v$ [m/s]")
    for panel, name in zip((means, spread), "ab", strict=True):
        panel.set_ylim(0, None)
        panel.set_xlim(0, None)
        panel.set_title(f"({name})", loc="left")
    figure.legend(loc="outside upper center", ncols=4, handletextpad=0.2, columnspacing=1.2)
    columns = ["case", "sample", "mean_time_min", "delta_v_m_s", "deviation_time_min",
               "deviation_delta_v_m_s"]  # fmt: skip
    return figure, data[columns]


def bounce_map(table: pd.DataFrame, baseline: float, printed: Mapping[str, float]) -> Drawing:
    """Mean deviations over docking distance and time limit, and where the printed ones lie.

    Columns of ``table``: ``end_distance_m``, ``time_limit_min``, ``deviation_delta_v_m_s``,
    ``deviation_time_min``, ``docked_share``. ``baseline`` is the docking distance of all other
    studies, m. ``printed`` has the document's mean deviations by the names of their columns.
    """
    figure, axes = subplots(1, 3, figsize=(WIDTH, 2.5), sharey=True)
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
        panel.pcolormesh(x, y, values, cmap="cividis", shading="nearest", vmin=0)
        middle = 0.5 * float(np.nanmax(values))
        for i in y:
            for j in x:
                value = values[i, j]
                text = f"{value:.0f}" if value >= 9.95 else f"{value:.1f}"
                shade = "white" if value < middle else "black"
                panel.text(j, i, text, ha="center", va="center", fontsize=6, color=shade)
        if stated is not None:
            _between_cells(panel, values < stated)
        title = label if stated is None else f"{label}\nprinted: {stated:g}"
        panel.set_title(title, loc="left", fontsize=8, pad=9)
        panel.set_xticks(x, [f"{100 * one:g}" for one in grid.columns], fontsize=6)
        panel.set_yticks(y, [f"{one:g}" for one in grid.index])
        panel.set_xlabel(r"docking distance $r_3$ [cm]")
        panel.grid(visible=False)
        at = float(np.interp(baseline, grid.columns.to_numpy(dtype=float), np.array(x)))
        panel.plot(at, y[-1] + 0.7, "v", ms=5, color=BLACK, clip_on=False)
        panel.set_ylim(-0.5, y[-1] + 0.5)
    axes[0].set_ylabel("time limit [min]")
    return figure, table


def _between_cells(panel: Axes, below: np.ndarray) -> None:
    """A line along the edges between cells that are below a level and cells that are not."""
    lines: dict[str, Any] = {"color": VERMILION, "lw": 2.0}
    for i, j in zip(*np.nonzero(below[:, 1:] != below[:, :-1]), strict=True):
        panel.plot([j + 0.5, j + 0.5], [i - 0.5, i + 0.5], **lines)
    for i, j in zip(*np.nonzero(below[1:] != below[:-1]), strict=True):
        panel.plot([j - 0.5, j + 0.5], [i + 0.5, i + 0.5], **lines)


def variants(table: pd.DataFrame) -> Drawing:
    """Change that each variant makes: median and 5 to 95 % of the initial states.

    ``table`` holds one topic of `smallsat.studies.rendezvous.monte_carlo.summaries.variants`. Where
    one variant would squeeze all others, the axis is logarithmic beyond one per cent.
    """
    figure, axes = subplots(1, 2, figsize=(WIDTH, 0.7 + 0.24 * len(table)), sharey=True)
    lines = np.arange(len(table))[::-1]
    for panel, name, label in zip(axes, ("delta_v", "time"), (r"$\Delta v$", "time"), strict=True):
        low, high = table[f"{name}_low_pct"], table[f"{name}_high_pct"]
        panel.axvline(0.0, color=BLACK, lw=0.8)
        panel.hlines(lines, low, high, color=BLUE, lw=1.6)
        panel.plot(table[f"{name}_median_pct"], lines, "o", ms=4, color=BLUE)
        reach = np.maximum(np.abs(low), np.abs(high))
        if np.max(reach) > FAR * np.median(reach):
            panel.set_xscale("symlog", linthresh=1.0, linscale=0.7)
            panel.set_xticks([sign * 10.0**k for sign in (-1, 1) for k in range(3)] + [0.0])
            panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            panel.set_xlim(1.4 * min(low.min(), -1.0), 1.4 * max(high.max(), 1.0))
        panel.set_yticks(lines, table["variant"])
        panel.set_xlabel(f"change of {label} [%]")
        panel.set_ylim(-0.7, len(table) - 0.3)
        panel.grid(axis="y", visible=False)
    return figure, table
