"""Figures of weights of a miss, of drifting rings and of open-loop flights."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from smallsat.drawing.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, WIDTH
from smallsat.studies.racing.figures.drawing import COLOURS, say_missing
from smallsat.studies.racing.methods.dispersions import EACH_RING, OPEN_LOOP, SOURCES, TOGETHER
from smallsat.studies.racing.methods.drifting_rings import READINGS

SCENARIO_COLOURS = {"scenario-1": BLUE, "scenario-2": ORANGE}
READING_COLOURS = dict(zip(READINGS, (VERMILION, BLUE), strict=True))
SOURCE_COLOURS = dict(zip((*SOURCES, TOGETHER), (GREEN, SKY, BLUE, PURPLE, BLACK), strict=True))


def weights_figure(multipliers: pd.DataFrame, weights: pd.DataFrame) -> Figure:
    """The rings' multipliers, and the best penalised flight's largest miss and time by weight."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(WIDTH, 2.9))
    for scenario, rows in multipliers.groupby("scenario"):
        for _, own in rows.groupby("cubesat"):
            ordered = np.sort(own["multiplier_s_m"].to_numpy())[::-1]
            left.plot(
                np.arange(1, len(ordered) + 1), ordered, color=SCENARIO_COLOURS[str(scenario)],
                lw=1.0,
            )  # fmt: skip
    left.axhline(1.0, color=VERMILION, ls="--", lw=1.0)
    left.text(1.0, 1.1, "the document's weight", color=VERMILION, fontsize=7, va="bottom")
    left.set_yscale("log")
    left.set_ylim(top=2.5)
    left.set_xlabel("rings, by what they save")
    left.set_ylabel("a first metre of miss saves (s)")
    for scenario, own in weights.dropna().groupby("scenario"):
        style = {"color": SCENARIO_COLOURS[str(scenario)], "ms": 3}
        middle.semilogx(own["weight_s_m"], own["largest_miss_m"], "o-", **style)
        right.semilogx(own["weight_s_m"], own["time_s"] - own["centred_s"], "o-", **style)
    for axes in (middle, right):
        if weights.dropna().empty:
            say_missing(axes)
            continue
        for scenario, own in weights.groupby("scenario"):
            threshold = (own["weight_s_m"] / own["threshold_share"]).iloc[0]
            axes.axvline(threshold, color=SCENARIO_COLOURS[str(scenario)], ls=":", lw=1.0)
        axes.set_xticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
        axes.minorticks_off()
        axes.set_xlabel("weight of a miss (s/m)")
    middle.set_ylabel("largest miss (m)")
    right.set_ylabel("time against that\nthrough the centres (s)")
    handles = [
        Line2D([], [], color=colour, label=f"Scenario {scenario[-1]}")
        for scenario, colour in SCENARIO_COLOURS.items()
    ]
    handles.append(Line2D([], [], color=BLACK, ls=":", label="largest multiplier"))
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def drift_figure(races: pd.DataFrame) -> Figure:
    """How much longer races through drifting rings take, and how far the rings have gone."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.9), sharey=True)
    moving = races[races["rings"].isin(READINGS)]
    racers = moving[["scenario", "cubesat"]].drop_duplicates().to_numpy().tolist()
    names = [f"{cubesat}, Scenario {scenario[-1]}" for scenario, cubesat in racers]
    for step, (rings, colour) in enumerate(READING_COLOURS.items()):
        own = moving[moving["rings"] == rings]
        rows = np.arange(len(own)) + 0.36 * (step - 0.5)
        left.barh(rows, own["longer_pct"], 0.34, color=colour, label=rings)
        right.barh(rows, own["mean_drift_m"], 0.34, color=colour)
        right.plot(own["largest_drift_m"], rows, "|", color=BLACK, ms=6)
    left.set_yticks(range(len(names)), names)
    left.invert_yaxis()
    left.set_xlabel("longer than with fixed rings (%)")
    right.set_xlabel("drift, mean and largest (m)")
    figure.legend(loc="outside upper center", ncols=2, title="rings", title_fontsize=8)
    return figure


def dispersion_figure(rings: pd.DataFrame) -> Figure:
    """What open-loop flights of one CubeSat miss, by source, and how many pass, of each CubeSat."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.6))
    own = rings[rings["scenario"] == "scenario-1"]
    one = own[(own["cubesat"] == "Meeny") & (own["flown"] == OPEN_LOOP)]
    for source, colour in SOURCE_COLOURS.items():
        rows = one[one["source"] == source]
        left.semilogy(rows["arrival_s"], rows["most_m"], color=colour, label=source)
    sizes = one[one["source"] == TOGETHER]
    left.plot(sizes["arrival_s"], sizes["size_m"], "o", mfc="white", mec=BLACK, ms=3, label="ring")
    left.set_xlabel("time (s)")
    left.set_ylabel("miss that 95 % stay below (m)")
    left.set_title("Meeny, open loop")
    left.legend(loc="upper center", bbox_to_anchor=(0.5, -0.19), fontsize=7, ncols=3)
    every = own[own["source"] == TOGETHER]
    for name, colour in COLOURS.items():
        for flown, style in ((OPEN_LOOP, ":"), (EACH_RING, "-")):
            rows = every[(every["cubesat"] == name) & (every["flown"] == flown)]
            right.plot(
                rows["ring"], 100.0 * rows["passed_share"], color=colour, ls=style,
                label=name if flown == EACH_RING else "_",
            )  # fmt: skip
    right.plot([], [], color=BLACK, ls=":", label=OPEN_LOOP)
    right.plot([], [], color=BLACK, ls="-", label=EACH_RING)
    right.set_xlabel("ring")
    right.set_ylabel("flights through all rings so far (%)")
    right.set_ylim(0.0, 100.0)
    right.set_title("all errors together")
    right.legend(loc="upper center", bbox_to_anchor=(0.5, -0.19), fontsize=7, ncols=3)
    return figure
