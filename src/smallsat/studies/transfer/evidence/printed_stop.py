"""The experiment behind an inference: runs stopped at the printed tolerance beside Table 4."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.statistics.random_streams import stream
from smallsat.studies.transfer.evidence.printed_cases import printed_cases

SHUFFLES = 20000


@dataclass(frozen=True)
class ChanceOfHits:
    """How many final times equal the printed ones, and how many would by chance.

    Attributes
    ----------
    hits
        Cases whose final time equals the printed one to its last digit.
    mean, most
        Of the same count, when the printed times of each number of intervals are dealt to the
        degrees at random.
    share
        Of the random deals that reach as many hits.
    """

    hits: int
    mean: float
    most: int
    share: float


def printed_stop_table(cases: pd.DataFrame, paths: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Compare as-published runs, where the printed tolerance stops them, with Table 4.

    Parameters
    ----------
    cases, paths
        As-published cases and their iterates.
    ledger
        The document's printed numbers.

    Returns
    -------
    DataFrame
        One row a case of Table 4: degree, intervals, iterations, optimality (of the last iterate),
        final_time (not a number where the run did not converge), printed, printed_iterations,
        half_unit of the last printed digit, equal_to_printed.
    """
    keys = ["degree", "intervals"]
    printed = printed_cases(ledger, "Table 4").droplevel("method")
    printed = printed[["terminal time", "iterations"]]
    printed.columns = ["printed", "printed_iterations"]
    units = printed_cases(ledger, "Table 4", "half_unit").droplevel("method")
    printed["half_unit"] = units["terminal time"]
    last = paths.groupby(keys)["optimality"].last().reset_index()
    rows = cases[cases["intervals"] > 1][[*keys, "iterations", "final_time"]]
    table = rows.merge(last, on=keys, how="left").merge(printed.reset_index(), on=keys)
    table["equal_to_printed"] = _equal(table["final_time"], table["printed"], table["half_unit"])
    return table.sort_values(keys, ignore_index=True)


def chance_of_hits(table: pd.DataFrame, seed: int) -> ChanceOfHits:
    """Permutation test of the hits in a table of `printed_stop_table`.

    Only times of the same number of intervals change places: those of different numbers are too
    far apart to hit by chance, and would make the test too easy.
    """
    counts = np.zeros(SHUFFLES)
    for intervals, group in table.groupby("intervals"):
        random = stream(seed, int(str(intervals)))
        dealt = random.permuted(np.tile(group["printed"], (SHUFFLES, 1)), axis=1)
        half_unit = group["half_unit"].to_numpy()
        counts += _equal(group["final_time"].to_numpy(), dealt, half_unit).sum(axis=1)
    hits = int(table["equal_to_printed"].sum())
    return ChanceOfHits(
        hits, float(counts.mean()), int(counts.max()), float((counts >= hits).mean())
    )


def _equal(found, printed, half_unit):
    # The guard is for rounding only, as where single values are matched.
    return np.abs(found - printed) <= half_unit + 1e-11
