"""What this study computes for every published result, in the printed units."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.observation import Observation
from smallsat.studies.racing.methods.races import ANYWHERE, GREEDY, LISTING, WHOLE

# The runs that a printed value is compared with; the last one is shown.
SHOWN = (LISTING, GREEDY, WHOLE, ANYWHERE)
TABLES = {"scenario-1": "table-2", "scenario-2": "table-4"}
QUANTITIES = {
    "final-overall-cost": "cost",
    "time-taken-to-complete-course": "time_s",
    "ring-accuracy": "accuracy_m",
    "minimum-possible-cost": "minimum_cost_s",
}
MICRO, MILLI = 1e-6, 1e-3


def observations(races: pd.DataFrame, ledger: Ledger) -> list[Observation]:
    """All observations, from the table of races and what Section V starts from."""
    return [*_races(races), *_section_v(ledger)]


def _races(races: pd.DataFrame) -> Iterator[Observation]:
    for solution in SHOWN:
        for row in races[races["solution"] == solution].to_dict("records"):
            where = f"racing/{TABLES[row['scenario']]}"
            case = f"{row['scenario']}-{row['cubesat'].lower()}"
            for quantity, column in QUANTITIES.items():
                converged = row["not_converged"] == 0
                # What the document's own method leaves unsolved is a result all the same.
                missing = "" if solution == LISTING else "not converged: "
                yield Observation(
                    f"{where}/{quantity}/{case}",
                    row[column],
                    run=solution,
                    residual=row["residual"] if converged else float("nan"),
                    note=""
                    if converged
                    else f"{missing}{row['not_converged']} segments did not converge",
                )


def _section_v(ledger: Ledger) -> Iterator[Observation]:
    """Accelerations by commercial thrusters, and how far they are below the document's own."""
    mass = ledger.value("section-v/mass-of-a-standard-1u-cubesat").value
    for name in ("min", "max"):
        thrust = ledger.value(f"section-v/thrust-of-commercial-cubesat-thrusters/cited-3/{name}")
        acceleration = MICRO * thrust.value / mass
        where = "racing/section-v/equivalent-acceleration-of-commercial-thrusters/1-kg-1u"
        yield Observation(f"{where}/{name}", acceleration / MILLI)
    largest = ledger.value("section-v/accelerations-used-in-this-project/max").value
    yield Observation(
        "racing/section-v/factor-by-which-commercial-thrust-is-below-this-project",
        largest / acceleration,
    )


def timings(results: Path) -> pd.DataFrame:
    """Our seconds beside the printed estimates of a new course: all four CubeSats of Scenario 2."""
    kinds = {"max": ("listing", LISTING), "min": ("optima", WHOLE)}
    rows = []
    for bound, (stem, solution) in kinds.items():
        table = pd.read_csv(results / f"{stem}-scenario-2-seconds.csv")
        seconds = table.loc[table["solution"] == solution, "seconds"].sum()
        name = f"racing/listing-c-b-finalprojectmain-m/menu-estimate-of-run-time/{bound}"
        rows.append({"id": name, "seconds": seconds})
    return pd.DataFrame(rows)
