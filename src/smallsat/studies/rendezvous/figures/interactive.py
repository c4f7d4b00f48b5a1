"""The rendezvous to turn and play."""

from pathlib import Path

from smallsat.drawing.interactive import Scene, Track, sphere
from smallsat.drawing.style import BLUE, GREY, ORANGE, PURPLE
from smallsat.results import read_table
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.parameters import law

POSITION = ["x_m", "y_m", "z_m"]
CASES = {
    "v-bar": ("V-bar docking", BLUE, "fig-3-3"),
    "r-bar": ("R-bar docking", ORANGE, "fig-3-4"),
    "rotating": ("Docking with a turning target", PURPLE, "fig-3-5"),
}


def scenes(section: Configuration, results: Path) -> list[Scene]:
    """Each case of chapter 3 around the keep-out sphere."""
    paths, found = read_table(results / "paths.parquet"), []
    zone = sphere(law(section).keep_out, GREY, "keep-out zone")
    for name, (title, colour, fallback) in CASES.items():
        own = paths[paths["flight"] == name]
        if len(own):
            track = Track("chaser", colour, own["time_s"].to_numpy(), own[POSITION].to_numpy())
            found.append(
                Scene(
                    name,
                    title,
                    "The chaser's path around the keep-out sphere to the target at the origin, in "
                    "the target's orbital frame.",
                    f"figures/rendezvous/{fallback}",
                    "m",
                    [track],
                    [zone],
                )
            )
    return found
