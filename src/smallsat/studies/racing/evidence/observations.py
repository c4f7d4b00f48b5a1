"""What this study computes for every published result, in the printed units."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from smallsat.evidence.observation import Observation
from smallsat.studies.racing.methods.races import ANYWHERE, AS_PUBLISHED, GREEDY, WHOLE

# The runs that a printed value is compared with; the last one is shown.
SHOWN = (AS_PUBLISHED, GREEDY, WHOLE, ANYWHERE)
TABLES = {"scenario-1": "table-2", "scenario-2": "table-4"}
QUANTITIES = {
    "final-overall-cost": "cost",
    "time-taken-to-complete-course": "time_s",
    "ring-accuracy": "accuracy_m",
    "minimum-possible-cost": "minimum_cost_s",
}
# Section V: thrusts of commercial thrusters, N, and the mass of a CubeSat, kg.
THRUSTERS_N, MASS_KG = {"min": 10e-6, "max": 500e-6}, 1.0
MILLI = 1e-3
# Largest acceleration of the document's CubeSats, m/s^2.
LARGEST = 0.5


def observations(races: pd.DataFrame) -> list[Observation]:
    """All observations, from the table of races."""
    return [*_races(races), *_section_v()]


def _races(races: pd.DataFrame) -> Iterator[Observation]:
    for solution in SHOWN:
        for row in races[races["solution"] == solution].to_dict("records"):
            where = f"racing/{TABLES[row['scenario']]}"
            case = f"{row['scenario']}-{row['cubesat'].lower()}"
            for quantity, column in QUANTITIES.items():
                converged = row["not_converged"] == 0
                # What the document's own method leaves unsolved is a result all the same.
                missing = "" if solution == AS_PUBLISHED else "not converged: "
                yield Observation(
                    f"{where}/{quantity}/{case}",
                    row[column],
                    run=solution,
                    residual=row["residual"] if converged else float("nan"),
                    note=""
                    if converged
                    else f"{missing}{row['not_converged']} segments did not converge",
                )


def _section_v() -> Iterator[Observation]:
    where = "racing/section-v/equivalent-acceleration-of-commercial-thrusters/1-kg-1u"
    for name, thrust in THRUSTERS_N.items():
        yield Observation(f"{where}/{name}", thrust / MASS_KG / MILLI)
    yield Observation(
        "racing/section-v/factor-by-which-commercial-thrust-is-below-this-project",
        LARGEST / (THRUSTERS_N["max"] / MASS_KG),
    )


def timings(results: Path) -> pd.DataFrame:
    """Our seconds beside the printed estimates of a new course: all four CubeSats of Scenario 2."""
    kinds = {"max": ("as-published", AS_PUBLISHED), "min": ("optima", WHOLE)}
    rows = []
    for bound, (stem, solution) in kinds.items():
        table = pd.read_csv(results / f"{stem}-scenario-2-seconds.csv")
        seconds = table.loc[table["solution"] == solution, "seconds"].sum()
        name = f"racing/listing-c-b-finalprojectmain-m/menu-estimate-of-run-time/{bound}"
        rows.append({"id": name, "seconds": seconds})
    return pd.DataFrame(rows)
