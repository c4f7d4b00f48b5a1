"""Saving a figure: SVG, PDF, PNG and the data that it draws, byte-identical from the same data."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from smallsat.results import write_table

# What functions that draw return: the figure, and the tidy table of exactly what it shows.
Drawing = tuple[Figure, pd.DataFrame]

FORMATS = ("svg", "pdf", "png")
_METADATA: dict[str, dict[str, None]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None, "ModDate": None},
    "png": {},
}


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
    for suffix in FORMATS:
        figure.savefig(stem.with_suffix(f".{suffix}"), metadata=_METADATA[suffix])
    write_table(data, stem.with_suffix(".csv"))
