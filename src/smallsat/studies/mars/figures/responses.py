"""The document's nine-panel figure of a run: attitude, body rate and torque by component."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.pyplot import subplots

from smallsat.studies.mars.figures.colours import MODE_COLOURS, MODE_LABELS
from smallsat.studies.mars.model.modes import timeline

# The vector of MRPs jumps by about 2 where it goes over to its shadow set.
JUMP = 1.0
BAND = 0.14  # opacity of a mode's band
AXES = "123"


def response_data(trajectories: pd.DataFrame, run: str) -> pd.DataFrame:
    """What the figure of a run draws.

    The reference attitude is given by whichever of its two sets is nearer to the body's: the same
    attitude, comparable by eye. Its rate is in body components, like the body's rate.

    Parameters
    ----------
    trajectories
        ``trajectories.parquet``.
    run
        Its name in the column ``run``.
    """
    data = trajectories[trajectories["run"] == run].drop(columns=["run"])
    data = data.reset_index(drop=True)
    sigma = data[[f"sigma_{axis}" for axis in AXES]].to_numpy()
    names = [f"sigma_ref_{axis}" for axis in AXES]
    short = data[names].to_numpy()
    other = -short / np.sum(short**2, axis=1, keepdims=True)
    nearer = np.linalg.norm(sigma - other, axis=1) < np.linalg.norm(sigma - short, axis=1)
    data[names] = np.where(nearer[:, None], other, short)
    return data


def response_figure(data: pd.DataFrame) -> Figure:
    """Nine panels from `response_data`: columns sigma, omega and u, rows the components 1 to 3.

    Curves of MRPs break where these go over to the shadow set, and bands tell the modes of a run
    that has several. A run that overflowed is empty and says so.
    """
    figure, panels = subplots(3, 3, sharex=True, figsize=(6.3, 5.0))
    columns = (
        ("sigma", "sigma_ref", r"\sigma", ""),
        ("omega", "omega_ref", r"\omega", " [rad/s]"),
        ("u", None, "u", " [N m]"),
    )
    for column, (name, reference, symbol, unit) in enumerate(columns):
        for row, axis in enumerate(AXES):
            panel = panels[row, column]
            panel.plot(*_curve(data, name, axis), color="C0", lw=1.0)
            if reference and data[f"{reference}_{axis}"].notna().any():
                panel.plot(*_curve(data, reference, axis), "--", color="C1", lw=1.0)
            panel.set_ylabel(f"${symbol}_{axis}${unit}")
            panel.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3), useMathText=True)
            if name == "sigma":
                panel.set_ylim(-1.05, 1.05)
            elif name == "u":
                # One scale for all: a constant torque is seen for what it is.
                panel.sharey(panels[0, column])
    for panel in panels[-1]:
        panel.set_xlabel("time [s]")
    if data["sigma_1"].isna().all():
        figure.text(0.5, 0.5, "not converged", ha="center", color="C3", fontsize=12)
    keys = dict(zip(("body", "reference frame"), panels[0, 0].get_lines(), strict=False))
    if data["mode"].nunique() > 1:
        keys |= mode_bands(data, panels.flat)
    if len(keys) > 1:
        figure.legend(keys.values(), keys, loc="outside upper center", ncols=len(keys))
    figure.align_ylabels(panels)
    # Laid out once, not again for each file format.
    layout = figure.get_layout_engine()
    assert layout is not None
    layout.execute(figure)
    figure.set_layout_engine("none")
    return figure


def mode_bands(data: pd.DataFrame, panels: Iterable[Axes]) -> dict[str, Artist]:
    """Colour the time of each mode in every panel; what the legend has to say of them."""
    intervals = timeline(data["time_s"].to_numpy(), data["mode"].to_numpy())
    spans = (intervals["mode"], intervals["start_s"], intervals["end_s"])
    for panel in panels:
        for mode, start, end in zip(*spans, strict=True):
            panel.axvspan(start, end, color=MODE_COLOURS[mode], alpha=BAND, lw=0)
    return {
        f"{MODE_LABELS[mode]} pointing": Patch(color=MODE_COLOURS[mode], alpha=BAND, lw=0)
        for mode in intervals["mode"].unique()
    }


def _curve(data: pd.DataFrame, name: str, axis: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and one component of a quantity, with gaps where MRPs jump."""
    values = data[f"{name}_{axis}"].to_numpy(copy=True)
    if name.startswith("sigma"):
        sigma = data[[f"{name}_{component}" for component in AXES]].to_numpy()
        values[1:][np.linalg.norm(np.diff(sigma, axis=0), axis=1) > JUMP] = np.nan
    return data["time_s"].to_numpy(), values
