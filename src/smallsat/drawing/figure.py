"""Saving a figure: SVG, PDF, PNG and the data that it draws, byte-identical from the same data."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine, PlaceHolderLayoutEngine
from matplotlib.transforms import Bbox

from smallsat.results import write_table

# What functions that draw return: the figure, and the tidy table of exactly what it shows.
Drawing = tuple[Figure, pd.DataFrame]

FORMATS = ("svg", "pdf", "png")
_METADATA: dict[str, dict[str, None]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None, "ModDate": None},
    "png": {},
}


class SteadyLayout(ConstrainedLayoutEngine):
    """Matplotlib's constrained layout to nine digits.

    Its solver orders its unknowns by their addresses, so that places differ in their last bits from
    process to process, and with them how a long line is thinned out.
    """

    def execute(self, fig: Figure) -> None:
        """Lay the axes of a figure out."""
        super().execute(fig)
        for axes in fig.axes:
            place = np.round(axes.get_position(original=True).extents, 9)
            # As the layout itself does; the public function would take the axes out of it.
            axes._set_position(  # type: ignore[attr-defined]
                Bbox.from_extents(*place), which="original"
            )


def save_figure(figure: Figure, stem: Path | str, data: pd.DataFrame) -> None:
    """Write ``stem.svg``, ``.pdf``, ``.png`` and ``stem.csv`` with the data drawn.

    Parameters
    ----------
    figure
        The figure, made under `smallsat.drawing.style.apply_style`.
    stem
        Path without suffix, such as ``figures/transfer/fig-05``.
    data
        Tidy table of exactly what is drawn.
    """
    stem = Path(stem)
    stem.parent.mkdir(parents=True, exist_ok=True)
    layout = figure.get_layout_engine()
    if isinstance(layout, ConstrainedLayoutEngine):
        figure.set_layout_engine(SteadyLayout(**layout.get()))
    elif layout is None:
        # Where there is none, Matplotlib gives a figure that was saved once the style's own.
        figure.set_layout_engine(
            PlaceHolderLayoutEngine(adjust_compatible=True, colorbar_gridspec=True)
        )
    with _without_collection():
        for suffix in FORMATS:
            figure.savefig(stem.with_suffix(f".{suffix}"), metadata=_METADATA[suffix])
    write_table(data, stem.with_suffix(".csv"))


@contextmanager
def _without_collection() -> Iterator[None]:
    """Look for no garbage meanwhile: so much is made that a fifth of the time would go there."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
