"""The switching function of the shortest flight, and of longer ones that coast."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from smallsat.drawing.style import BLACK, BLUE, CYCLE, WIDTH
from smallsat.studies.transfer.figures.missing import mark_missing

# Excesses of the time whose switching functions are drawn.
SHOWN = (0.02, 0.1, 0.3)


def coasting_figure(flights: pd.DataFrame, paths: pd.DataFrame) -> Figure:
    """Primer vector and switching function in least time, in longer times, and what these save.

    Parameters
    ----------
    flights, paths
        Of `smallsat.studies.transfer.methods.coasting.coasting`.
    """
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(WIDTH, 2.9))
    least = paths[paths["excess"] == 0.0]
    primer = np.hypot(least["lambda_vr"], least["lambda_vtheta"])
    left.plot(least["t"], primer, color=BLUE, label=r"primer vector $|\lambda_v|$")
    left.plot(least["t"], least["switching"], color=BLACK, label="switching function S")
    left.set_title("least time")
    left.set_ylim(bottom=min(0.0, least["switching"].min()) if len(least) else 0.0)
    solved = [excess for excess in SHOWN if (paths["excess"] == excess).any()]
    for colour, excess in zip(CYCLE, solved, strict=False):
        path = paths[paths["excess"] == excess]
        largest = path["switching"].max()
        middle.plot(path["t"], path["switching"] / largest, color=colour, label=f"{excess:+.0%}")
        # The arcs that coast.
        coast = path[~path["thrusting"].astype(bool)]
        middle.plot(coast["t"], coast["switching"] / largest, color=colour, lw=3)
    middle.axhline(0.0, color=BLACK, lw=0.8)
    middle.set_title("least propellant: S, scaled")
    right.plot(flights["excess"], flights["saved"], "-o", ms=4, color=BLACK)
    right.set_title("propellant saved")
    right.set_xlabel("time above the least")
    for axis in (right.xaxis, right.yaxis):
        axis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    for axes in (left, middle):
        axes.set_xlabel("t (canonical)")
        if len(paths):
            axes.legend(fontsize=7)
        else:
            mark_missing(axes)
    return figure
