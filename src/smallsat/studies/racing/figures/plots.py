"""Figures of the racing study: courses, races, trajectories, segments and what goes beyond."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse

from smallsat.drawing.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, WIDTH
from smallsat.studies.racing.figures.drawing import (
    COLOURS,
    ENLARGED,
    LISTING,
    MISSING,
    OPTIMAL,
    RING,
    STYLES,
    TITLES,
    VIEW_AZIMUTH_DEG,
    VIEW_ELEVATION_DEG,
    box,
    label_axes,
    positions,
    ring_curve,
    say_missing,
    zero_line,
)
from smallsat.studies.racing.model.course import Course

AXIS_COLOURS = {"x": BLUE, "y": VERMILION, "z": GREEN}
ARROW_M = 110.0
# Crossings farther off than this many times the ring's larger axis are drawn at the edge.
FACE = 3.0
# Around the optimal paths of a segment, m.
SIDE_MARGIN = 45.0
POINTS = ["x_m", "y_m", "z_m"]
SOLUTION_COLOURS = {
    "as published": VERMILION,
    "segment by segment": ORANGE,
    "segment by segment, indirect": SKY,
    "whole course": BLUE,
    "whole course, rest anywhere": PURPLE,
}


def _course_in(axes: Any, course: Course, numbers: bool = True) -> np.ndarray:
    """Draw rings, normals and order; returns what is to be in view."""
    path = np.vstack([course.start, course.centres, course.end])
    axes.plot(*path.T, color="#cccccc", lw=0.7)
    for k in range(course.rings):
        axes.plot(*ring_curve(course, k, ENLARGED).T, color=RING, lw=0.9)
        axes.quiver(
            *course.centres[k], *(ARROW_M * course.normals[k]), color=BLACK, lw=0.7,
            arrow_length_ratio=0.35,
        )  # fmt: skip
        if numbers:
            axes.text(*(course.centres[k] + [0, 0, 55]), str(k + 1), fontsize=7, color=BLACK)
    axes.plot(*course.start[:, None], "s", color=GREEN, ms=5)
    axes.plot(*course.end[:, None], "s", color=VERMILION, ms=5)
    if numbers:
        axes.text(*(course.start + np.array([0.0, 0.0, 60.0])), "start", fontsize=7, color=GREEN)
        axes.text(*(course.end - np.array([0.0, 0.0, 120.0])), "end", fontsize=7, color=VERMILION)
    return path


def course_figure(course: Course) -> Figure:
    """Figs. 1 and 7: the course from two sides, with rings in order and the way through them."""
    figure = plt.figure(figsize=(WIDTH, 3.9))
    for place, azimuth in ((1, VIEW_AZIMUTH_DEG), (2, VIEW_AZIMUTH_DEG + 90.0)):
        axes = figure.add_subplot(1, 2, place, projection="3d")
        path = _course_in(axes, course)
        box(axes, path)
        label_axes(axes)
        axes.view_init(VIEW_ELEVATION_DEG, azimuth)
    figure.suptitle(
        f"{course.rings} rings (drawn {ENLARGED:g} times their size), arrows along the normals",
        fontsize=9,
    )
    return figure


def course_data(course: Course) -> pd.DataFrame:
    """What `course_figure` draws."""
    rows = np.column_stack([course.centres, course.normals, course.semi_axes])
    names = [*POINTS, "nx", "ny", "nz", "semi_major_m", "semi_minor_m"]
    table = pd.DataFrame(rows, columns=names)
    table.insert(0, "ring", np.arange(1, course.rings + 1))
    return table


def race_figure(course: Course, paths: pd.DataFrame, races: pd.DataFrame) -> Figure:
    """Figs. 2 and 8: all CubeSats, as published and optimal, on the same scale."""
    figure = plt.figure(figsize=(WIDTH, 4.3))
    for place, solution in enumerate((LISTING, OPTIMAL), start=1):
        axes = figure.add_subplot(1, 2, place, projection="3d")
        around = _course_in(axes, course, numbers=False)
        box(axes, around, 0.25)
        limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
        scores = races[races["solution"] == solution].set_index("cubesat")
        for name, colour in COLOURS.items():
            path = paths[(paths["solution"] == solution) & (paths["cubesat"] == name)]
            points = positions(path)
            # Where a path leaves the view, the line breaks off.
            outside = ((points < limits[:, 0]) | (points > limits[:, 1])).any(axis=1)
            points = np.where(np.atleast_2d(outside).T, np.nan, points)
            score = scores.loc[name]
            label = f"cost {score['cost']:.0f}, {score['missed']:.0f} missed"
            axes.plot(
                *points.T, color=colour, lw=1.0,
                label=f"{name}: {MISSING if path.empty else label}",
            )  # fmt: skip
        label_axes(axes)
        axes.view_init(VIEW_ELEVATION_DEG, VIEW_AZIMUTH_DEG)
        axes.set_title(TITLES[solution], pad=0)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), fontsize=7)
    return figure


def path_data(paths: pd.DataFrame) -> pd.DataFrame:
    """Positions drawn."""
    return paths[["solution", "cubesat", "segment", "time_s", *POINTS]].round(6)


PANELS = (
    ("position (m)", ["x_m", "y_m", "z_m"]),
    ("velocity (m/s)", ["vx_m_s", "vy_m_s", "vz_m_s"]),
    ("primer (s$^2$/m)", ["pvx", "pvy", "pvz"]),
    ("thrust (m/s$^2$)", ["ux_m_s2", "uy_m_s2", "uz_m_s2"]),
)


def trajectory_figure(course: Course, paths: pd.DataFrame, cubesat: str) -> Figure:
    """Figs. 3 to 6 and 9 to 12: state, primer and thrust over time; dots where rings ask."""
    figure, grid = plt.subplots(4, 2, figsize=(WIDTH, 6.6), sharex="col")
    for column, solution in enumerate((LISTING, OPTIMAL)):
        own = paths[(paths["solution"] == solution) & (paths["cubesat"] == cubesat)]
        if own.empty:
            for axes in grid[:, column]:
                say_missing(axes)
        last = own.groupby("segment").last()
        arrivals = last["time_s"].to_numpy()[: course.rings]
        for row, (label, names) in enumerate(PANELS):
            axes = grid[row, column]
            zero_line(axes)
            for name, (axis, colour) in zip(names, AXIS_COLOURS.items(), strict=True):
                axes.plot(own["time_s"], own[name], color=colour, lw=0.9, label=axis)
            if row < 2:
                for i, colour in enumerate(AXIS_COLOURS.values()):
                    if row == 0:
                        wanted = course.centres[:, i]
                    else:
                        speed = last[PANELS[1][1]].pow(2).sum(axis=1).pow(0.5).to_numpy()
                        wanted = speed[: len(arrivals)] * course.normals[: len(arrivals), i]
                    axes.plot(
                        arrivals, wanted[: len(arrivals)], "o", ms=3, mfc="white", mec=colour,
                        mew=0.8,
                    )  # fmt: skip
            if column == 0:
                axes.set_ylabel(label)
        grid[0, column].set_title(TITLES[solution])
        grid[3, column].set_xlabel("time (s)")
    handles = [
        *(Line2D([], [], color=colour, label=axis) for axis, colour in AXIS_COLOURS.items()),
        Line2D(
            [], [], marker="o", ls="", mfc="white", mec=BLACK, ms=3, label="asked for at a ring"
        ),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure


def trajectory_data(paths: pd.DataFrame, cubesat: str) -> pd.DataFrame:
    """What `trajectory_figure` draws."""
    columns = ["solution", "segment", "time_s", *(name for _, names in PANELS for name in names)]
    return paths.loc[paths["cubesat"] == cubesat, columns]


def segment_figure(course: Course, paths: pd.DataFrame, segment: int) -> Figure:
    """Figs. 13 to 61: a segment as published, optimal, and the crossings seen along the normal.

    The paths are seen from the side on which the optimal ones bend most.
    """
    own = paths[paths["segment"] == segment]
    final = segment == course.rings
    figure = plt.figure(figsize=(WIDTH, 2.7))
    grid = figure.add_gridspec(1, 3, width_ratios=(1.2, 1.2, 1.0))
    before = course.start if segment == 0 else course.centres[segment - 1]
    after = course.end if final else course.centres[segment]
    # Without an optimal path in it, a segment is seen around its two ends.
    paths_shown = positions(own[own["solution"] == OPTIMAL])
    points_shown = paths_shown if len(paths_shown) else np.array([before, after])
    view = _side_view(before, after, points_shown)
    optimal = (points_shown - before) @ view.T
    low, high = optimal.min(axis=0) - SIDE_MARGIN, optimal.max(axis=0) + SIDE_MARGIN
    for place, solution in enumerate((LISTING, OPTIMAL)):
        axes = figure.add_subplot(grid[place])
        for name, colour in COLOURS.items():
            path = own[(own["solution"] == solution) & (own["cubesat"] == name)]
            points = (positions(path) - before) @ view.T
            axes.plot(*points.T, color=colour, ls=STYLES[name], lw=1.2)
        if own[own["solution"] == solution].empty:
            say_missing(axes)
        for k, colour in ((segment - 1, GREEN), (segment, VERMILION)):
            if 0 <= k < course.rings:
                ring = (ring_curve(course, k, 3.0) - before) @ view.T
                axes.plot(*ring.T, color=colour, lw=1.2)
                centre, along = (course.centres[k] - before) @ view.T, view @ course.normals[k]
                axes.annotate(
                    "", centre + 45.0 * along, centre,
                    arrowprops={"arrowstyle": "->", "color": colour, "lw": 1.0},
                )  # fmt: skip
        for spot, shown, colour in ((before, segment == 0, GREEN), (after, final, VERMILION)):
            if shown:
                axes.plot(*((spot - before) @ view.T), "s", color=colour, ms=5)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("along the segment (m)", fontsize=8)
        axes.set_ylabel("aside (m)" if place == 0 else "", fontsize=8)
        axes.tick_params(labelsize=7)
        axes.set_title("as published" if solution == LISTING else "optimal")
    face = figure.add_subplot(grid[2])
    _face_in(face, course, own, segment)
    handles = [
        Line2D([], [], color=colour, ls=STYLES[name], label=name)
        for name, colour in COLOURS.items()
    ]
    handles += [
        Line2D([], [], marker="x", ls="", color=BLACK, ms=5, label="crossing, as published"),
        Line2D([], [], marker="o", ls="", mfc="white", mec=BLACK, ms=4, label="crossing, optimal"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=6, fontsize=7)
    return figure


def _side_view(before: np.ndarray, after: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Two unit vectors (2, 3): along the segment, and where points (p, 3) leave it most."""
    along = (after - before) / np.linalg.norm(after - before)
    off = points - before
    off = off - np.outer(off @ along, along)
    aside = np.linalg.svd(off, full_matrices=False)[2][0]
    aside = aside - (aside @ along) * along
    if not np.linalg.norm(aside) > 0.0:
        # A straight way is seen from anywhere.
        aside = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    aside /= np.linalg.norm(aside)
    # There are two equal views; in this one the paths bend upwards.
    return np.array([along, aside if (off @ aside).sum() >= 0.0 else -aside])


def _face_in(axes: Any, course: Course, own: pd.DataFrame, segment: int) -> None:
    """Where the segment's ends lie in the plane of the ring, or around the end."""
    final = segment == course.rings
    k = min(segment, course.rings - 1)
    level, up = course.axes[k]
    centre = course.end if final else course.centres[k]
    a, b = (1.0, 1.0) if final else course.semi_axes[k]
    reach = FACE * max(a, b)
    axes.add_patch(Ellipse((0, 0), 2 * a, 2 * b, fc="#eeeeee", ec=RING, lw=1.0))
    if not final:
        axes.add_patch(Ellipse((0, 0), 2 * min(a, b), 2 * min(a, b), fc="none", ec=RING, ls=":"))
    for solution, marker in ((LISTING, "x"), (OPTIMAL, "o")):
        for name, colour in COLOURS.items():
            path = own[(own["solution"] == solution) & (own["cubesat"] == name)]
            if path.empty:
                continue
            offset = positions(path)[-1] - centre
            spot = np.array([offset @ level, offset @ up])
            far = float(np.abs(spot).max())
            if far > reach:
                spot = spot * (0.97 * reach / far)
            axes.plot(
                *spot, marker, color=colour, ms=6 if marker == "x" else 4, mew=1.2,
                mfc="white" if marker == "o" else colour, clip_on=False,
            )  # fmt: skip
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.set_xlabel("level (m)", fontsize=7)
    axes.set_ylabel("across (m)", fontsize=7)
    axes.tick_params(labelsize=6)
    title = "around the end (1 m)" if final else f"ring {k + 1} along its normal"
    axes.set_title(f"{title}\nat the edge: farther off", fontsize=8)


def segment_data(paths: pd.DataFrame, segment: int) -> pd.DataFrame:
    """What `segment_figure` draws."""
    return path_data(paths[paths["segment"] == segment])


def missed_figure(rings: pd.DataFrame) -> Figure:
    """Who missed which ring: a square a ring, for every solution of every CubeSat."""
    solutions = list(SOLUTION_COLOURS)
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 4.6), width_ratios=(22, 25))
    for axes, scenario in zip(panels, ("scenario-1", "scenario-2"), strict=True):
        own = rings[rings["scenario"] == scenario]
        labels, row = [], 0
        for solution in solutions:
            for name in COLOURS:
                crossed = own[(own["solution"] == solution) & (own["cubesat"] == name)]
                if crossed.empty:
                    # Not solved, or of a CubeSat that this method does not serve.
                    continue
                for ring, missed, off in crossed[["ring", "missed", "off_axis"]].to_numpy():
                    colour = VERMILION if missed else (ORANGE if off else "#cfe8df")
                    axes.add_patch(plt.Rectangle((ring - 0.45, row - 0.42), 0.9, 0.84, fc=colour))
                labels.append(f"{name}, {_short(solution)}")
                row += 1
        axes.set_yticks(range(row), labels, fontsize=6)
        axes.set_xlim(0.3, own["ring"].max() + 0.7)
        axes.set_ylim(row - 0.4, -0.6)
        axes.grid(False)
        axes.set_xlabel("ring")
        axes.set_title(f"Scenario {scenario[-1]}")
    handles = [
        plt.Rectangle((0, 0), 1, 1, fc=colour, label=label)
        for colour, label in (
            ("#cfe8df", "passed"),
            (ORANGE, "inside, not along the normal"),
            (VERMILION, "missed"),
        )
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def _short(solution: str) -> str:
    return {
        "as published": "published",
        "segment by segment": "segments",
        "segment by segment, indirect": "indirect",
        "whole course": "whole",
        "whole course, rest anywhere": "anywhere",
    }[solution]


def score_figure(scores: pd.DataFrame) -> Figure:
    """Who won and by how much: printed cost, and ours by every solution."""
    kinds = ["printed", *(s for s in SOLUTION_COLOURS if s in set(scores["solution"]))]
    colours = {"printed": BLACK} | SOLUTION_COLOURS
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 3.4), sharey=True)
    for axes, scenario in zip(panels, ("scenario-1", "scenario-2"), strict=True):
        own = scores[scores["scenario"] == scenario]
        for place, name in enumerate(COLOURS):
            for shift, kind in enumerate(kinds):
                row = own[(own["cubesat"] == name) & (own["solution"] == kind)]
                if len(row):
                    axes.plot(
                        row["cost"], [place + 0.12 * (shift - 2.5)],
                        "o" if kind != "printed" else "D", color=colours[kind], ms=5,
                    )  # fmt: skip
        axes.set_xscale("log")
        _round_ticks(axes.set_xticks, [1000, 2000, 5000, 10000, 30000], scores["cost"])
        axes.minorticks_off()
        axes.set_xlabel("cost (s + m)")
        axes.set_title(f"Scenario {scenario[-1]}")
        axes.set_yticks(range(len(COLOURS)), list(COLOURS))
    panels[0].invert_yaxis()
    handles = [
        Line2D([], [], marker="D" if k == "printed" else "o", ls="", color=colours[k], label=k)
        for k in kinds
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def _round_ticks(set_ticks: Any, ticks: list[int], shown: pd.Series) -> None:
    """Ticks of a logarithmic axis: these, and their multiples by powers of ten up to the data."""
    least, largest = shown.min(), shown.max()
    if not least > 0.0:
        return
    first = int(np.floor(np.log10(least / ticks[0]) + 0.5))
    last = max(first, int(np.floor(np.log10(largest / ticks[-1]))))
    scaled = [tick * 10.0**power for power in range(first, last + 1) for tick in ticks]
    set_ticks(scaled, [f"{tick:.10g}" for tick in scaled])


def random_figure(courses: pd.DataFrame, races: pd.DataFrame, printed: pd.DataFrame) -> Figure:
    """Optimal times of random courses, the course itself, and the printed times."""
    figure, axes = plt.subplots(figsize=(WIDTH, 3.2))
    bins = np.linspace(courses["time_s"].min(), courses["time_s"].max(), 41)
    if courses["time_s"].isna().all():
        say_missing(axes)
        bins = np.array([0.0, 1.0])
    for rule, colour, label in (
        ("generator", BLUE, "random courses of the generator"),
        ("text", ORANGE, "random courses by the text's rules"),
    ):
        times = courses.loc[courses["rule"] == rule, "time_s"].dropna()
        axes.hist(times, bins.tolist(), histtype="step", color=colour, lw=1.3, label=label)
    ours = races[(races["scenario"] == "scenario-2") & (races["solution"] == OPTIMAL)]
    if ours["time_s"].notna().any():
        axes.axvline(ours["time_s"].mean(), color=BLACK, lw=1.2, label="this course, optimal")
    top = axes.get_ylim()[1]
    own = printed[printed["scenario"] == "scenario-2"].sort_values("time_s")
    for step, row in enumerate(own.to_dict("records")):
        axes.axvline(row["time_s"], color=COLOURS[row["cubesat"]], ls=":", lw=1.2)
        axes.text(
            row["time_s"], top * (0.98 - 0.09 * step), f" {row['cubesat']}, printed",
            color=COLOURS[row["cubesat"]], fontsize=7, va="top",
        )  # fmt: skip
    # Up to the last printed time; farther only where that would leave most courses out.
    last = own["time_s"].max() + 60.0
    if not courses["time_s"].median() > last:
        axes.set_xlim(right=last)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("courses")
    axes.legend(loc="upper left", fontsize=7)
    return figure


def mesh_figure(meshes: pd.DataFrame) -> Figure:
    """What finer meshes change: time, and the angle between thrust and primer."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.9))
    own = meshes[meshes["scenario"] == "scenario-1"]
    for name, colour in COLOURS.items():
        rows = own[own["cubesat"] == name].sort_values("intervals")
        gain = 100.0 * (rows["time_s"] / rows["time_s"].iloc[-1] - 1.0)
        left.plot(rows["intervals"], gain, "o-", color=colour, ls=STYLES[name], label=name)
        if rows["primer_angle_median_deg"].notna().all():
            right.loglog(
                rows["intervals"], rows["primer_angle_median_deg"], "o-", color=colour,
                ls=STYLES[name],
            )  # fmt: skip
    left.set_xlabel("held pieces a segment")
    left.set_ylabel("time above the finest mesh's (%)")
    left.legend()
    right.set_xlabel("held pieces a segment")
    right.set_ylabel("median angle, thrust to primer (deg)")
    ticks = sorted(own["intervals"].unique())
    for axes in (left, right):
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
        axes.minorticks_off()
    return figure


def thrust_figure(sweep: pd.DataFrame) -> Figure:
    """The optimal time over thrust, and what a metre of miss could save."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.9))
    ordered = sweep.sort_values("thrust_m_s2")
    for name in (OPTIMAL, "whole course, rest anywhere"):
        left.loglog(
            ordered["thrust_m_s2"], ordered[f"{name} (s)"], "o-", color=SOLUTION_COLOURS[name],
            label=name,
        )  # fmt: skip
    right.semilogx(ordered["thrust_m_s2"], ordered["largest_ring_multiplier_s_m"], "o-", color=BLUE)
    right.axhline(1.0, color=VERMILION, ls="--", lw=1.0)
    right.text(ordered["thrust_m_s2"].min(), 0.93, "what it costs", color=VERMILION, va="top")
    right.set_ylim(0.0, max(1.1, 1.1 * ordered["largest_ring_multiplier_s_m"].max()))
    left.set_ylabel("time (s)")
    _round_ticks(left.set_yticks, [600, 1000, 2000], ordered[f"{OPTIMAL} (s)"])
    right.set_ylabel("most that a metre of miss saves (s/m)")
    for axes in (left, right):
        axes.set_xlabel("thrust (m/s$^2$)")
        axes.set_xticks(ordered["thrust_m_s2"], [f"{u:g}" for u in ordered["thrust_m_s2"]])
        axes.minorticks_off()
    left.legend(fontsize=7)
    return figure
