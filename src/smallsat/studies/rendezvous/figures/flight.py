"""Figures of chapter 6: how the flight program is tested, and what its solves take.

Each function returns the figure and the table of exactly what it draws.
"""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLUE, GREEN, GREY, ORANGE, VERMILION, WIDTH
from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import FlightComputer
from smallsat.studies.rendezvous.flight_computer.printed_times import printed_averages
from smallsat.studies.rendezvous.flight_computer.sweeps import swept
from smallsat.studies.rendezvous.guidance.law import PHASES

COLOURS = (BLUE, VERMILION, GREEN, ORANGE)
TITLES = {"stage-wise": "stage-wise solver", "generated": "generated solver"}
# Bins over the range of a histogram whose bin width is not printed.
BINS = 40
MILLION = 1e6
# Inches: the record prints figures of this width in pairs, at four fifths of their size.
PAIR_WIDTH = 4.6


def _box(axes: Axes, x: float, y: float, text: str, colour: str) -> None:
    axes.text(
        x, y, text, ha="center", va="center", fontsize=8, linespacing=1.4,
        bbox={"boxstyle": "round,pad=0.5", "fc": colour, "alpha": 0.18, "ec": colour},
    )  # fmt: skip


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=11, color=GREY))


def _canvas(height: float, size: tuple[float, float]) -> tuple[Figure, Axes]:
    figure, axes = subplots(figsize=(PAIR_WIDTH, height))
    axes.set(xlim=(0, size[0]), ylim=(0, size[1]))
    axes.axis("off")
    axes.grid(visible=False)
    return figure, axes


def communication(link: pd.DataFrame) -> Drawing:
    """Figure 6.1: what goes over the socket. ``link`` is ``flight/link.csv``."""
    row = link.iloc[0]
    figure, axes = _canvas(1.7, (10.0, 3.0))
    words: dict[str, Any] = {"ha": "center", "fontsize": 8}
    simulation = "simulation, the server:\nmoves both bodies in the\nEarth's field and air"
    program = (
        f"flight program, the client:\nguidance law and solver on\nan emulated {row['processor']}"
    )
    _box(axes, 1.75, 1.7, simulation, BLUE)
    _box(axes, 8.2, 1.7, program, VERMILION)
    _arrow(axes, (3.6, 1.9), (6.3, 1.9))
    axes.text(4.95, 2.0, "time,\nrelative state", va="bottom", **words)
    _arrow(axes, (6.3, 1.5), (3.6, 1.5))
    axes.text(4.95, 1.4, "phase, change\nof velocity", va="top", **words)
    axes.text(4.95, 0.1, f"once a sample: {row['steps']} times", **words)
    return figure, link


def plan(settings: FlightComputer) -> Drawing:
    """Figure 6.2: what is varied in each phase, and how many runs of each."""
    rows = []
    for name in PHASES:
        varied = settings[name]
        rows += [(name, "prediction horizon", n) for n in varied.horizons]
        rows += [(name, "sample time [s]", t) for t in varied.sample_times_s]
    table = pd.DataFrame(rows, columns=["phase", "varied", "value"])
    figure, axes = _canvas(2.6, (10.0, 6.0))
    _box(axes, 1.2, 3.0, f"{settings.runs} initial states", GREY)
    titles = ("rendezvous", "approach", "docking")
    for place, (phase, title) in enumerate(zip(PHASES, titles, strict=True)):
        y = 5.0 - 2.0 * place
        own = table[table["phase"] == phase].groupby("varied")["value"]
        lines = [
            f"{varied}: {', '.join(f'{value:g}' for value in values)}"
            for varied, values in own
            if len(values) > 1
        ]
        _box(axes, 4.4, y, title, COLOURS[place])
        _box(axes, 8.05, y, "\n".join(lines), COLOURS[place])
        _arrow(axes, (2.5, 3.0 + 0.4 * (1 - place)), (3.4, y))
        _arrow(axes, (5.25, y), (5.65, y))
    return figure, table


def _printed_width(runs: pd.DataFrame, bin_ms: float, ledger: Ledger) -> float:
    """Figure 6.3's bin in instructions: the share that it is of the printed average for N1 = 30."""
    horizon = swept(runs, PHASES[0], "sample_time_s")["horizon"].iloc[0]
    own = swept(runs, PHASES[0], "horizon")
    mean = own.loc[own["horizon"] == horizon, "instructions"].mean()
    return float(mean) * bin_ms / printed_averages(ledger, PHASES[0])[horizon].value


def counts(runs: pd.DataFrame, phase: str, varied: str, bin_ms: float, ledger: Ledger) -> Drawing:
    """Figures 6.3 to 6.7: average instructions of a solve, of each run, as histograms by solver.

    Parameters
    ----------
    runs
        ``flight/runs.csv`` of one processor.
    phase, varied
        The phase, and what is varied in it: ``horizon`` or ``sample_time_s``.
    bin_ms, ledger
        The document's bin width and its averages. The far range is drawn in this width, in
        proportion to its average; the others have none printed, and `BINS` each.
    """
    label, unit = ("N", "") if varied == "horizon" else ("Ts", " s")
    own = swept(runs, phase, varied)
    values = sorted(own[varied].unique())
    figure, panels = subplots(1, 2, figsize=(PAIR_WIDTH, 2.6), sharey=True)
    drawn = []
    for panel, (solver, title) in zip(panels, TITLES.items(), strict=True):
        rows = own[own["solver"] == solver]
        low, high = rows["instructions"].min(), rows["instructions"].max()
        width = (high - low) / BINS
        if phase == PHASES[0]:
            width = _printed_width(runs[runs["solver"] == solver], bin_ms, ledger)
        first = np.floor(low / width) * width
        edges = first + width * np.arange(np.ceil((high - first) / width) + 1.5)
        for colour, value in zip(COLOURS, values, strict=False):
            number, _ = np.histogram(rows.loc[rows[varied] == value, "instructions"], edges)
            filled = {"fill": True, "alpha": 0.3, "lw": 0}
            for style in (filled, {"label": f"{label} {value:g}{unit}"}):
                panel.stairs(number, edges / MILLION, color=colour, **style)
            drawn += [
                {"solver": solver, varied: value, "from": a, "to": b, "runs": n}
                for a, b, n in zip(edges[:-1], edges[1:], number, strict=True)
                if n
            ]
        panel.set_title(title, loc="left")
        panel.set_xlim(0, None)
    figure.supxlabel("average of a run [million instructions]", fontsize=9)
    panels[0].set_ylabel("runs")
    handles = panels[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper right", ncols=len(values))
    return figure, pd.DataFrame(drawn)


def bounds(cycles: pd.DataFrame) -> Drawing:
    """Beyond the document: bounds of each case's worst solve, ms, and its sample time.

    ``cycles`` is ``flight/cycles.csv``.
    """
    table = cycles[cycles["solve"] == "most"].reset_index(drop=True)
    cases = table[["phase", "horizon", "sample_time_s"]].drop_duplicates().reset_index(drop=True)
    figure, panels = subplots(1, 2, figsize=(WIDTH, 3.6), sharey=True)
    for panel, (processor, group) in zip(panels, table.groupby("processor"), strict=True):
        for shift, colour, (solver, title) in zip(
            (0.15, -0.15), (BLUE, VERMILION), TITLES.items(), strict=True
        ):
            own = cases.merge(group[group["solver"] == solver])
            lines = np.arange(len(own))[::-1] + shift
            panel.hlines(lines, own["ms_low"], own["ms_high"], color=colour, lw=3, label=title)
        panel.plot(1e3 * cases["sample_time_s"], np.arange(len(cases))[::-1], "|", ms=9,
                   color=GREY, label="sample time")  # fmt: skip
        panel.axvline(1e3, color=GREY, lw=0.8, ls=":", label="a second")
        panel.set_xscale("log")
        panel.set_title(processor, loc="left")
        panel.set_xlabel("worst solve, least and most [ms]")
        panel.grid(axis="y", visible=False)
    panels[0].set_yticks(
        np.arange(len(cases))[::-1],
        [f"{row.phase}, N {row.horizon}, {row.sample_time_s:g} s" for row in cases.itertuples()],
        fontsize=7,
    )
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure, table
