"""How a figure says that what it would draw is not there."""

from matplotlib.axes import Axes

NOT_CONVERGED = "not converged"


def mark_missing(axes: Axes, line: str = NOT_CONVERGED) -> None:
    """Write a short line across the middle of axes, flat or in space, that have nothing to draw."""
    axes.annotate(
        line, (0.5, 0.5), xycoords="axes fraction", ha="center", va="center", color="#666666"
    )
