"""Figures 65 to 70: all cases compared, and the figures of the chapter's own section."""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from smallsat.drawing.style import BLACK, BLUE, CYCLE, GREEN, GREY, ORANGE, SKY, VERMILION, WIDTH
from smallsat.studies.transfer.figures.missing import NOT_CONVERGED, mark_missing
from smallsat.studies.transfer.methods.bounds import relative_length

# Figure 70 shows the flight from here on, and masses so near to the optimum: farther off no two
# methods can be told apart, and the cases that lie lower are seen in the gap beside it.
LAST_TAU = 0.99
MASS_ROOM = 0.0003
# Room between two panels, so that the label of an axis is not read as the other's.
GUTTER = 0.06


@dataclass(frozen=True)
class Style:
    """How a group of cases is drawn, so that none hides another that coincides with it."""

    colour: str
    width: float
    line: str
    size: float


GROUPS = {
    "indirect": Style(BLACK, 3.0, "-", 10.0),
    "indirect multiple": Style(SKY, 1.8, "-", 7.0),
    "direct multiple": Style(GREEN, 0.7, "-", 4.0),
    "direct": Style(VERMILION, 0.9, "--", 4.0),
}
# What `work` counts, as the axes say it.
WORK = "flights integrated, ours"


def work(cases: pd.DataFrame) -> pd.Series:
    """Flights that a finite-difference solver, like the document's, would integrate.

    Iterations times (unknowns + 1): a measure of cost that no machine changes.
    """
    return cases["iterations"] * (cases["unknowns"] + 1)


def cost_surface(cost: pd.DataFrame) -> Figure:
    """Figure 65: printed seconds and our work over N and K, as surfaces.

    Parameters
    ----------
    cost
        Columns degree, intervals, seconds (printed) and work.
    """
    return _surfaces(
        cost,
        {"seconds": "printed execution time (s)", "work": f"{WORK} (thousands)"},
        scale={"work": 1e-3},
    )


def time_surface(times: pd.DataFrame) -> Figure:
    """Figure 67: printed and converged final time over N and K, as surfaces."""
    return _surfaces(times, {"printed": "printed $t_f$", "converged": "converged $t_f$"})


def cost_lines(cost: pd.DataFrame) -> Figure:
    """Figure 66: cost against K, one line a degree."""
    figure, pair = plt.subplots(1, 2, figsize=(WIDTH, 2.8))
    for axes, column, label in zip(
        pair, ("seconds", "work"), ("printed execution time (s)", WORK), strict=True
    ):
        for degree, group in cost.groupby("degree"):
            axes.plot(group["intervals"], group[column], "-o", ms=3, label=f"N = {degree}")
        axes.set_xlabel("intervals K")
        axes.set_ylabel(label)
        axes.set_xticks(sorted(cost["intervals"].unique()))
    pair[0].legend()
    return figure


def cost_against_indirect(cost: pd.DataFrame, indirect: pd.DataFrame) -> Figure:
    """Figure 68: cost of direct and of indirect multiple shooting against K."""
    figure, pair = plt.subplots(
        1, 2, figsize=(WIDTH, 3.0), sharex=True, gridspec_kw={"wspace": GUTTER}
    )
    for axes, column, label in zip(
        pair, ("seconds", "work"), ("printed execution time (s)", WORK), strict=True
    ):
        for degree, group in cost.groupby("degree"):
            axes.plot(group["intervals"], group[column], "-o", ms=3, label=f"direct, N = {degree}")
        # Ours counts evaluations of another root finder, which vary more than fsolve's iterations.
        axes.plot(
            indirect["intervals"],
            indirect[column],
            "--s",
            color=BLACK,
            ms=4,
            label="indirect (right: by evaluations)",
        )
        axes.set_yscale("log")
        axes.set_xscale("log", base=2)
        axes.set_xlabel("intervals K")
        axes.set_ylabel(label)
        counts = sorted(cost["intervals"].unique())
        axes.set_xticks(counts, [str(count) for count in counts])
    handles, labels = pair[1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def mass_history(flown: pd.DataFrame, finals: pd.DataFrame) -> Figure:
    """Figure 69: mass against tau for every method, and the final masses enlarged.

    Parameters
    ----------
    flown
        Trajectories with columns label, tau, m.
    finals
        Columns label, final_time, final_mass, group.
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.0))
    for label, path in flown.groupby("label", sort=False):
        style = GROUPS[str(finals.loc[finals["label"] == label, "group"].iloc[0])]
        left.plot(path["tau"], path["m"], color=style.colour, lw=style.width, ls=style.line)
    if flown.empty:
        mark_missing(left)
    left.set_xlabel(r"$\tau$")
    left.set_ylabel("mass")
    for group, rows in finals.groupby("group", sort=False):
        style = GROUPS[str(group)]
        right.plot(
            rows["final_time"],
            rows["final_mass"],
            "o",
            ms=style.size,
            mfc="none",
            color=style.colour,
            label=group,
        )
    right.set_xlabel("$t_f$")
    right.set_ylabel("final mass")
    handles = [
        Line2D([], [], color=style.colour, lw=style.width, ls=style.line, label=group)
        for group, style in GROUPS.items()
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=4, fontsize=7)
    return figure


def mass_above_printed(flown: pd.DataFrame, finals: pd.DataFrame) -> Figure:
    """Figure 70: the end of the mass's history, and how far final masses lie below the optimum.

    Parameters
    ----------
    flown
        As of `mass_history`, with a column group; without single polynomials.
    finals
        Columns degree, intervals, optimum, and the masses printed, as_published, converged.
    """
    figure, (left, axes) = plt.subplots(
        1, 2, figsize=(WIDTH, 3.3), gridspec_kw={"width_ratios": [1, 1.9], "wspace": GUTTER}
    )
    for (group, _), path in flown[flown["tau"] >= LAST_TAU].groupby(["group", "label"], sort=False):
        style = GROUPS[str(group)]
        left.plot(path["tau"], path["m"], color=style.colour, lw=style.width, ls=style.line)
    left.set_xlabel(r"$\tau$")
    left.set_ylabel("mass")
    if len(flown) and finals["optimum"].notna().all():
        optimum = float(finals["optimum"].iloc[0])
        left.set_ylim(optimum - MASS_ROOM, float(flown["m"].max()) + MASS_ROOM)
    left.set_xticks([LAST_TAU, 1.0])
    position = np.arange(len(finals))
    for column, colour, marker in (
        ("printed", VERMILION, "D"),
        ("as_published", ORANGE, "v"),
        ("converged", BLUE, "o"),
    ):
        gap = finals["optimum"] - finals[column]
        axes.plot(
            position, gap.where(gap > 0), marker, ms=4, color=colour, label=column.replace("_", " ")
        )
    if finals["optimum"].isna().all():
        mark_missing(axes)
    above = finals["printed"] > finals["optimum"]
    if above.any():
        axes.plot(
            position[above],
            np.full(above.sum(), 0.97),
            "^",
            ms=5,
            mfc="none",
            color=VERMILION,
            transform=axes.get_xaxis_transform(),
            label="printed, above the optimum",
        )
    axes.set_yscale("log")
    axes.set_ylabel("optimum minus final mass")
    axes.set_xticks(position, finals["intervals"].astype(str), fontsize=7)
    # A second row of labels: the degree, under the numbers of intervals that share it.
    for degree, places in finals.reset_index().groupby("degree").groups.items():
        axes.annotate(
            f"N = {degree}",
            (float(np.mean(places)), -0.14),
            xycoords=axes.get_xaxis_transform(),
            ha="center",
            va="top",
            fontsize=8,
            annotation_clip=False,
        )
        axes.axvline(places[0] - 0.5, color=GREY, lw=0.6)
    axes.grid(False, axis="x")
    axes.set_xlim(-0.5, len(finals) - 0.5)
    axes.set_xlabel("intervals K, by degree", labelpad=19)
    handles, _ = axes.get_legend_handles_labels()
    handles += [
        Line2D([], [], color=style.colour, lw=style.width, ls=style.line, label=group)
        for group, style in GROUPS.items()
        if group in set(flown["group"])
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def printed_stop_figure(table: pd.DataFrame, optimum: float) -> Figure:
    """Final times where the printed tolerance stops the document's set-up, beside the printed ones.

    Parameters
    ----------
    table
        The table of `smallsat.studies.transfer.evidence.printed_stop.printed_stop_table`, with a
        column converged: the best final time within the printed bounds.
    optimum
        Final time of the indirect solution, which sets the scale; not a number if there is none.
    """
    count = max(1, table["intervals"].nunique())
    figure, grid = plt.subplots(1, count, figsize=(WIDTH, 3.0), sharey=True, squeeze=False)
    panels = grid[0]
    if table.empty:
        mark_missing(panels[0], "none of the printed cases")
        return figure
    low, high = 3.2468 * _scale(optimum), 3.2494 * _scale(optimum)
    for axes, (intervals, rows) in zip(panels, table.groupby("intervals"), strict=True):
        axes.axhline(optimum, color=BLACK, lw=0.8, ls="--")
        axes.plot(rows["degree"], rows["printed"], "D", ms=7, mfc="none", color=VERMILION)
        hit = rows[rows["equal_to_printed"]]
        axes.plot(rows["degree"], rows["final_time"], "o", ms=4, mfc="none", color=BLUE)
        axes.plot(hit["degree"], hit["final_time"], "o", ms=4, color=BLUE)
        axes.plot(rows["degree"], rows["converged"], "_", ms=8, color=GREEN)
        for row in rows[rows["final_time"] > high].itertuples():
            axes.annotate(
                f"{row.final_time:.2f}",
                (float(str(row.degree)), 0.98),
                xycoords=axes.get_xaxis_transform(),
                ha="center",
                va="top",
                fontsize=7,
                color=BLUE,
            )
        axes.margins(x=0.12)
        axes.set_title(f"K = {intervals}")
        axes.set_xlabel("degree N")
        axes.set_xticks(rows["degree"])
    panels[0].set_ylim(low, high)
    panels[0].set_ylabel("$t_f$")
    handles = [
        Line2D([], [], marker="D", ms=7, mfc="none", lw=0, color=VERMILION, label="printed"),
        Line2D(
            [], [], marker="o", ms=4, lw=0, color=BLUE, label="stopped, equal to the last digit"
        ),
        Line2D([], [], marker="o", ms=4, mfc="none", lw=0, color=BLUE, label="stopped, not equal"),
        Line2D([], [], marker="_", ms=8, lw=0, color=GREEN, label="converged"),
        Line2D([], [], color=BLACK, lw=0.8, ls="--", label="indirect optimum"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, fontsize=7)
    return figure


def continuity_figure(table: pd.DataFrame, optimum: float) -> Figure:
    """What a continuous control costs: distance to the optimum with and without it.

    Parameters
    ----------
    table
        Columns degree, intervals, free, continuous (final times).
    optimum
        Final time of the indirect solution.
    """
    figure, axes = plt.subplots(figsize=(WIDTH, 2.8))
    for colour, (intervals, group) in zip(CYCLE, table.groupby("intervals"), strict=False):
        axes.semilogy(
            group["degree"],
            group["free"] - optimum,
            "-o",
            ms=3,
            color=colour,
            label=f"K = {intervals}",
        )
        axes.semilogy(group["degree"], group["continuous"] - optimum, "--s", ms=3, color=colour)
    if table.empty:
        mark_missing(axes)
    axes.set_xlabel("degree N")
    axes.set_ylabel(r"$t_f$ minus the optimum")
    axes.set_xticks(sorted(table["degree"].unique()))
    axes.legend(title="solid: free, dashed: continuous", ncols=2)
    return figure


def multistart_figure(starts: pd.DataFrame, optimum: float, printed: pd.Series) -> Figure:
    """Final times of the converged random starts for a single polynomial, printed values marked.

    Parameters
    ----------
    starts
        Columns degree, start, final_time, converged.
    optimum
        Final time of the indirect solution, which sets the scale; not a number if there is none.
    printed
        Final times as Table 3 prints them, with ``degree`` in the index.
    """
    figure, axes = plt.subplots(figsize=(WIDTH, 2.8))
    for degree, group in starts[starts["converged"].astype(bool)].groupby("degree"):
        axes.plot(group["final_time"], np.full(len(group), degree), "|", color=BLUE, ms=10)
    axes.plot([], [], "|", color=BLUE, ms=10, label="a random start")
    degrees = printed.index.get_level_values("degree")
    axes.plot(printed, degrees, "D", color=VERMILION, ms=5, mfc="none", label="printed")
    scale = _scale(optimum)
    axes.set_xlim(3.2 * scale, 4.6 * scale)
    axes.set_xlabel("$t_f$")
    axes.set_ylabel("degree N")
    axes.set_yticks(sorted(starts["degree"].unique()))
    axes.legend()
    return figure


def _scale(optimum: float) -> float:
    # The document's own transfer where there is no optimum.
    return relative_length(optimum) if np.isfinite(optimum) else 1.0


def _surfaces(
    table: pd.DataFrame, columns: dict[str, str], scale: dict[str, float] | None = None
) -> Figure:
    figure = plt.figure(figsize=(WIDTH, 3.1))
    for place, (column, label) in enumerate(columns.items(), start=1):
        axes = figure.add_subplot(1, 2, place, projection="3d")
        grid = table.pivot(index="degree", columns="intervals", values=column)
        x, y = np.meshgrid(grid.columns, grid.index)
        height = grid.to_numpy(dtype=float) * (scale or {}).get(column, 1.0)
        if min(height.shape, default=0) < 2 or np.isnan(height).all():
            solved = not (height.size and np.isnan(height).all())
            mark_missing(axes, "too few cases for a surface" if solved else NOT_CONVERGED)
            axes.set_axis_off()
            continue
        axes.plot_surface(y, x, height, cmap="viridis", alpha=0.85, edgecolor="#333333", lw=0.4)
        axes.set_xlabel("N", labelpad=-4)
        axes.set_ylabel("K", labelpad=-4)
        axes.set_title(label)
        axes.set_xticks(grid.index)
        axes.set_yticks(grid.columns)
        axes.tick_params(labelsize=7, pad=-1)
        axes.tick_params(axis="z", pad=2)
        axes.zaxis.set_major_locator(MaxNLocator(5))
        axes.ticklabel_format(axis="z", useOffset=False)
        # As MATLAB looks at a surface, and the document with it.
        axes.view_init(30, -127.5)
    return figure
