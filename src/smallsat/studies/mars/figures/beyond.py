"""Figures beyond the document: control laws compared, and light and link over the day."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.pyplot import subplots

from smallsat.dynamics.units import HOUR
from smallsat.studies.mars.figures.colours import MODE_COLOURS, MODE_LABELS
from smallsat.studies.mars.figures.responses import mode_bands
from smallsat.studies.mars.methods.laws import IDEAL, WHEELS
from smallsat.studies.mars.model.control_laws import LAWS

COLOURS = {law: f"C{place}" for place, law in enumerate(LAWS)}
MARKERS = {"sun": "o", "nadir": "s", "gmo": "^"}
# Errors smaller than this are not told apart, deg.
LEAST_DEG = 1e-3


def laws_figure(missions: pd.DataFrame, settled_deg: float) -> Figure:
    """Pointing error over the mission by each law: above as the document has it, below by wheels.

    ``missions`` is ``laws-missions.parquet``; a line marks the error that counts as settled.
    """
    figure, panels = subplots(2, 1, sharex=True, sharey=True, figsize=(6.3, 4.4))
    titles = {IDEAL: "torques from outside, without limits", WHEELS: "reaction wheels"}
    for panel, (kind, title) in zip(panels, titles.items(), strict=True):
        shown = missions[missions["actuators"] == kind]
        for law, rows in shown.groupby("law", sort=False):
            panel.semilogy(
                rows["time_s"],
                rows["error_deg"].clip(lower=LEAST_DEG),
                color=COLOURS[str(law)],
                lw=1.1,
                label=law,
            )
        panel.axhline(settled_deg, color="0.3", lw=0.8, ls=":")
        bands = mode_bands(shown[shown["law"] == LAWS[0]], [panel])
        panel.set_title(title)
        panel.set_ylabel("pointing error [deg]")
    panels[0].set_xlim(0.0, missions["time_s"].max())
    panels[1].set_xlabel("time [s]")
    laws = dict(zip(LAWS, panels[0].get_lines(), strict=False)) | bands
    figure.legend(laws.values(), laws, loc="outside lower center", ncols=4)
    return figure


def robustness_figure(runs: pd.DataFrame, settled_deg: float) -> Figure:
    """Every run from a random attitude by wheels: late error and time to settle, over torque used.

    ``runs`` is ``laws-runs.parquet``; runs that never settle are drawn at the upper edge.
    """
    figure, (errors, times) = subplots(1, 2, figsize=(6.3, 3.3))
    longest = 1.1 * float(runs["settled_s"].max())
    for law, rows in runs.groupby("law", sort=False):
        for mode, chosen in rows.groupby("mode", sort=False):
            style = {"color": COLOURS[str(law)], "marker": MARKERS[str(mode)], "s": 7, "lw": 0}
            used = chosen["torque_used_N_m_s"]
            errors.scatter(used, chosen["late_error_deg"].clip(lower=LEAST_DEG), alpha=0.4, **style)
            times.scatter(used, chosen["settled_s"].fillna(longest), alpha=0.4, **style)
    errors.axhline(settled_deg, color="0.3", lw=0.8, ls=":")
    errors.set_yscale("log")
    errors.set_ylabel("late error [deg]")
    times.set_ylabel("time to settle [s]")
    if np.isfinite(longest) and runs["settled_s"].isna().any():
        times.annotate(
            "never",
            (1.0, longest),
            xycoords=("axes fraction", "data"),
            ha="right",
            va="bottom",
            fontsize=8,
        )
        times.set_ylim(top=1.08 * longest)
    for panel in (errors, times):
        panel.set_xlabel("torque used [N m s]")
    keys = [Line2D([], [], color=COLOURS[law], marker="o", lw=0, ms=4, label=law) for law in LAWS]
    keys += [
        Line2D(
            [], [], color="0.4", marker=marker, lw=0, ms=4, label=f"{MODE_LABELS[mode]} pointing"
        )
        for mode, marker in MARKERS.items()
    ]
    figure.legend(handles=keys, loc="outside lower center", ncols=4)
    return figure


def light_figure(intervals: pd.DataFrame, summary: pd.DataFrame) -> Figure:
    """When each condition of ``light-intervals.csv`` holds over the day, and for how much of it."""
    figure, axes = subplots(figsize=(6.3, 2.6))
    for row, (name, share) in enumerate(
        zip(summary["condition"], summary["share_percent"], strict=True)
    ):
        chosen = intervals[intervals["condition"] == name]
        starts, ends = chosen["start_s"] / HOUR, chosen["end_s"] / HOUR
        spans = list(zip(starts, ends - starts, strict=True))
        colour = "0.35" if row < 2 else MODE_COLOURS["gmo"]
        axes.broken_barh(spans, (row - 0.35, 0.7), color=colour, lw=0)
        axes.annotate(
            f"{share:.1f} %",
            (1.01, row),
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=8,
        )
    axes.set_yticks(range(len(summary)), summary["condition"])
    axes.invert_yaxis()
    # In a short run no condition may ever hold.
    if len(intervals):
        axes.set_xlim(0.0, intervals["end_s"].max() / HOUR)
    axes.set_xlabel("time [h]")
    axes.set_axisbelow(True)
    axes.grid(axis="y", visible=False)
    return figure
