"""Figures of the inference. Each function returns the figure and the table of what it draws."""

import numpy as np
import pandas as pd
from matplotlib.patches import Patch
from matplotlib.pyplot import subplots

from smallsat.drawing.figure import Drawing
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.parameter_set import FITTED, KINDS

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


def residuals(table: pd.DataFrame) -> Drawing:
    """What the configured set misses of everything that the document prints, in assumed errors."""
    figure, axes = subplots(figsize=(6.3, 7.2))
    lines = np.arange(len(table))[::-1]
    colours = [f"C{KINDS.index(kind)}" for kind in table["kind"]]
    axes.barh(lines, table["residual"], color=colours, height=0.65)
    axes.set_yticks(lines, table["cell"], fontsize=6)
    for at, row in zip(lines, table.to_dict("records"), strict=True):
        text = f"{row['printed']:g} / {row['computed']:.4g}"
        axes.text(1.01, at, text, transform=axes.get_yaxis_transform(), fontsize=6, va="center")
    axes.axvline(0.0, color="black", lw=0.8)
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color="0.5", lw=0.7, ls=":")
    handles = [Patch(color=f"C{place}", label=kind) for place, kind in enumerate(KINDS)]
    axes.legend(handles=handles, fontsize=6)
    axes.set_ylim(-1, len(table))
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
    """Least misfit that each option of each reading allows, and what is missed in it."""
    figure, axes = subplots(figsize=(6.0, 4.4))
    lines = np.arange(len(table))[::-1]
    questions = list(dict.fromkeys(table["question"]))
    for at, row in zip(lines, table.to_dict("records"), strict=True):
        axes.plot(row["misfit"], at, "o", color=f"C{questions.index(row['question']) % 2}", ms=4)
        parts = ", ".join(f"{kind} {row[kind]:.0f}" for kind in KINDS)
        axes.text(1.01, at, parts, transform=axes.get_yaxis_transform(), fontsize=6, va="center")
    labels = [
        f"{row['question'].replace('_', ' ')}: {row['reading']}" for row in table.to_dict("records")
    ]
    axes.set_yticks(lines, labels, fontsize=7)
    axes.set_xlim(0.0, None)
    axes.set_xlabel("least misfit found, whatever the other readings are; to the right: its parts")
    return figure, table
