"""The tables of the races as the predicates of claims take them."""

import numpy as np
import pandas as pd

from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.evidence.scores import CUBESATS, printed_scores
from smallsat.studies.racing.methods.flight import COSTATE

# Changes of a result that a reader would call massive, and none, as shares.
MASSIVE, NOTHING = 0.1, 0.001


def races(grounds: Grounds, solution: str, scenario: str) -> pd.DataFrame:
    """Races of one kind by CubeSat; those without a solution are not among them."""
    rows = grounds.rows("races.csv", solution=solution, scenario=scenario)
    return rows[rows["time_s"].notna()].set_index("cubesat")


def all_races(grounds: Grounds, solution: str, scenario: str) -> pd.DataFrame:
    """`races` for a claim that speaks of all CubeSats; a `LookupError` where one is missing."""
    return races(grounds, solution, scenario).loc[list(CUBESATS)]


def printed(grounds: Grounds, scenario: str) -> pd.DataFrame:
    """The printed scores of a race by CubeSat."""
    table = printed_scores(grounds.ledger)
    return table[table["scenario"] == scenario].set_index("cubesat")


def complete(table: pd.DataFrame, *columns: str) -> pd.DataFrame:
    """The table itself; a `LookupError` where a number in these columns is missing."""
    if table.empty or table[list(columns)].isna().any(axis=None):
        raise LookupError("a case without a solution")
    return table


def solved(table: pd.DataFrame, *columns: str) -> pd.DataFrame:
    """The rows that have these numbers; a `LookupError` where none has."""
    return complete(table[table[list(columns)].notna().all(axis=1)], *columns)


def coarsest_meshes(grounds: Grounds) -> pd.DataFrame:
    """Whole-course optima of all CubeSats on the mesh that everything is solved on."""
    table = complete(grounds.table("meshes.csv"), "time_s")
    return table[table["intervals"] == table["intervals"].min()]


def primer_at_rings(grounds: Grounds, stem: str, solution: str) -> float:
    """Median share of the primer along the normal at the end of Meeny's segments in Scenario 1."""
    name = f"{stem}-scenario-1-trajectories.parquet"
    rows = complete(grounds.rows(name, solution=solution, cubesat="Meeny"), "pvx")
    course = grounds.table("course-scenario-1.csv")
    normals = course[["nx", "ny", "nz"]].to_numpy(dtype=float)[1:-1]
    sizes = np.linalg.norm(rows[COSTATE[3:]], axis=1)
    segments = rows.assign(size=sizes).groupby("segment")
    last = segments.last()[COSTATE[3:]].to_numpy()[: len(normals)]
    largest = segments["size"].max().to_numpy()[: len(normals)]
    return float(np.median(np.abs(np.sum(last * normals, axis=1)) / largest))
