"""Figures of the inference. Each function returns the figure and the table of what it draws."""

import numpy as np
import pandas as pd
from matplotlib.pyplot import subplots
from matplotlib.ticker import NullFormatter

from smallsat.drawing.figure import Drawing
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.search import FITTED

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
    "plane_rate": "plane rate / $n$",
    "rotation_rate_rad_s": r"$\omega_z$ [rad/s]",
}


def residuals(table: pd.DataFrame) -> Drawing:
    """Every cell's residual with the configured set, in assumed errors."""
    figure, axes = subplots(figsize=(6.3, 4.4))
    lines = np.arange(len(table))[::-1]
    colours = [
        "C0" if cell.endswith("steps") or cell.endswith("time") else "C1" for cell in table["cell"]
    ]
    axes.barh(lines, table["residual"], color=colours, height=0.65)
    axes.set_yticks(lines, table["cell"], fontsize=7)
    for at, row in zip(lines, table.to_dict("records"), strict=True):
        text = f"{row['printed']:g} / {row['computed']:.4g}"
        axes.text(1.01, at, text, transform=axes.get_yaxis_transform(), fontsize=7, va="center")
    axes.axvline(0.0, color="black", lw=0.8)
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color="0.5", lw=0.7, ls=":")
    axes.set_xlabel("(computed - printed) / assumed error; to the right: printed / computed")
    axes.grid(visible=False, axis="y")
    return figure, table


def profiles(section: Cases, evaluated: pd.DataFrame, table: pd.DataFrame) -> Drawing:
    """Misfit of all evaluated sets over each parameter, and its lower envelope."""
    figure, panels = subplots(3, 4, figsize=(6.3, 4.8), sharey=True)
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
        axes.plot([], [], ".", color="0.75", label="evaluated set")
        axes.plot([], [], "o-", color="C0", ms=2.5, label="least in a bin")
        axes.plot([], [], color="C1", ls="--", label="acceptable below")
        axes.plot([], [], color="C2", label="configured")
        axes.legend(loc="center", fontsize=7)
    return figure, evaluated[[*FITTED, "misfit"]]


def readings(table: pd.DataFrame) -> Drawing:
    """Least misfit that each structural reading allows."""
    figure, axes = subplots(figsize=(5.6, 3.6))
    lines = np.arange(len(table))[::-1]
    questions = list(dict.fromkeys(table["question"]))
    colours = [f"C{questions.index(question) % 2}" for question in table["question"]]
    axes.barh(lines, table["misfit"], color=colours, height=0.65)
    labels = [
        f"{row['question'].replace('_', ' ')}: {row['reading']}" for row in table.to_dict("records")
    ]
    axes.set_yticks(lines, labels, fontsize=7)
    axes.set_xscale("log")
    axes.set_xticks([30, 100, 300, 1000], ["30", "100", "300", "1000"])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("least misfit found, whatever the other readings are")
    axes.grid(visible=False, axis="y")
    return figure, table
