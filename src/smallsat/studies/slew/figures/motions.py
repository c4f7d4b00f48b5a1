"""The document's figures of a motion, and those of what goes beyond it.

Each function returns the figure and the table of exactly what it draws.
"""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.pyplot import figure as new_figure
from matplotlib.pyplot import subplots
from mpl_toolkits.mplot3d import Axes3D

from smallsat.drawing.figure import Drawing
from smallsat.dynamics.attitude.quaternions import quaternion_to_dcm
from smallsat.studies.slew.methods.environment_study import AIR
from smallsat.studies.slew.methods.models import PEAKS, PRINTED, READINGS, carried_pct
from smallsat.studies.slew.model.simulation import angles_deg, usage_pct
from smallsat.studies.slew.parameters import Parameters

AXES = "xyz"
QUATERNION = ["q_1", "q_2", "q_3", "q_4"]
CONTROL_STYLES = {"open loop": "C0--", "closed loop on the plan": "C1-", "eigenaxis law": "C2:"}
# Every so many rows of a flight at 10 Hz are drawn.
THINNED = 2
# Labels of the last axes stand a little above those of the first ones.
LIFT = np.array([0.0, 0.0, 0.14])


def missing(note: str) -> Drawing:
    """The place of a figure whose case did not converge."""
    figure, axes = subplots(figsize=(6.3, 2.7))
    axes.set_axis_off()
    axes.text(0.5, 0.5, note, ha="center", va="center", color="C3", transform=axes.transAxes)
    return _frozen(figure), pd.DataFrame({"note": [note]})


def attitude(motions: dict[str, pd.DataFrame]) -> Drawing:
    """Roll, pitch and yaw, and the body rates, over time: a row of panels a motion, by title."""
    figure, panels = _rows_of(motions, 2, 2.7)
    drawn = {}
    for (title, flown), (left, right) in zip(motions.items(), panels, strict=True):
        rows = flown.iloc[::THINNED]
        # Jumps by a full turn are none of the motion's.
        angles = np.degrees(np.unwrap(np.radians(angles_deg(rows)), axis=0))
        data = pd.DataFrame({"time_s": rows["time_s"].to_numpy()})
        for i, (name, style) in enumerate((("roll", "-"), ("pitch", "--"), ("yaw", "-"))):
            data[f"{name}_deg"] = angles[:, i]
            left.plot(data["time_s"], angles[:, i], style, label=name)
        for i, axis in enumerate(AXES):
            rate = np.degrees(rows[f"omega_{axis}"].to_numpy())
            data[f"omega_{axis}_deg_s"] = rate
            right.plot(data["time_s"], rate, ("-", "--", "-")[i], label=rf"$\omega_{axis}$")
        left.set_ylabel("angle [deg]")
        right.set_ylabel("rate [deg/s]")
        drawn[title] = data
    return _with_legends(figure, panels), _together(drawn)


def usage(motions: dict[str, pd.DataFrame], parameters: Parameters) -> Drawing:
    """Torque and momentum of each wheel in percent of its limit: a row a motion, by title."""
    figure, panels = _rows_of(motions, 2, 2.7)
    drawn = {}
    for (title, flown), (left, right) in zip(motions.items(), panels, strict=True):
        rows = flown.iloc[::THINNED]
        torque, momentum = usage_pct(rows, parameters)
        data = pd.DataFrame({"time_s": rows["time_s"].to_numpy()})
        for panel, values, name in ((left, torque, "torque"), (right, momentum, "momentum")):
            for i, axis in enumerate(AXES):
                data[f"{name}_{axis}_pct"] = values[:, i]
                style = ("-", "--", "-")[i]
                panel.plot(data["time_s"], values[:, i], style, lw=1.1, label=f"${axis}$")
            panel.set_ylabel(f"{name} used [%]")
        left.set_ylim(-108, 108)
        drawn[title] = data
    return _with_legends(figure, panels), _together(drawn)


def history(plans: dict[str, pd.DataFrame], parameters: Parameters) -> Drawing:
    """Quaternion, rate and torque of plans at their points: a row of panels a plan, by title."""
    figure, panels = _rows_of(plans, 3, 2.8)
    drawn = {}
    for (title, plan), row in zip(plans.items(), panels, strict=True):
        data = plan[["time_s", *QUATERNION]].reset_index(drop=True)
        inner = plan["node"].to_numpy() == 1
        for name in QUATERNION:
            row[0].plot(data["time_s"], data[name], ".-", ms=3, lw=0.8, label=f"${name}$")
        for axis in AXES:
            data[f"omega_{axis}_deg_s"] = np.degrees(plan[f"omega_{axis}"].to_numpy())
            row[1].plot(
                data["time_s"], data[f"omega_{axis}_deg_s"], ".-", ms=3, lw=0.8,
                label=rf"$\omega_{axis}$",
            )  # fmt: skip
            torque = np.where(inner, 1e3 * plan[f"u_{axis}"].to_numpy(), np.nan)
            data[f"u_{axis}_mN_m"] = torque
            row[2].plot(data["time_s"], torque, ".-", ms=3, lw=0.8, label=f"$u_{axis}$")
        row[2].set_ylim(-1.1e3 * parameters.torque, 1.1e3 * parameters.torque)
        labels = ("quaternion [-]", "rate [deg/s]", "torque [mN m]")
        for panel, label in zip(row, labels, strict=True):
            panel.set_title(label)
            # Below the panel: the curves leave no room in it.
            panel.legend(
                loc="upper center",
                bbox_to_anchor=(0.5, -0.2),
                ncols=2,
                fontsize=7,
                handlelength=1.3,
            )
        drawn[title] = data
    return _frozen(figure), _together(drawn)


def traces(flown: dict[str, pd.DataFrame], waypoints: dict[str, pd.DataFrame]) -> Drawing:
    """Paths of the tips of the body axes on the unit sphere, in the inertial frame, by title.

    ``waypoints`` are the points of the plans that are flown, where there are any, drawn as crosses.
    """
    wide = len(flown)
    figure = new_figure(figsize=(4.6, 4.2) if wide == 1 else (6.4, 3.7))
    figure.set_layout_engine("none")
    drawn = {}
    for k, (title, motion) in enumerate(flown.items()):
        place = (k / wide, 0.0, 1.0 / wide, 0.91)
        axes: Axes3D = figure.add_axes(place, projection="3d")
        drawn[title] = _axes_traced(axes, motion, waypoints.get(title))
        title = title or "paths of the body axes"
        figure.text(
            (k + 0.5) / wide, 0.995, title.replace("; ", ";\n"), ha="center", va="top", fontsize=7
        )
    if waypoints:
        note = "lines: flown; crosses: points of the plan"
        figure.text(0.5, 0.02, note, ha="center", fontsize=7.5)
    return figure, _together(drawn)


def _axes_traced(axes: Axes3D, flown: pd.DataFrame, waypoints: pd.DataFrame | None) -> pd.DataFrame:
    """Draw the paths of one motion on its sphere; what is drawn."""
    rows = flown.iloc[:: 5 * THINNED]
    if rows.index[-1] != flown.index[-1]:
        rows = pd.concat([rows, flown.tail(1)])
    tips = np.array([quaternion_to_dcm(tuple(q)) for q in rows[QUATERNION].to_numpy()])
    planned = None
    if waypoints is not None:
        planned = np.array([quaternion_to_dcm(tuple(q)) for q in waypoints[QUATERNION].to_numpy()])
    around, up = np.meshgrid(np.linspace(0, 2 * np.pi, 37), np.linspace(0, np.pi, 19))
    axes.plot_wireframe(
        np.cos(around) * np.sin(up), np.sin(around) * np.sin(up), np.cos(up),
        color="0.85", lw=0.3,
    )  # fmt: skip
    data = {"time_s": rows["time_s"].to_numpy()}
    for i, (axis, colour) in enumerate(zip(AXES, ("C0", "C1", "C2"), strict=True)):
        path = tips[:, i]
        axes.plot(*path.T, color=colour, lw=1.6)
        for k, style in ((0, ":"), (-1, "-")):
            axes.plot(*np.array([np.zeros(3), path[k]]).T, style, color=colour, lw=1.1)
        axes.plot(*path[-1], "o", color=colour, ms=4)
        axes.text(*(1.17 * path[0]), f"${axis}_0$", color=colour, ha="center")
        # Where an axis ends as it began, one label is enough.
        if np.linalg.norm(path[-1] - path[0]) > 0.3:
            axes.text(*(1.2 * path[-1] + LIFT), f"${axis}_f$", color=colour, ha="center")
        for j, name in enumerate(AXES):
            data[f"{axis}_axis_{name}"] = path[:, j]
        if planned is not None:
            axes.plot(*planned[:, i].T, "x", color=colour, ms=4, mew=0.9)
    limits = (-0.85, 0.85)
    axes.set(xlim=limits, ylim=limits, zlim=limits)
    axes.set_box_aspect((1, 1, 1), zoom=1.25)
    axes.view_init(elev=28, azim=38)
    axes.set_axis_off()
    drawn = pd.DataFrame(data)
    if planned is None or waypoints is None:
        return drawn
    names = [f"{axis}_axis_{name}" for axis in AXES for name in AXES]
    points = pd.DataFrame(planned.reshape(len(planned), -1), columns=names)
    points.insert(0, "time_s", waypoints["time_s"].to_numpy())
    return pd.concat([drawn.assign(drawn="flown"), points.assign(drawn="plan")])


def environment(
    table: pd.DataFrame, air: pd.DataFrame, assumptions: str, lever_mm: float
) -> Drawing:
    """Gravity gradient and drag over altitude; a band over the assumptions of the density.

    ``air`` is ``atmospheres.csv``, of which the air that the document's is a fit of is drawn at its
    least and largest solar flux, and ``lever_mm`` the document's lever, which the legend says.
    """
    figure, axes = subplots(figsize=(6.3, 3.9))
    middle = table[np.isclose(table["density_factor"], 1.0)]
    for i, (offset, rows) in enumerate(table.groupby("offset_mm")):
        band = rows.groupby("altitude_km")["drag_N_m"]
        altitude = np.array(sorted(rows["altitude_km"].unique()))
        axes.fill_between(altitude, band.min(), band.max(), color=f"C{i + 1}", alpha=0.2, lw=0)
        line = middle[middle["offset_mm"] == offset]
        source = " (Table 5)" if np.isclose(float(str(offset)), lever_mm) else ""
        axes.plot(
            line["altitude_km"], line["drag_N_m"], "--", color=f"C{i + 1}",
            label=f"drag, lever {offset:g} mm{source}",
        )  # fmt: skip
    one = middle.drop_duplicates("altitude_km")
    axes.plot(one["altitude_km"], one["gravity_gradient_N_m"], color="C0", label="gravity gradient")
    air = air[air["atmosphere"] == AIR[0]]
    for flux in sorted({air["solar_flux"].min(), air["solar_flux"].max()} - {np.nan}):
        line = air[air["solar_flux"] == flux].sort_values("altitude_km")
        axes.plot(line["altitude_km"], line["drag_N_m"], ":", color="0.2", lw=1.2)
        place = line.iloc[-1]
        axes.annotate(
            f"{flux:g}", (place["altitude_km"], place["drag_N_m"]), fontsize=7,
            xytext=(3, -2), textcoords="offset points",
        )  # fmt: skip
    label = f"{AIR[0]}, lever of Table 5,\nat solar fluxes F10.7"
    axes.plot([], [], ":", color="0.2", lw=1.2, label=label)
    axes.set(yscale="log", xlabel="altitude [km]", ylabel="mean torque [N m]")
    axes.legend(loc="upper right", ncols=2)
    axes.set_title(assumptions, fontsize=7.5)
    drawn = pd.concat([table.assign(atmosphere="exponential"), air.assign(offset_mm=lever_mm)])
    return figure, drawn


def trade_off(table: pd.DataFrame, printed: float, least: float, bound: float) -> Drawing:
    """Cost and peak momentum of feasible plans of the larger turn over their time.

    Crosses on the axis are times for which there is no plan.

    Parameters
    ----------
    table
        ``trade-off.csv``.
    printed
        The document's time, where the axis begins, s.
    least, bound
        Least time found, not a number where none was, and the time below which there is none, s.
    """
    figure, (left, right) = subplots(1, 2, figsize=(6.3, 3.0))
    solved = table["converged"] & table["held_converged"]
    good, lost = table[solved], table[~solved]
    start = min(printed, *table["duration_s"])
    left.plot(good["duration_s"], 1e3 * good["held_cost_N_m_s"], "o-", ms=3)
    left.set(xlabel="time of the manoeuvre [s]", ylabel=r"cost $\int|u|\,dt$ [mN m s]")
    for axis in AXES:
        right.plot(good["duration_s"], good[f"held_peak_{axis}_pct"], "o-", ms=3, label=f"${axis}$")
    right.set(xlabel="time of the manoeuvre [s]", ylabel="peak momentum [%]")
    right.legend()
    for panel in (left, right):
        panel.axvspan(min(start, bound), bound, color="0.6", alpha=0.5, lw=0)
        if least > bound:
            panel.axvspan(bound, least, color="0.8", alpha=0.5, lw=0)
        if len(lost):
            panel.plot(
                lost["duration_s"], np.zeros(len(lost)), "x", color="C3", clip_on=False,
                transform=panel.get_xaxis_transform(), label="no plan",
            )  # fmt: skip
            panel.legend()
        panel.set_xlim(left=start)
    bands = "dark: impossible with wheels'\nmomentum, proven; light:\nbelow the least time found"
    left.text(0.02, 0.03, bands, transform=left.transAxes, fontsize=7)
    data = good[["duration_s", "held_cost_N_m_s", *[f"held_peak_{a}_pct" for a in AXES]]]
    data = pd.concat([data, lost[["duration_s"]]]) if len(lost) else data
    return figure, data.assign(least_time_s=least, bound_s=bound)


def models(flights: pd.DataFrame, table: pd.DataFrame, parameters: Parameters) -> Drawing:
    """Momentum used in the larger turn by two models, by two readings, and the printed peaks.

    Parameters
    ----------
    flights
        ``models-flights.parquet``.
    table
        ``models.csv``.
    parameters
        The study's parameters.
    """
    if flights.empty:
        return missing("no plan by either model")
    printed = table[table["model"] == PRINTED].iloc[0]
    names, weights = (list(dict.fromkeys(flights[key])) for key in ("flight", "rate_weight"))
    figure, panels = subplots(
        len(weights),
        len(names),
        figsize=(6.3, 1.2 + 1.8 * len(weights)),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    drawn = []
    for (name, weight), flown in flights.groupby(["flight", "rate_weight"], sort=False):
        rows = flown.iloc[::THINNED]
        panel = panels[weights.index(weight), names.index(name)]
        data = rows[["flight", "rate_weight", "time_s"]].reset_index(drop=True)
        for reading, used in carried_pct(rows, parameters).items():
            for i, axis in enumerate(AXES):
                solid = reading == READINGS[0]
                label = f"$|{axis}|$" if solid else None
                data[f"{reading}, {axis}_pct"] = np.abs(used[:, i])
                panel.plot(
                    rows["time_s"], np.abs(used[:, i]), "-" if solid else "--", color=f"C{i}",
                    lw=1.1, label=label,
                )  # fmt: skip
        for i, peak in enumerate(PEAKS):
            panel.axhline(printed[peak], color=f"C{i}", lw=0.8, ls=":")
        panel.set_title(f"{name}, rate weight {weight:g}", fontsize=8)
        drawn.append(data)
    for panel in panels[-1]:
        panel.set_xlabel("time [s]")
    for panel in panels[:, 0]:
        panel.set_ylabel("momentum used [%]")
    panels[0, 0].legend(fontsize=7)
    figure.suptitle(
        f"solid: {READINGS[0]}; dashed: {READINGS[1]}; dotted: printed peaks", fontsize=8
    )
    return _frozen(figure), pd.concat(drawn, ignore_index=True)


def savings(table: pd.DataFrame) -> Drawing:
    """Torque saved over the time by motion off the eigenaxis and by the gravity gradient."""
    figure, panels = subplots(1, 2, figsize=(6.3, 2.9))
    parts = (
        ("saved_off_axis_pct", "saved off the eigenaxis [%]"),
        ("saved_by_gradient_pct", "saved by the gravity gradient [%]"),
    )
    for panel, (column, label) in zip(panels, parts, strict=True):
        for (model, rows), style in zip(
            table.groupby("model", sort=False), ("o-", "s--"), strict=False
        ):
            panel.plot(rows["duration_s"], rows[column], style, ms=4, label=str(model))
        panel.axhline(0.0, color="0.4", lw=0.7)
        panel.set(xlabel="time of the manoeuvre [s]", ylabel=label)
    panels[0].legend()
    return figure, table


def degradation(table: pd.DataFrame) -> Drawing:
    """Least time of the larger turn, and cost in a tenth more, over the wheels' torque.

    Crosses on the axis are torques for which one of them was not found.
    """
    figure, (left, right) = subplots(1, 2, figsize=(6.3, 2.9))
    for panel, name, label in (
        (left, "least_time_s", "least time [s]"),
        (right, "cost_N_m_s", "cost in 1.1 least times [mN m s]"),
    ):
        factor = 1e3 if name.startswith("cost") else 1.0
        panel.plot(table["torque_share_pct"], factor * table[name], "-", color="C0", lw=1.0)
        for limited, marker, word in (
            (False, "o", "torque limits"),
            (True, "s", "momentum limits"),
        ):
            rows = table[table["momentum_limited"] == limited]
            panel.plot(
                rows["torque_share_pct"], factor * rows[name], marker, ms=4,
                color="C1" if limited else "C0", label=word,
            )  # fmt: skip
        panel.set(xlabel="torque of the wheels [% of healthy]", ylabel=label)
        lost = table.loc[table[name].isna(), "torque_share_pct"]
        if len(lost):
            panel.plot(
                lost, np.zeros(len(lost)), "x", color="C3", clip_on=False,
                transform=panel.get_xaxis_transform(), label="not converged",
            )  # fmt: skip
            panel.legend()
    left.legend()
    return figure, table


def tracking(flights: pd.DataFrame) -> Drawing:
    """Pointing error over time, with and without an error of the inertia."""
    flights = flights[flights["control"].notna()]
    turns = list(flights["turn"].unique())
    errors = sorted(flights["inertia_error_pct"].unique())
    figure, panels = subplots(
        len(turns), len(errors), figsize=(6.3, 4.4), sharex="row", sharey="row", squeeze=False
    )
    for i, turn in enumerate(turns):
        for j, error in enumerate(errors):
            panel = panels[i, j]
            rows = flights[(flights["turn"] == turn) & (flights["inertia_error_pct"] == error)]
            for name, flown in rows.groupby("control", sort=False):
                panel.plot(
                    flown["time_s"], flown["error_deg"] + 1e-4, CONTROL_STYLES[str(name)],
                    label=name, lw=1.2,
                )  # fmt: skip
            panel.set(yscale="log", ylim=(1e-3, 300))
            panel.set_title(f"{turn}, inertia error {error:g} %")
            if j == 0:
                panel.set_ylabel("error to the target [deg]")
            panel.set_xlabel("time [s]")
    # A turn without a plan is flown by the eigenaxis law alone.
    lines, names = max(
        (p.get_legend_handles_labels() for p in panels[:, 0]), key=lambda h: len(h[1])
    )
    figure.legend(lines, names, loc="outside upper center", ncols=3)
    drawn = flights[["turn", "inertia_error_pct", "control", "time_s", "error_deg"]]
    return _frozen(figure), drawn


def _rows_of(
    motions: dict[str, pd.DataFrame], columns: int, height: float
) -> tuple[Figure, list[Any]]:
    """A figure with a row of panels for each motion, so high, in, below its title."""
    figure = new_figure(figsize=(6.3, height * len(motions)))
    parts = figure.subfigures(len(motions), 1, squeeze=False)[:, 0]
    panels = []
    for title, part in zip(motions, parts, strict=True):
        if title:
            part.suptitle(title, fontsize=8.5)
        panels.append(part.subplots(1, columns))
        for panel in panels[-1]:
            panel.set_xlabel("time [s]")
    return figure, panels


def _with_legends(figure: Figure, panels: list[Any]) -> Figure:
    """A legend in each panel."""
    for panel in np.ravel(panels):
        panel.legend(loc="best", fontsize=7, handlelength=1.3, frameon=True, framealpha=0.8)
    return _frozen(figure)


def _together(drawn: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """What several rows show, each with its title; of one row its table as it is."""
    if len(drawn) == 1:
        return next(iter(drawn.values()))
    tables = [table.assign(motion=title) for title, table in drawn.items()]
    return pd.concat(tables, ignore_index=True)


def _frozen(figure: Figure) -> Figure:
    """Laid out once, not again for each file format."""
    layout = figure.get_layout_engine()
    assert layout is not None
    # Rows of panels need a second pass.
    for _ in range(1 + bool(figure.subfigs)):
        layout.execute(figure)
    figure.set_layout_engine("none")
    return figure
