"""Figures of what the document names and does not do.

Elliptic prediction, a robust tube, and sweeps of impulse bits, rotation rates and orbits.

Each function returns the figure and the table of exactly what it draws.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.pyplot import subplots
from matplotlib.ticker import NullLocator

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLACK, BLUE, GREY, ORANGE, VERMILION
from smallsat.dynamics.units import MINUTE
from smallsat.studies.rendezvous.figures.sensitivity import log_axis
from smallsat.studies.rendezvous.monte_carlo.cases import AS_DOCUMENTED, TUBE

MODEL_STYLES = (
    {"color": VERMILION, "ls": "-", "marker": "o"},
    {"color": ORANGE, "ls": "--", "marker": "s"},
    {"color": BLUE, "ls": "-", "marker": "o"},
)


class Sweep(NamedTuple):
    """How a table of `smallsat.studies.rendezvous.monte_carlo.swept` is drawn.

    Attributes
    ----------
    label
        Of the swept value.
    linear_to
        Up to which value the axis is linear; beyond, it is logarithmic. ``None``: linear.
    scope
        Of delta-v and time: ``docking`` or ``whole``.
    """

    label: str
    linear_to: float | None
    scope: str


SWEEPS = {
    "impulse-bits": Sweep("minimum impulse bit [mN s]", 5.0, "docking"),
    "rotation": Sweep("target's rate [rad/s]", None, "docking"),
    "orbits": Sweep("eccentricity", 0.01, "whole"),
}
SCOPE_WORDS = {"docking": "docking", "whole": "whole manoeuvre"}
SWEPT_STYLES = [
    {"color": colour, "ls": line, "marker": marker}
    for colour in (BLUE, ORANGE, VERMILION)
    for line, marker in (("-", "o"), ("--", "s"))
]


def swept(table: pd.DataFrame, drawn: Sweep) -> Drawing:
    """Median delta-v and time, steps without a solution and what docks, over what is swept."""
    scope, words = drawn.scope, SCOPE_WORDS[drawn.scope]
    panels = {
        f"{scope}_delta_v_median_m_s": rf"$\Delta v$, {words} [m/s]",
        f"{scope}_time_median_min": f"time, {words} [min]",
        f"{scope}_unsolvable_pct": "steps without solution [%]",
        "docked_pct": "manoeuvres that dock [%]",
    }
    figure, grid = subplots(2, 2, figsize=(7.0, 4.6), sharex=True)
    variants, values = table["variant"].unique(), table["value"].unique()
    styles = SWEPT_STYLES if len(variants) > 2 else SWEPT_STYLES[:: len(SWEPT_STYLES) - 1]
    for panel, (column, label) in zip(grid.flat, panels.items(), strict=True):
        for variant, style in zip(variants, styles, strict=False):
            one = table[table["variant"] == variant]
            panel.plot(one["value"], one[column], ms=3.5, lw=1.1, label=variant, **style)
        if drawn.linear_to:
            panel.set_xscale("symlog", linthresh=drawn.linear_to)
            panel.set_xticks(values, [f"{value:g}" for value in values])
            panel.xaxis.set_minor_locator(NullLocator())
        panel.set(ylabel=label)
    for panel, column in zip(grid[0], panels, strict=False):
        log_axis(panel, table[column].min(), table[column].max())
    grid[1, 1].set_ylim(-3.0, 103.0)
    for panel in grid[-1]:
        panel.set_xlabel(drawn.label)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, fontsize=7)
    return figure, table


def elliptic(table: pd.DataFrame, horizons: Mapping[str, float]) -> Drawing:
    """Errors of predicted positions over the time ahead, a panel an eccentricity.

    ``table`` is what `smallsat.studies.rendezvous.methods.elliptic_prediction.errors` returns;
    ``horizons`` are those of the phases, s.
    """
    eccentricities = table["eccentricity"].unique()
    rows = -(-len(eccentricities) // 3)
    figure, grid = subplots(
        rows, 3, figsize=(7.0, 0.6 + 2.1 * rows), sharex=True, sharey=True, squeeze=False
    )
    for panel in grid.flat[len(eccentricities) :]:
        panel.set_visible(False)
    for number, (panel, e) in enumerate(zip(grid.flat, eccentricities, strict=False)):
        there = table[table["eccentricity"] == e]
        for name, style in zip(there["model"].unique(), MODEL_STYLES, strict=True):
            one = there[there["model"] == name]
            time = one["look_ahead_s"]
            panel.fill_between(
                time, one["low_m"], one["high_m"], color=style["color"], alpha=0.12, lw=0
            )
            label = name if number == 0 else None
            panel.plot(time, one["median_m"], ms=2.5, lw=1.2, label=label, **style)
        for name, horizon in horizons.items():
            panel.axvline(horizon, color=GREY, lw=0.8, ls=":")
            if number == 0:
                panel.annotate(name, (horizon, 0.98), xycoords=("data", "axes fraction"),
                               fontsize=6, rotation=90, ha="right", va="top")  # fmt: skip
        panel.set(xscale="log", yscale="log")
        panel.set_title(f"e = {e:g}", loc="left")
    for panel in grid[-1]:
        panel.set_xlabel("look-ahead [s]")
    for panel in grid[:, 0]:
        panel.set_ylabel("position error [m]")
    figure.legend(loc="outside upper center", ncols=3, fontsize=7)
    return figure, table


def tube(ways: pd.DataFrame, sizes: pd.DataFrame, distances: Mapping[str, float]) -> Drawing:
    """Ways to the port with and without a tube, and how much room tubes would need.

    Parameters
    ----------
    ways
        ``ways`` of `smallsat.studies.rendezvous.monte_carlo.docking_flights`.
    sizes
        What `smallsat.studies.rendezvous.monte_carlo.tubes.sizes` returns.
    distances
        Where docking ends and begins, m, by the words to draw; the first is the end.
    """
    figure, (left, right) = subplots(1, 2, figsize=(7.0, 3.2), width_ratios=(1.0, 1.1))
    shown = ways[ways["case"].isin([AS_DOCUMENTED, TUBE])]
    colours = {AS_DOCUMENTED: VERMILION, TUBE: BLUE}
    for (case, run), way in shown.groupby(["case", "run"], sort=False):
        label = case if run == shown["run"].iloc[0] else None
        left.plot(way["time_s"] / MINUTE, way["distance_m"], lw=0.9, alpha=0.8,
                  color=colours[str(case)], label=label)  # fmt: skip
    left.axhline(next(iter(distances.values())), color=BLACK, lw=0.8, ls=":")
    left.set(yscale="log", xlabel="time in docking [min]", ylabel="distance from the port [m]")
    left.set_xlim(0, None)
    # A run whose manoeuvres never come to dock has none to name.
    if not shown.empty:
        left.legend(fontsize=7, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))

    measured = sizes[sizes["source"] == "measurement"]
    thrust = sizes[(sizes["source"] == "thrust") & (sizes["error_share"] == 1.0)]
    drawn = pd.concat([measured, thrust], ignore_index=True)
    names = [
        "thrust at the bound" if source == "thrust" else f"measurement, times {share:g}"
        for source, share in zip(drawn["source"], drawn["error_share"], strict=True)
    ]
    lines = {name: -k for k, name in enumerate(dict.fromkeys(names))}
    at = np.array([lines[name] for name in names])
    for kind, filled in (("invariant", True), ("stationary", False)):
        chosen = (drawn["tube"] == kind).to_numpy()
        right.plot(drawn["tip_m"][chosen], at[chosen], "o", ms=5, color=BLUE,
                   mfc=BLUE if filled else "white", label=kind)  # fmt: skip
    for word, distance in distances.items():
        right.axvline(distance, color=BLACK, lw=0.8, ls=":")
        right.annotate(word, (distance, 0.02), xycoords=("data", "axes fraction"), fontsize=6,
                       rotation=90, ha="right", va="bottom")  # fmt: skip
    right.set(xscale="log", xlabel="tightened cone's tip from the port [m]")
    right.set_yticks(list(lines.values()), list(lines))
    right.set_ylim(min(lines.values()) - 0.6, 0.6)
    right.legend(fontsize=7, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    right.grid(axis="y", visible=False)
    table = pd.concat([shown.assign(panel="ways"), drawn.assign(panel="room")], ignore_index=True)
    return figure, table
