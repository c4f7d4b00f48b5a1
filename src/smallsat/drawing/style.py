"""One look for every figure: sizes, colours, fonts, and what makes the files reproducible."""

import matplotlib as mpl
from cycler import cycler
from fontTools.subset import Options

# Okabe and Ito's colours, which colour-blind readers can tell apart.
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILION, PURPLE = (
    "#000000",
    "#e69f00",
    "#56b4e9",
    "#009e73",
    "#0072b2",
    "#d55e00",
    "#cc79a7",
)
GREY = "#9a9a9a"
CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)

# Text width of the report, in inches.
WIDTH = 6.3

# Tables of a font that tell how letters stand together. In a PDF they stand already, and to cut
# these tables to the letters used takes longer than to draw the figure.
SETTING = ("GDEF", "GPOS", "GSUB")


def apply_style() -> None:
    """Set matplotlib's defaults for all figures of the report."""
    # First matplotlib's own defaults, so that no matplotlibrc of the user's has a say.
    mpl.rcdefaults()
    mpl.use("agg")
    dropped = Options._drop_tables_default
    Options._drop_tables_default = [*dropped, *(name for name in SETTING if name not in dropped)]
    mpl.rcParams.update(
        {
            "figure.figsize": (WIDTH, 3.4),
            "figure.constrained_layout.use": True,
            "figure.dpi": 110,
            "savefig.dpi": 150,
            "font.size": 9,
            "axes.titlesize": 9,
            "axes.labelsize": 9,
            "legend.fontsize": 8,
            "legend.frameon": False,
            "axes.grid": True,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "grid.color": "#dddddd",
            "grid.linewidth": 0.5,
            "lines.linewidth": 1.3,
            "axes.prop_cycle": cycler(color=CYCLE),
            # Fonts travel with the file, and nothing random or dated is written.
            "pdf.fonttype": 42,
            "svg.fonttype": "path",
            "svg.hashsalt": "smallsat",
        }
    )
