"""Who won, by how much, and who missed which ring: tables for a reader."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.racing.evidence.observations import QUANTITIES, TABLES
from smallsat.studies.racing.methods.races import LISTING, SOLUTIONS

CUBESATS = ("Eeny", "Meeny", "Miny", "Mo")
SCENARIO_NAMES = {"scenario-1": "Scenario 1", "scenario-2": "Scenario 2"}


def printed_scores(ledger: Ledger) -> pd.DataFrame:
    """The printed scores of both races, Tables 2 and 4, in the columns of the races."""
    return pd.DataFrame(
        [
            {"scenario": scenario, "cubesat": cubesat, "solution": "printed"}
            | {
                column: ledger.value(f"{table}/{quantity}/{scenario}-{cubesat.lower()}").value
                for quantity, column in QUANTITIES.items()
            }
            for scenario, table in TABLES.items()
            for cubesat in CUBESATS
        ]
    )


def score_table(races: pd.DataFrame, printed: pd.DataFrame) -> pd.DataFrame:
    """Every score by race and solution: place, cost, how far behind the winner, rings missed.

    ``races`` are ours and ``printed`` the document's (`printed_scores`). Solutions that did not
    converge somewhere say where; they take part all the same.
    """
    kept = ["scenario", "cubesat", "solution", "cost", "time_s", "accuracy_m", "missed"]
    columns = [*kept, "off_axis", "not_converged", "segments"]
    table = pd.concat([printed[kept[:-1]], races[columns]], ignore_index=True)
    order = {name: place for place, name in enumerate(("printed", *SOLUTIONS))}
    table["order"] = table["solution"].map(order)
    group = table.groupby(["scenario", "solution"])["cost"]
    table["behind"] = table["cost"] - group.transform("min")
    # Who has no score has no place.
    table["place"] = group.rank().astype("Int64")
    table = table.sort_values(["scenario", "order", "place"], ignore_index=True)
    # What the document does not say of its rings stays open.
    for name in ("missed", "off_axis", "not_converged"):
        known = table[name].notna()
        table[name] = [f"{v:.0f}" if ok else "" for v, ok in zip(table[name], known, strict=True)]
    return table[[*kept, "behind", "place", "off_axis", "not_converged"]]


def missed_table(rings: pd.DataFrame) -> pd.DataFrame:
    """The rings that each CubeSat missed, by number, for every kind of solution."""
    rows = []
    groups = rings.groupby(["scenario", "solution", "cubesat"], sort=False)
    for (scenario, solution, cubesat), crossed in groups:
        missed = crossed.loc[crossed["missed"], "ring"]
        off = crossed.loc[crossed["off_axis"] & ~crossed["missed"], "ring"]
        rows.append(
            {
                "race": SCENARIO_NAMES[str(scenario)],
                "solution": solution,
                "cubesat": cubesat,
                "missed": ", ".join(map(str, missed)) or "none",
                "inside_but_off_the_normal": ", ".join(map(str, off)) or "none",
                "largest_miss_m": crossed["miss_m"].max(),
            }
        )
    return pd.DataFrame(rows)


def nearness_table(races: pd.DataFrame, printed: pd.DataFrame) -> pd.DataFrame:
    """How near our solve of the listing comes to each printed time, cost, miss and minimum cost.

    One row a race and CubeSat with both numbers of each quantity, and ours over the printed one.
    """
    ours = races[races["solution"] == LISTING].set_index(["scenario", "cubesat"])
    theirs = printed.set_index(["scenario", "cubesat"])
    table = pd.DataFrame(
        {"race": [SCENARIO_NAMES[scenario] for scenario, _ in theirs.index]}, index=theirs.index
    )
    for column in QUANTITIES.values():
        table[f"{column}, printed"] = theirs[column]
        table[f"{column}, ours"] = ours[column]
        table[f"{column}, ratio"] = ours[column] / theirs[column]
    table["not_converged"] = ours["not_converged"]
    table["segments"] = ours["segments"]
    return table.reset_index("cubesat").reset_index(drop=True)
