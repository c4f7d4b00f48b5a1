"""The pointing modes over the Mars day: a timeline and the share of each."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.pyplot import subplots

from smallsat.dynamics.units import HOUR
from smallsat.studies.mars.figures.colours import MODE_COLOURS, MODE_LABELS
from smallsat.studies.mars.model.modes import MODE_NAMES
from smallsat.studies.mars.parameters import MARS_DAY


def mode_figure(intervals: pd.DataFrame, shares: pd.DataFrame) -> Figure:
    """Timeline above, shares below, from ``modes.csv`` and ``mode-shares.csv``."""
    figure, (line, share) = subplots(2, 1, figsize=(6.3, 2.9), height_ratios=(3, 1))
    for row, mode in enumerate(MODE_NAMES):
        chosen = intervals[intervals["mode"] == mode]
        spans = list(zip(chosen["start_s"] / HOUR, chosen["duration_s"] / HOUR, strict=True))
        line.broken_barh(spans, (row - 0.4, 0.8), color=MODE_COLOURS[mode], lw=0)
    line.set_yticks(range(len(MODE_NAMES)), [MODE_LABELS[mode] for mode in MODE_NAMES])
    line.invert_yaxis()
    line.set_xlim(0.0, intervals["end_s"].max() / HOUR)
    line.set_xlabel("time [h]")
    end = intervals["end_s"].max()
    span, whole = ("a Mars day", "day") if end == MARS_DAY else (f"{end / HOUR:.3g} h", "time")
    line.set_title(f"{len(intervals) - 1} mode switches in {span}")
    line.set_axisbelow(True)
    line.grid(axis="y", visible=False)

    left = 0.0
    for mode, percent in zip(shares["mode"], shares["share_percent"], strict=True):
        share.barh(0, percent, left=left, color=MODE_COLOURS[mode])
        share.annotate(
            f"{MODE_LABELS[mode]} {percent:.1f} %",
            (left + percent / 2, 0.55),
            ha="center",
            va="bottom",
            fontsize=8,
        )
        left += percent
    share.set(xlim=(0, 100), ylim=(-0.5, 1.3), yticks=[], xlabel=f"share of the {whole} [%]")
    share.grid(visible=False)
    share.spines["left"].set_visible(False)
    return figure
