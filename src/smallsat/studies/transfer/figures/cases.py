"""Figures 5 to 64: states and control of one case."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from smallsat.drawing.style import BLACK, CYCLE
from smallsat.studies.transfer.figures.missing import NOT_CONVERGED, mark_missing
from smallsat.studies.transfer.model.problem import STATES

# Half of the report's text width: states and control stand side by side.
SIZE = (3.3, 2.7)
SYMBOLS = {
    "r": "$r$",
    "theta": r"$\theta$",
    "v_r": "$v_r$",
    "v_theta": r"$v_\theta$",
    "m": "$m$",
}
_DASHED = ((0, (3, 1.5)), 0.9, 0.75)
# The best single polynomial of many starts is another minimum than the document's.
ANOTHER_MINIMUM = "another minimum, best of many starts"
STYLES = {"as published": ("-", 1.3, 1.0), "converged": _DASHED, ANOTHER_MINIMUM: _DASHED}
# The document's axis of the indirect figures says t where its listings integrate over tau.
AXIS = {"direct": r"$\tau$", "indirect": r"$\tau$ (labelled $t$ in the document)"}


def states_figure(
    flown: pd.DataFrame, missing: Sequence[str] = (), printed: str = "", method: str = "direct"
) -> Figure:
    """All five states against tau, interval ends as asterisks.

    Parameters
    ----------
    flown
        Trajectories of one case in one or two runs, columns run, segment, tau and the states.
    missing
        Runs that were not flown, which the figure names.
    printed
        Final time that the document prints of the case.
    method
        ``direct`` or ``indirect``, which labels the axis.
    """
    figure, axes = plt.subplots(figsize=SIZE)
    for run, path in flown.groupby("run", sort=False):
        style, width, alpha = STYLES[str(run)]
        for state, colour in zip(STATES, CYCLE, strict=False):
            axes.plot(path["tau"], path[state], ls=style, lw=width, alpha=alpha, color=colour)
        if run == "as published":
            ends = _interval_ends(path)
            for state in STATES:
                axes.plot(ends["tau"], ends[state], "*", color=BLACK, ms=3.5, lw=0)
    axes.set_xlabel(AXIS[method])
    axes.set_ylabel("state (canonical units)")
    handles = [
        Line2D([], [], color=colour, label=SYMBOLS[state])
        for state, colour in zip(STATES, CYCLE, strict=False)
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=5, handlelength=1.2, columnspacing=1
    )
    _run_legend(figure, flown, missing, printed)
    return figure


def control_figure(
    flown: pd.DataFrame, missing: Sequence[str] = (), printed: str = "", method: str = "direct"
) -> Figure:
    """Thrust angle in degrees, 0 to 360, against tau, interval ends as asterisks.

    Parameters as of `states_figure`.
    """
    figure, axes = plt.subplots(figsize=SIZE)
    colours = dict(zip(STYLES, (CYCLE[0], CYCLE[1], CYCLE[1]), strict=True))
    for run, path in flown.groupby("run", sort=False):
        style, width, _ = STYLES[str(run)]
        for _, segment in path.groupby("segment"):
            tau, angle = _unwrapped(segment)
            axes.plot(tau, angle, ls=style, lw=width, color=colours[str(run)])
        if run == "as published":
            ends = _interval_ends(path)
            axes.plot(ends["tau"], _degrees(ends["beta"]), "*", color=BLACK, ms=3.5, lw=0)
    axes.set_xlabel(AXIS[method])
    _angle_axis(axes)
    # The row of symbols in the figure beside it is empty here; this keeps the two axes level.
    figure.legend(
        handles=[Line2D([], [], lw=0, label=r"thrust angle above the local horizontal")],
        loc="outside upper center",
        handlelength=0,
    )
    _run_legend(figure, flown, missing, printed, colours)
    return figure


def drawn_data(flown: pd.DataFrame) -> pd.DataFrame:
    """The data of both figures: states and the control in degrees."""
    columns = ["run", "segment", "tau", "t", *STATES]
    return flown[columns].assign(beta_deg=_degrees(flown["beta"]))


def _degrees(angle: pd.Series) -> pd.Series:
    return pd.Series(np.degrees(np.mod(angle, 2 * np.pi)), index=angle.index)


def _unwrapped(segment: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    # A gap where the angle passes 360 degrees: a line across the figure would be no control.
    angle = _degrees(segment["beta"]).to_numpy()
    wraps = np.flatnonzero(np.abs(np.diff(angle)) > 180) + 1
    tau = np.insert(segment["tau"].to_numpy(), wraps, np.nan)
    return tau, np.insert(angle, wraps, np.nan)


def _interval_ends(path: pd.DataFrame) -> pd.DataFrame:
    groups = path.groupby("segment")
    return pd.concat([groups.head(1), groups.tail(1)])


def _angle_axis(axes: Axes) -> None:
    axes.set_ylabel(r"$\beta$ (deg)")
    axes.set_ylim(-10, 370)
    axes.set_yticks(range(0, 361, 90))


def _run_legend(
    figure: Figure,
    flown: pd.DataFrame,
    missing: Sequence[str],
    printed: str,
    colours: dict[str, str] | None = None,
) -> None:
    """Name the runs and their final times below the axes, with the printed one."""
    if flown.empty:
        mark_missing(figure.axes[0])
    handles = []
    for run, path in flown.groupby("run", sort=False):
        style, width, _ = STYLES[str(run)]
        colour = (colours or {}).get(str(run), BLACK)
        label = f"{run}, $t_f$ = {path['t'].iloc[-1]:.5f}"
        if run == "as published" and printed:
            label += f" (printed {printed})"
        handles.append(Line2D([], [], ls=style, lw=width, color=colour, label=label))
    handles += [Line2D([], [], lw=0, label=f"{run}: {NOT_CONVERGED}") for run in missing]
    figure.legend(handles=handles, loc="outside lower center", fontsize=7, handlelength=2.5)
