"""The graph of the rules in a picture: a node for each kind of rule of a study.

Snakemake prints the graph, some 250 rules, as Mermaid; the command condenses it and draws it.
"""

import argparse
import re
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch, Rectangle
from matplotlib.path import Path as MplPath

from smallsat.catalogue import read_catalogue
from smallsat.drawing.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, apply_style
from smallsat.workflow.figures import read_runs
from smallsat.workflow.names import rule_name

# Inches: columns, rows, nodes, and what is between the studies and what joins them. A browser shows
# the whole 1000 pixels wide, in which its letters are read.
_COLUMN, _ROW, _NODE, _GAP = 1.18, 0.84, (0.98, 0.26), 0.5
# Where in its row a group stands, as a share of the row's height.
_LANES = {"steps": 0.0, "notebooks": -0.24, "tables": 0.0, "verdicts": 0.24}
_COLOURS = {"steps": BLUE, "notebooks": GREEN, "verdicts": VERMILION, "tables": ORANGE}

Edges = set[tuple["Group", "Group"]]


@dataclass(frozen=True, order=True)
class Group:
    """Rules of one kind: of a study, or one by itself that puts all studies together."""

    study: str
    kind: str


@dataclass(frozen=True)
class Graph:
    """Groups, with the number of rules in each, and which of them feeds which."""

    rules: dict[Group, int]
    edges: Edges

    def __str__(self) -> str:
        """A line for each group: how many rules it has and what feeds it."""
        return "\n".join(
            f"{group.study} {group.kind} ({number}): "
            + ", ".join(f"{a.study} {a.kind}" for a, b in sorted(self.edges) if b == group)
            for group, number in sorted(self.rules.items())
        )


def rule_edges(mermaid: str) -> tuple[list[str], list[tuple[str, str]]]:
    """Rules, and pairs of rules of which the first feeds the second, as Snakemake prints them."""
    names = dict(re.findall(r"^\s*(id\d+)\[(\w+)\]$", mermaid, re.MULTILINE))
    links = re.findall(r"^\s*(id\d+) --> (id\d+)$", mermaid, re.MULTILINE)
    return list(names.values()), [(names[source], names[target]) for source, target in links]


def grouping(studies: Iterable[str], notebooks: Iterable[str]) -> Callable[[str], Group]:
    """The group of a rule by its name.

    Parameters
    ----------
    studies
        Names of the studies.
    notebooks
        Names of the rules that run a notebook.
    """
    notebooks = set(notebooks)

    def group(rule: str) -> Group:
        study = next((name for name in studies if rule.startswith(f"{name}_")), "")
        own = rule.removeprefix(f"{study}_")
        if not study or own in ("verdicts", "tables"):
            return Group(study, own)
        return Group(study, "notebooks" if rule in notebooks else "steps")

    return group


def condensed(
    rules: Iterable[str], edges: Iterable[tuple[str, str]], group: Callable[[str], Group]
) -> Graph:
    """The graph of the groups, without what feeds a group through another one already.

    Raises
    ------
    graphlib.CycleError
        If groups feed one another.
    """
    feeds = defaultdict(set)
    for source, target in edges:
        if group(source) != group(target):
            feeds[group(target)].add(group(source))
    above: dict[Group, set[Group]] = {}
    for node in TopologicalSorter(feeds).static_order():
        above[node] = feeds[node].union(*(above[source] for source in feeds[node]))
    direct = {
        (source, target)
        for target, sources in feeds.items()
        for source in sources
        if not any(source in above[other] for other in sources)
    }
    return Graph(dict(Counter(map(group, rules))), direct)


def columns(graph: Graph) -> dict[Group, int]:
    """Column of each group, right of all that feed it; first the studies, then what joins them."""
    feeds: dict[Group, set[Group]] = {group: set() for group in graph.rules}
    for source, target in graph.edges:
        feeds[target].add(source)
    found: dict[Group, int] = {}
    order = list(TopologicalSorter(feeds).static_order())
    for group in sorted(order, key=lambda group: group.study == ""):
        first = 0 if group.study else 1 + max(found[other] for other in order if other.study)
        found[group] = max([first, *(1 + found[source] for source in feeds[group])])
    return found


def drawn(graph: Graph, studies: Sequence[str]) -> Figure:
    """A picture of the graph: a row for each study, in their order, and two for what joins them."""
    column = columns(graph)
    own = 1 + max(column[group] for group in column if group.study)
    edge = own * _COLUMN
    width, height = (1 + max(column.values())) * _COLUMN + _GAP, len(studies) * _ROW
    figure = plt.figure(figsize=(width, height), layout="none")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    for row, study in enumerate(studies):
        band = Rectangle(
            (0.04, row * _ROW + 0.03), edge - 0.08, _ROW - 0.06, color="#f2f2f2", zorder=0
        )
        axes.add_patch(band)
        axes.text(0.1, row * _ROW + 0.09, study, va="top", weight="bold", fontsize=8)
    centre = {}
    for group, number in graph.rules.items():
        x = (column[group] + 0.5) * _COLUMN
        if group.study:
            y = (studies.index(group.study) + 0.5 + _LANES[group.kind]) * _ROW
        else:
            x += _GAP
            y = height / 2 + (-0.8 if group.kind.endswith("verdicts") else 0.8) * _ROW
        centre[group] = x, y
        _draw_group(axes, (x, y), group, number)
    for source, target in sorted(graph.edges):
        joins = source.study and not target.study
        bends_at = edge if joins else centre[target][0] - _COLUMN + _NODE[0] / 2
        _draw_edge(axes, centre[source], centre[target], bends_at)
    return figure


def _draw_edge(
    axes: Axes, source: tuple[float, float], target: tuple[float, float], bends_at: float
) -> None:
    """An arrow from the right of a node to the left of another, level to where it bends."""
    (x0, y0), (x1, y1) = source, target
    x0, x1 = x0 + _NODE[0] / 2, x1 - _NODE[0] / 2
    half = (bends_at + x1) / 2
    path = MplPath([(x0, y0), (bends_at, y0), (half, y0), (half, y1), (x1, y1)], [1, 2, 4, 4, 4])
    axes.add_patch(
        FancyArrowPatch(path=path, arrowstyle="-|>", mutation_scale=7, color=GREY, lw=0.8, zorder=1)
    )


def _draw_group(axes: Axes, centre: tuple[float, float], group: Group, number: int) -> None:
    (x, y), (width, height) = centre, _NODE
    axes.add_patch(
        FancyBboxPatch(
            (x - width / 2, y - height / 2),
            *(width, height),
            boxstyle="round,pad=0,rounding_size=0.06",
            facecolor="white",
            edgecolor=_COLOURS.get(group.kind, BLACK),
            lw=1.2,
            zorder=2,
        )
    )
    text = group.kind if number == 1 else f"{number} {group.kind}"
    axes.text(x, y, text, ha="center", va="center", fontsize=8, zorder=3)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``dag``; the graph comes from ``snakemake --rulegraph mermaid-js``."""
    parser.add_argument("--output", type=Path, required=True, help="the picture, SVG")


def main(arguments: argparse.Namespace) -> None:
    """Draw the graph that stands on the standard input; the picture says in words what it shows."""
    apply_style()
    studies = [study.name for study in read_catalogue(Path("data/published"))]
    notebooks = [
        rule_name(run.study, run.name)
        for study in studies
        for run in read_runs(Path("notebooks") / study)
    ]
    graph = condensed(*rule_edges(sys.stdin.read()), grouping(studies, notebooks))
    figure = drawn(graph, studies)
    metadata = {"Date": None, "Description": str(graph)}
    figure.savefig(arguments.output, facecolor="white", metadata=metadata)
