"""Figures of the racing study: courses, races, trajectories, segments and what goes beyond."""

from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse
from mpl_toolkits.mplot3d import proj3d

from smallsat.drawing.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, WIDTH
from smallsat.studies.racing.figures.drawing import (
    COLOURS,
    ENLARGED,
    MISSING,
    OPTIMAL,
    RING,
    STYLES,
    TITLES,
    box,
    label_axes,
    look,
    positions,
    ring_curve,
    say_missing,
    zero_line,
)
from smallsat.studies.racing.methods.races import ANYWHERE, GREEDY, INDIRECT, LISTING, WHOLE
from smallsat.studies.racing.model.course import Course

AXIS_COLOURS = {"x": BLUE, "y": VERMILION, "z": GREEN}
ARROW_M = 110.0
# Crossings farther off than this many times the ring's larger axis are drawn at the edge.
FACE = 3.0
# Around the optimal paths of a segment, m.
SIDE_MARGIN, ASTRAY_M = 50.0, 60.0
# Inches: the record prints figures of this width in pairs, at four fifths of their size.
PAIR_WIDTH = 4.6
# Length of a ring's arrow in it, m, and width of the panel, in inches.
NORMAL_M, SIDE_WIDTH = 45.0, 2.9
# Height of a panel, inches: with two of them a figure is printed in its own size.
TALLEST = 1.55
# How far from its ring a number stands, as shares of a panel's width, and in which directions.
NUMBER_AWAY = (0.035, 0.055, 0.075)
NUMBER_TURNS = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
POINTS = ["x_m", "y_m", "z_m"]
SOLUTION_COLOURS = {
    LISTING: VERMILION,
    GREEDY: ORANGE,
    INDIRECT: SKY,
    WHOLE: BLUE,
    ANYWHERE: PURPLE,
}
SHORT = {
    LISTING: "our listing",
    GREEDY: "segments",
    INDIRECT: "indirect",
    WHOLE: "whole",
    ANYWHERE: "anywhere",
}


def _course_in(axes: Any, course: Course) -> np.ndarray:
    """Draw rings and normals; returns what is to be in view."""
    path = np.vstack([course.start, course.centres, course.end])
    axes.plot(*path.T, color="#cccccc", lw=0.7)
    for k in range(course.rings):
        axes.plot(*ring_curve(course, k, ENLARGED).T, color=RING, lw=0.9)
        axes.quiver(
            *course.centres[k], *(ARROW_M * course.normals[k]), color=BLACK, lw=0.7,
            arrow_length_ratio=0.35,
        )  # fmt: skip
    axes.plot(*course.start[:, None], "s", color=GREEN, ms=4)
    axes.plot(*course.end[:, None], "s", color=VERMILION, ms=4)
    return path


def _number_rings(axes: Any, course: Course, path: np.ndarray) -> None:
    """Number the rings in a view that is set: each where the picture has most room around it."""
    projection = axes.get_proj()

    def seen(points: np.ndarray) -> np.ndarray:
        return np.column_stack(proj3d.proj_transform(*points.T, projection)[:2])

    steps = np.linspace(0.0, 1.0, 12, endpoint=False)[:, None]
    line = np.vstack([a + steps * (b - a) for a, b in pairwise(path)])
    tips = course.centres + ARROW_M * course.normals
    taken = seen(np.vstack([line, course.centres, course.end, tips]))
    width = float(np.ptp(taken[:, 0]))
    ways = np.column_stack([np.cos(NUMBER_TURNS), np.sin(NUMBER_TURNS)])
    around = np.vstack([width * away * ways for away in NUMBER_AWAY])
    for k, spot in enumerate(seen(course.centres)):
        room = np.linalg.norm((spot + around)[:, None] - taken, axis=2).min(axis=1)
        # Nearer places come first where they are about as free.
        best = spot + around[np.argmax(room.round(2) - 0.1 * np.linalg.norm(around, axis=1))]
        axes.annotate(str(k + 1), best, fontsize=6, ha="center", va="center")
        taken = np.vstack([taken, best])


def course_figure(course: Course, paths: pd.DataFrame) -> Figure:
    """Figs. 1 and 7: the course from two sides, and the places at the start.

    Rings are numbered in order; the first view is the document's.
    """
    figure = plt.figure(figsize=(WIDTH, 3.0), layout="none")
    for left, turned in ((0.05, 0.0), (0.405, 90.0)):
        axes: Any = figure.add_axes((left, 0.02, 0.335, 0.9), projection="3d")
        path = _course_in(axes, course)
        box(axes, path)
        label_axes(axes)
        look(axes, turned)
        _number_rings(axes, course, path)
    near = figure.add_axes((0.89, 0.42, 0.105, 0.36))
    for name, colour in COLOURS.items():
        own = paths[(paths["solution"] == OPTIMAL) & (paths["cubesat"] == name)]
        if len(own):
            offset = positions(own)[0] - course.start
            near.plot(offset[0], offset[2], "o", color=colour, ms=5, label=name)
    near.plot(0.0, 0.0, "s", color=GREEN, ms=4, label="start")
    reach = max(1.0, 1.2 * float(np.abs([*near.dataLim.intervalx, *near.dataLim.intervaly]).max()))
    near.set_xlim(-reach, reach)
    near.set_ylim(-reach, reach)
    near.set_aspect("equal")
    near.tick_params(labelsize=6)
    near.set_xlabel("radial (m)", fontsize=7)
    near.set_ylabel("cross track (m)", fontsize=7)
    near.set_title("at the start", fontsize=8)
    near.legend(loc="upper center", bbox_to_anchor=(0.35, -0.42), fontsize=6, ncols=2,
                handlelength=1.0, columnspacing=1.0)  # fmt: skip
    figure.text(
        0.4, 0.95, f"{course.rings} rings, drawn {ENLARGED:g} times their size; arrows along the "
        "normals; start green, end red", ha="center", fontsize=8,
    )  # fmt: skip
    return figure


def course_data(course: Course) -> pd.DataFrame:
    """What `course_figure` draws."""
    rows = np.column_stack([course.centres, course.normals, course.semi_axes])
    names = [*POINTS, "nx", "ny", "nz", "semi_major_m", "semi_minor_m"]
    table = pd.DataFrame(rows, columns=names)
    table.insert(0, "ring", np.arange(1, course.rings + 1))
    return table


def race_figure(course: Course, paths: pd.DataFrame, races: pd.DataFrame) -> Figure:
    """Figs. 2 and 8: all CubeSats, our solve of the listing and the optimum, on the same scale."""
    figure = plt.figure(figsize=(WIDTH, 3.9), layout="none")
    for place, solution in enumerate((LISTING, OPTIMAL)):
        axes: Any = figure.add_axes((0.5 * place + 0.04, 0.23, 0.44, 0.7), projection="3d")
        around = _course_in(axes, course)
        box(axes, around, 0.25)
        limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
        scores = races[races["solution"] == solution].set_index("cubesat")
        for name, colour in COLOURS.items():
            path = paths[(paths["solution"] == solution) & (paths["cubesat"] == name)]
            points = positions(path)
            # Where a path leaves the view, the line breaks off.
            outside = ((points < limits[:, 0]) | (points > limits[:, 1])).any(axis=1)
            points = np.where(np.atleast_2d(outside).T, np.nan, points)
            axes.plot(
                *points.T, color=colour, lw=1.0,
                label=f"{name}: {MISSING if path.empty else _score(scores, name)}",
            )  # fmt: skip
        label_axes(axes)
        look(axes)
        figure.text(0.25 + 0.5 * place, 0.95, TITLES[solution], ha="center", fontsize=9)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), fontsize=6.5)
    return figure


def _score(scores: pd.DataFrame, name: str) -> str:
    race = scores.loc[name].to_dict()
    failed = race["not_converged"]
    solved = f", {failed:.0f} segments not converged" if failed else ""
    return f"cost {race['cost']:.0f}, {race['missed']:.0f} missed{solved}"


def path_data(paths: pd.DataFrame) -> pd.DataFrame:
    """Positions drawn."""
    return paths[["solution", "cubesat", "segment", "time_s", *POINTS]].round(6)


PANELS = (
    ("position\n(m)", ["x_m", "y_m", "z_m"]),
    ("velocity\n(m/s)", ["vx_m_s", "vy_m_s", "vz_m_s"]),
    ("adjoints $p_r$\n(s/m)", ["px", "py", "pz"]),
    ("primer\n(s$^2$/m)", ["pvx", "pvy", "pvz"]),
)
# Below them each axis of the thrust by itself: they change too often to be told apart in one.
STRIPS = ("ux_m_s2", "uy_m_s2", "uz_m_s2")


def trajectory_figure(course: Course, paths: pd.DataFrame, cubesat: str) -> Figure:
    """Figs. 3 to 6 and 9 to 12: state, adjoints and thrust over time; dots where rings ask."""
    rows = len(PANELS) + len(STRIPS)
    figure, grid = plt.subplots(
        rows, 2, figsize=(PAIR_WIDTH, 5.0), sharex="col",
        height_ratios=[1.0] * len(PANELS) + [0.55] * len(STRIPS),
    )  # fmt: skip
    for column, solution in enumerate((LISTING, OPTIMAL)):
        own = paths[(paths["solution"] == solution) & (paths["cubesat"] == cubesat)]
        if own.empty:
            for axes in grid[:, column]:
                say_missing(axes)
        last = own.groupby("segment").last()
        arrivals = last["time_s"].to_numpy()[: course.rings]
        for row, (_, names) in enumerate(PANELS):
            axes = grid[row, column]
            zero_line(axes)
            for name, (axis, colour) in zip(names, AXIS_COLOURS.items(), strict=True):
                axes.plot(own["time_s"], own[name], color=colour, lw=0.9, label=axis)
        for row, (name, colour) in enumerate(zip(STRIPS, AXIS_COLOURS.values(), strict=True)):
            axes = grid[len(PANELS) + row, column]
            zero_line(axes)
            axes.plot(own["time_s"], own[name], color=colour, lw=0.6)
        speed = last[PANELS[1][1]].pow(2).sum(axis=1).pow(0.5).to_numpy()[: len(arrivals)]
        wanted = (course.centres, speed[:, None] * course.normals[: len(speed)])
        for row, goals in enumerate(wanted):
            for i, colour in enumerate(AXIS_COLOURS.values()):
                grid[row, column].plot(
                    arrivals, goals[: len(arrivals), i], "o", ms=3, mfc="white", mec=colour,
                    mew=0.8,
                )  # fmt: skip
        grid[0, column].set_title(TITLES[solution])
        grid[-1, column].set_xlabel("time (s)")
    for axes, (label, _) in zip(grid[:, 0], PANELS, strict=False):
        axes.set_ylabel(label, fontsize=8)
    for axes, axis in zip(grid[len(PANELS) :, 0], AXIS_COLOURS, strict=True):
        axes.set_ylabel(f"$u_{axis}$\n(m/s$^2$)", fontsize=8)
    figure.align_ylabels(grid[:, 0])
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
    names = [name for _, panel in PANELS for name in panel]
    columns = ["solution", "segment", "time_s", *names, *STRIPS]
    return paths.loc[paths["cubesat"] == cubesat, columns]


def segment_figure(course: Course, paths: pd.DataFrame, segment: int) -> Figure:
    """Figs. 13 to 61: a segment by our solve of the listing, optimal, and the crossings face on.

    The paths are seen from the side on which the optimal ones bend most, both panels on one scale;
    where a path leaves them, the line breaks off.
    """
    own = paths[paths["segment"] == segment]
    final = segment == course.rings
    before = course.start if segment == 0 else course.centres[segment - 1]
    after = course.end if final else course.centres[segment]
    # Without an optimal path in it, a segment is seen around its two ends.
    paths_shown = positions(own[own["solution"] == OPTIMAL])
    points_shown = paths_shown if len(paths_shown) else np.array([before, after])
    view = _side_view(before, after, points_shown)
    optimal = (points_shown - before) @ view.T
    low, high = optimal.min(axis=0) - SIDE_MARGIN, optimal.max(axis=0) + SIDE_MARGIN
    # Our solve of the listing is followed aside, though not everywhere.
    astray = np.clip((positions(own) - before) @ view[1], low[1] - ASTRAY_M, high[1] + ASTRAY_M)
    low[1], high[1] = min([low[1], *astray]), max([high[1], *astray])
    shape = float((high - low)[1] / (high - low)[0])
    tall = float(np.clip(0.85 * SIDE_WIDTH * shape, 0.8, TALLEST))
    figure = plt.figure(figsize=(PAIR_WIDTH, 2.0 * tall + 1.5))
    grid = figure.add_gridspec(2, 2, width_ratios=(SIDE_WIDTH, PAIR_WIDTH - SIDE_WIDTH))
    sides = [figure.add_subplot(grid[0, 0])]
    sides.append(figure.add_subplot(grid[1, 0], sharex=sides[0], sharey=sides[0]))
    for axes, solution in zip(sides, (LISTING, OPTIMAL), strict=True):
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
                    "", centre + NORMAL_M * along, centre, annotation_clip=False,
                    arrowprops={"arrowstyle": "->", "color": colour, "lw": 1.0, "shrinkA": 0,
                                "shrinkB": 0},
                )  # fmt: skip
        for spot, shown, colour in ((before, segment == 0, GREEN), (after, final, VERMILION)):
            if shown:
                axes.plot(*((spot - before) @ view.T), "s", color=colour, ms=5)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        axes.set_ylabel("aside (m)", fontsize=8)
        axes.tick_params(labelsize=7)
        axes.set_title(TITLES[solution])
    sides[0].tick_params(labelbottom=False)
    sides[1].set_xlabel("along the segment (m)", fontsize=8)
    face = figure.add_subplot(grid[:, 1])
    _face_in(face, course, own, segment)
    handles = [
        Line2D([], [], color=colour, ls=STYLES[name], label=name)
        for name, colour in COLOURS.items()
    ]
    handles += [
        Line2D([], [], marker="x", ls="", color=BLACK, ms=5, label="crossing, our listing"),
        Line2D([], [], marker="o", ls="", mfc="white", mec=BLACK, ms=4, label="crossing, optimal"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=7.5)
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
    axes.set_xlabel("level (m)", fontsize=8)
    axes.set_ylabel("across (m)", fontsize=8)
    axes.tick_params(labelsize=7)
    title = "around the end (1 m)" if final else f"ring {k + 1} along its normal"
    axes.set_title(f"{title}\n(at the edge: farther off)", fontsize=7.5)


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
                labels.append(f"{name}, {SHORT[solution]}")
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
        left.plot(rows["intervals"], gain, marker="o", color=colour, ls=STYLES[name], label=name)
        if rows["primer_angle_median_deg"].notna().all():
            right.loglog(
                rows["intervals"], rows["primer_angle_median_deg"], marker="o", color=colour,
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
    """The optimal time and delta-v over thrust, and what a metre of miss could save."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(WIDTH, 2.7))
    ordered = sweep.sort_values("thrust_m_s2")
    thrusts = ordered["thrust_m_s2"]
    for name in (OPTIMAL, ANYWHERE):
        left.loglog(
            thrusts, ordered[f"{name} (s)"], "o-", color=SOLUTION_COLOURS[name], ms=3, label=name,
        )  # fmt: skip
    middle.loglog(thrusts, ordered[f"{OPTIMAL}, delta-v (m/s)"], "o-", color=BLUE, ms=3)
    right.loglog(thrusts, ordered["largest_ring_multiplier_s_m"], "o-", color=PURPLE, ms=3)
    missing = ordered[ordered[f"{OPTIMAL} (s)"].isna()]["thrust_m_s2"]
    for axes in (left, middle, right):
        for place, thrust in enumerate(missing):
            label = "no plan at rest at the end" if place == 0 else "_"
            axes.axvline(thrust, color=VERMILION, ls=":", lw=1.0, label=label)
        axes.set_xlabel("thrust (m/s$^2$)")
    right.axhline(1.0, color=VERMILION, ls="--", lw=1.0)
    right.text(
        thrusts.max(), 1.1, "what it costs", color=VERMILION, va="bottom", ha="right", fontsize=7
    )  # fmt: skip
    left.set_ylabel("time (s)")
    middle.set_ylabel("delta-v (m/s)")
    right.set_ylabel("a metre of miss saves (s)")
    left.legend(fontsize=5.5, loc="upper right")
    return figure
