"""Figures of chapter 4 and appendix A: scatter plots of many manoeuvres, and their quantiles.

Each function returns the figure and the table of exactly what it draws.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.pyplot import subplots
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, WIDTH
from smallsat.dynamics.units import KM, MINUTE
from smallsat.studies.rendezvous.inference.axes import PrintedAxes
from smallsat.studies.rendezvous.monte_carlo.cases import PHASES, sweep_case
from smallsat.studies.rendezvous.monte_carlo.tables import column, totals

# Hundreds of dots a colour stay readable when each is small and lets the others through.
DOT: dict[str, Any] = {"s": 7.0, "alpha": 0.55, "linewidths": 0.0}
QUADRANT_COLOURS = {1: BLUE, 2: GREEN, 3: ORANGE, 4: VERMILION}
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
DARK = "0.3"
RINGS_KM = (0.15, 0.5, 1.0, 1.5, 2.0, 2.5)


def positions(states: pd.DataFrame) -> Drawing:
    """Initial positions in the orbital plane."""
    figure, axes = subplots(figsize=(4.2, 4.2))
    axes.scatter(states["y_m"] / KM, states["x_m"] / KM, color=BLUE, **DOT)
    _orbit_axes(axes)
    return figure, states[["sample", "x_m", "y_m", "z_m"]]


def by_quadrant(states: pd.DataFrame, rows: pd.DataFrame) -> Drawing:
    """Initial positions and cost of the manoeuvre, coloured by quadrant of the orbital plane."""
    data = _costs(states, rows)
    colours = data["quadrant"].map(QUADRANT_COLOURS)
    entries = [(f"quadrant {q}", colour) for q, colour in QUADRANT_COLOURS.items()]
    figure = _pair(data, colours)
    _legend(figure, entries)
    return figure, data


def by_distance(states: pd.DataFrame, rows: pd.DataFrame) -> Drawing:
    """Initial positions and cost of the manoeuvre, coloured by initial distance."""
    data = _costs(states, rows)
    rings = list(pairwise(RINGS_KM))
    palette = shades(len(rings))
    ring = np.clip(np.digitize(data["distance_m"] / KM, RINGS_KM) - 1, 0, len(rings) - 1)
    figure = _pair(data, [palette[i] for i in ring])
    _legend(figure, [(f"{a:g} to {b:g} km", palette[i]) for i, (a, b) in enumerate(rings)])
    return figure, data


def costs_beside_baseline(
    states: pd.DataFrame, rows: pd.DataFrame, baseline: pd.DataFrame, name: str
) -> Drawing:
    """Cost of every manoeuvre of a variant, with the baseline's in grey."""
    data = pd.concat(
        [_costs(states, one).assign(case=case) for case, one in
         (("baseline", baseline), (name, rows))], ignore_index=True,
    )  # fmt: skip
    figure, axes = subplots(figsize=(5.0, 3.4))
    for case, colour in (("baseline", GREY), (name, BLUE)):
        one = data[data["case"] == case]
        axes.scatter(one["time_min"], one["delta_v_m_s"], color=colour, **DOT)
    _cost_axes(axes)
    _legend(figure, [("QP with set point", GREY), (name, BLUE)])
    return figure, data


def sweep(
    table: pd.DataFrame,
    phase: str,
    horizon: int,
    sample_times: Sequence[float],
    printed: PrintedAxes | None,
) -> Drawing:
    """Delta-v of a phase against its time and its number of actuations, by sample time.

    Axes end before the few outermost manoeuvres where those would squeeze all others; how many lie
    beyond is said. Where the document's axes can be read they are a frame, and only the sample
    times of its legend are drawn.
    """
    if printed:
        sample_times = [t for t in sample_times if t in printed.sample_times]
    quantities = ("time_s", "steps", "delta_v_m_s")
    done = table[table["completed"]]
    palette = shades(len(sample_times))
    parts, entries = [], []
    for i, t in enumerate(sample_times):
        case = sweep_case(horizon, t)
        rows = done[done["case"] == case]
        left_out = int((table["case"] == case).sum()) - len(rows)
        parts.append(
            pd.DataFrame(
                {"sample_time_s": t, "sample": rows["sample"].to_numpy()}
                | {name: rows[column(phase, name)].to_numpy() for name in quantities}
            ).assign(shade=i)
        )
        note = f" ({left_out} not completed)" if left_out else ""
        entries.append((f"{t:g} s{note}", palette[i]))
    # Dots of all sample times in turn, so that no colour lies on top of the others.
    data = pd.concat(parts, ignore_index=True).sort_values(["sample", "sample_time_s"])
    figure, axes = subplots(1, 2, figsize=(WIDTH, 3.2), sharey=True)
    colours = [palette[i] for i in data["shade"]]
    axes[0].scatter(data["time_s"] / MINUTE, data["delta_v_m_s"], color=colours, **DOT)
    axes[1].scatter(data["steps"], data["delta_v_m_s"], color=colours, **DOT)
    handles = [_handle(colour, label) for label, colour in entries]
    drawn = (data["time_s"] / MINUTE, data["steps"], data["delta_v_m_s"])
    ends = [_end(values) for values in drawn]
    begins = [_begin(values) for values in drawn]
    if printed:
        levels = (printed.time_min, printed.intervals, printed.delta_v_m_s)
        ends = [max(end, 1.04 * level[1]) for end, level in zip(ends, levels, strict=True)]
        begins = [min(begin, 0.96 * level[0]) for begin, level in zip(begins, levels, strict=True)]
        frame: dict[str, Any] = {"color": DARK, "lw": 0.9, "ls": "--"}
        handles.append(Line2D([], [], label="axes as printed", **frame))
        for one, (left, right) in zip(axes, levels, strict=False):
            low, high = printed.delta_v_m_s
            one.add_patch(
                Rectangle((left, low), right - left, high - low, fill=False, clip_on=False, **frame)
            )
    for one, begin, end in zip(axes, begins, ends, strict=False):
        one.set_xlim(begin, end)
    axes[0].set_ylim(begins[2], ends[2])
    beyond = (
        (data["time_s"] / MINUTE > ends[0])
        | (data["steps"] > ends[1])
        | (data["delta_v_m_s"] > ends[2])
    )
    if beyond.any():
        axes[1].set_title(f"{int(beyond.sum())} of {len(data)} dots lie beyond", loc="right")
    axes[0].set(xlabel="time of the phase [min]", ylabel=rf"$\Delta v$ of the {phase} phase [m/s]")
    axes[1].set(xlabel="number of control actuations")
    for name, one in zip("ab", axes, strict=True):
        one.set_title(f"({name})", loc="left")
    figure.legend(
        handles=handles,
        loc="outside upper center",
        ncols=min(len(handles), 6 if len(max(label for label, _ in entries)) < 12 else 3),
        title=f"sample time, horizon {horizon}",
        columnspacing=1.2,
        handletextpad=0.3,
    )
    return figure, data.drop(columns="shade").reset_index(drop=True)


def summary(sweeps: dict[str, tuple[pd.DataFrame, Sequence[int], Sequence[float]]]) -> Drawing:
    """One page: median, quartiles and 5 and 95 % quantiles of every case of every sweep.

    ``sweeps`` maps each phase to its table, its horizons and its sample times.
    """
    quantities = {
        "delta_v_m_s": (r"$\Delta v$ [m/s]", 1.0),
        "time_s": ("time [min]", MINUTE),
        "steps": ("actuations", 1.0),
    }
    figure, axes = subplots(len(PHASES), len(quantities), figsize=(WIDTH, 4.45))
    colours = (ORANGE, BLUE, BLACK)
    rows = []
    for line, phase in zip(axes, PHASES, strict=True):
        table, horizons, sample_times = sweeps[phase]
        done = table[table["completed"]]
        positions_ = np.arange(len(sample_times), dtype=float)
        for panel, (quantity, (label, unit)) in zip(line, quantities.items(), strict=True):
            low, high = np.inf, 0.0
            for i, n in enumerate(horizons):
                found = np.full((len(sample_times), len(QUANTILES)), np.nan)
                for j, t in enumerate(sample_times):
                    values = done.loc[done["case"] == sweep_case(n, t), column(phase, quantity)]
                    if len(values):
                        found[j] = np.quantile(values / unit, QUANTILES)
                        low, high = min(low, found[j].min()), max(high, found[j].max())
                    rows.append(
                        {"phase": phase, "horizon": n, "sample_time_s": t, "quantity": label,
                         "count": len(values)}
                        | {f"quantile_{q:g}": v for q, v in zip(QUANTILES, found[j], strict=True)}
                    )  # fmt: skip
                x = positions_ + 0.24 * (i - 0.5 * (len(horizons) - 1))
                colour = colours[i % len(colours)]
                panel.vlines(x, found[:, 0], found[:, 4], color=colour, lw=0.8)
                panel.vlines(x, found[:, 1], found[:, 3], color=colour, lw=2.8, alpha=0.45)
                panel.plot(x, found[:, 2], "o", ms=2.6, color=colour, label=f"N {n}")
            panel.set_xticks(positions_, [f"{t:g}" for t in sample_times])
            log_axis(panel, low, high)
            panel.tick_params(labelsize=7)
            panel.grid(axis="x", visible=False)
        line[0].set_title(f"{phase} phase", loc="left", fontweight="bold")
        line[-1].legend(
            loc="lower right", bbox_to_anchor=(1.02, 0.97), ncols=len(horizons), fontsize=7,
            handletextpad=0.0, columnspacing=0.8, borderpad=0.0,
        )  # fmt: skip
    for panel, (label, _) in zip(axes[1], quantities.values(), strict=True):
        panel.set_ylabel(label)
    for panel in axes[-1]:
        panel.set_xlabel("sample time [s]")
    return figure, pd.DataFrame(rows)


def log_axis(axes: Axes, low: float, high: float) -> None:
    """A logarithmic axis over the data, with ticks that are read as numbers."""
    if not low < high:
        return
    subdivisions = (1, 2, 3, 5) if high > 2.0 * low else tuple(np.arange(1.0, 10.0, 0.5))
    axes.set_yscale("log")
    axes.set_ylim(low / 1.08, high * 1.08)
    axes.yaxis.set_major_locator(LogLocator(subs=subdivisions))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(NullLocator())


def shades(count: int) -> list:
    """Colours of an ordered quantity, from dark blue to light orange."""
    return list(mpl.colormaps["plasma"](np.linspace(0.03, 0.85, count)))


def _costs(states: pd.DataFrame, rows: pd.DataFrame) -> pd.DataFrame:
    done = rows[rows["completed"]].set_index("sample")
    there = states.set_index("sample").loc[done.index]
    return pd.DataFrame(
        {
            "sample": done.index,
            "x_m": there["x_m"],
            "y_m": there["y_m"],
            "distance_m": there["distance_m"],
            "quadrant": there["quadrant"],
            "delta_v_m_s": totals(done, "delta_v_m_s"),
            "time_min": totals(done, "time_s") / MINUTE,
        }
    ).reset_index(drop=True)


def _pair(data: pd.DataFrame, colours: Iterable) -> Figure:
    colours = list(colours)
    figure, axes = subplots(1, 2, figsize=(WIDTH, 3.2), width_ratios=(1.0, 1.15))
    axes[0].scatter(data["y_m"] / KM, data["x_m"] / KM, color=colours, **DOT)
    _orbit_axes(axes[0])
    axes[1].scatter(data["time_min"], data["delta_v_m_s"], color=colours, **DOT)
    _cost_axes(axes[1])
    for name, panel in zip("ab", axes, strict=True):
        panel.set_title(f"({name})", loc="left")
    return figure


def _cost_axes(axes: Axes) -> None:
    axes.set(
        xlabel="manoeuvre time [min]", ylabel=r"$\Delta v$ [m/s]", xlim=(0, None), ylim=(0, None)
    )


def _orbit_axes(axes: Axes) -> None:
    axes.plot(0.0, 0.0, "+", color=BLACK, ms=8)
    axes.set(xlabel="$y$, along the velocity [km]", ylabel="$x$, away from the Earth [km]")
    axes.set_aspect("equal", adjustable="datalim")
    # As in the document: the Earth lies above.
    axes.invert_yaxis()


def _legend(figure: Figure, entries: Sequence[tuple]) -> None:
    """Above the panels, where no dot lies under it."""
    handles = [_handle(colour, label) for label, colour in entries]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(handles), handletextpad=0.1,
        columnspacing=1.2,
    )  # fmt: skip


def _handle(colour, label: str) -> Line2D:
    return Line2D([], [], marker="o", ls="", ms=4.5, color=colour, label=label)


def _end(values: pd.Series) -> float:
    """Where an axis ends: at the data, or before the few that would squeeze all others."""
    if values.empty:
        return 1.0
    most, usual = float(values.max()), 1.6 * float(values.quantile(0.98))
    return 1.04 * min(most, usual)


def _begin(values: pd.Series) -> float:
    """Where an axis begins: at zero, or where data far from it would be squeezed into one end."""
    if values.empty or values.min() < 0.5 * values.max():
        return 0.0
    return 0.96 * float(values.min())
