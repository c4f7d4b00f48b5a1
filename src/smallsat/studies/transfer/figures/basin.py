"""The share of starts from which each method finds the optimum."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from smallsat.drawing.style import CYCLE, WIDTH
from smallsat.studies.transfer.figures.missing import mark_missing
from smallsat.studies.transfer.methods.basin import SPREADS

# Factor between the places of two methods at one spread, so that their intervals stand apart.
BESIDE = 1.05


def basin_figure(shares: pd.DataFrame) -> Figure:
    """Share that converges to the optimum against the spread of the starts, with its interval.

    Parameters
    ----------
    shares
        Of `smallsat.studies.transfer.methods.basin.shares`.
    """
    figure, axes = plt.subplots(figsize=(WIDTH, 2.8))
    groups = shares.groupby(["method", "unknowns"], sort=False)
    for place, (colour, ((method, unknowns), rows)) in enumerate(zip(CYCLE, groups, strict=False)):
        interval = [rows["optimum"] - rows["low"], rows["high"] - rows["optimum"]]
        axes.errorbar(
            rows["spread"] * BESIDE ** (place - 1),
            rows["optimum"],
            yerr=[side.clip(lower=0.0) for side in interval],
            fmt="-o",
            ms=4,
            capsize=2,
            color=colour,
            label=f"{method}: {unknowns} unknowns",
        )
    if shares.empty:
        mark_missing(axes)
    axes.set_xscale("log", base=2)
    axes.set_xticks(SPREADS, [f"{spread:g}" for spread in SPREADS])
    axes.set_xlabel("spread of the starts, share of each quantity's largest magnitude")
    axes.set_ylabel("ends at the optimum")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set_ylim(-0.03, 1.03)
    if len(shares):
        axes.legend(loc="lower left")
    return figure
