"""Figures of the inference. Each function returns the figure and the table of what it draws."""

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.drawing.style import BLUE, CYCLE, VERMILION, WIDTH
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.misfit import KINDS
from smallsat.studies.rendezvous.inference.parameter_set import FITTED

TITLES = {
    "keep_out_m": "$r_1$ [m]",
    "set_point_1": "set point 1 / $r_1$",
    "switch_1": "switch 1 / $r_1$",
    "overshoot_m": "$r_2$ [m]",
    "set_point_2": "set point 2 / $r_2$",
    "switch_2": "switch 2 / $r_2$",
    "end_distance_m": "$r_3$ [m]",
    "speed_bound_m_s": "$v_{max}$ [m/s]",
    "mean_motion_rad_s": "$n$ [rad/s]",
    "rotation_rate_rad_s": r"$\omega_z$ [rad/s]",
}

# Readings whose names are no words.
QUESTIONS = {
    "delta_v": "sum of delta-v",
    "r_bar": "R-bar",
    "reference_moves": "reference has a speed",
}
KIND_COLOURS = dict(zip(KINDS, CYCLE, strict=False))
# Columns of results in words.
WORDS = {"_m_s": "", "_min": "", "delta_v": "delta-v"}


def residuals(table: pd.DataFrame) -> Drawing:
    """What the configured set misses of everything that the document prints, in assumed errors."""
    columns = table[table["kind"] == "cell"], table[table["kind"] != "cell"]
    figure, panels = subplots(1, 2, figsize=(WIDTH, 4.45), sharex=True)
    top = max(map(len, columns)) - 1
    for axes, part in zip(panels, columns, strict=True):
        lines = top - np.arange(len(part))
        axes.barh(lines, part["residual"], color=part["kind"].map(KIND_COLOURS), height=0.65)
        axes.set_yticks(lines, part["cell"].replace(WORDS, regex=True), fontsize=6.5)
        for at, row in zip(lines, part.to_dict("records"), strict=True):
            text = f"{row['printed']:g} / {row['computed']:.4g}"
            axes.text(
                1.02, at, text, transform=axes.get_yaxis_transform(), fontsize=6.5, va="center"
            )
        axes.axvline(0.0, color="black", lw=0.8)
        for edge in (-1.0, 1.0):
            axes.axvline(edge, color="0.5", lw=0.7, ls=":")
        axes.set_ylim(-0.7, top + 0.7)
        axes.tick_params(axis="x", labelsize=7)
        axes.grid(visible=False, axis="y")
    handles = [Patch(color=colour, label=kind) for kind, colour in KIND_COLOURS.items()]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), fontsize=7)
    figure.supxlabel(
        "(computed - printed) / assumed error; to the right: printed / computed", fontsize=8
    )
    return figure, table


def profiles(section: Cases, evaluated: pd.DataFrame, table: pd.DataFrame) -> Drawing:
    """Misfit of all evaluated sets over each parameter, and its lower envelope."""
    figure, panels = subplots(3, 4, figsize=(WIDTH, 4.45), sharey=True)
    limit = section.inference.acceptable * evaluated["misfit"].min()
    rest = panels.flat[len(FITTED) :]
    for name, axes in zip(FITTED, panels.flat, strict=False):
        axes.plot(evaluated[name], evaluated["misfit"], ".", color="0.75", ms=1.5, rasterized=True)
        own = table[table["parameter"] == name]
        axes.plot(own["value"], own["misfit"], "o-", color="C0", ms=2.5, lw=0.9)
        axes.axhline(limit, color="C1", lw=0.8, ls="--")
        axes.axvline(section.inferred[name], color="C2", lw=0.9)
        axes.set_yscale("log")
        axes.set_xlabel(TITLES[name], fontsize=7, labelpad=1)
        axes.tick_params(labelsize=6)
        axes.locator_params(axis="x", nbins=2 if name == "mean_motion_rad_s" else 3)
    for axes in panels[:, 0]:
        axes.set_ylabel("misfit", fontsize=7)
    for axes in rest:
        axes.set_axis_off()
    handles = [
        Line2D([], [], marker=".", ls="", color="0.75", label="evaluated set"),
        Line2D([], [], marker="o", color="C0", ms=2.5, label="least in a bin"),
        Line2D([], [], color="C1", ls="--", label="acceptable below"),
        Line2D([], [], color="C2", label="configured"),
    ]
    rest[0].legend(handles=handles, loc="center", fontsize=8)
    return figure, evaluated[[*FITTED, "misfit"]]


def readings(section: Cases, table: pd.DataFrame) -> Drawing:
    """Least misfit that each option of each reading allows, and what is missed in it."""
    figure, axes = subplots(figsize=(WIDTH, 4.0))
    lines = np.arange(len(table))[::-1]
    questions = list(dict.fromkeys(table["question"]))
    for at, row in zip(lines, table.to_dict("records"), strict=True):
        if questions.index(row["question"]) % 2:
            axes.axhspan(at - 0.5, at + 0.5, color="0.94", lw=0, zorder=0)
        parts = ", ".join(f"{kind} {row[kind]:.0f}" for kind in KINDS)
        axes.text(1.01, at, parts, transform=axes.get_yaxis_transform(), fontsize=6.5, va="center")
    axes.plot(table["misfit"], lines, "o", color=BLUE, ms=4)
    limit = section.inference.acceptable * table["misfit"].min()
    axes.axvline(limit, color=VERMILION, lw=0.9, ls="--")
    axes.text(
        limit, len(table) - 0.4, " acceptable below", color=VERMILION, fontsize=7, va="bottom"
    )
    labels = [
        f"{QUESTIONS.get(row['question'], row['question'].replace('_', ' '))}: {row['reading']}"
        for row in table.to_dict("records")
    ]
    axes.set_yticks(lines, labels, fontsize=7)
    axes.set_xlim(0.0, None)
    axes.set_ylim(-0.6, len(table) - 0.4)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("least misfit found, whatever the other readings are; to the right: its parts")
    return figure, table
