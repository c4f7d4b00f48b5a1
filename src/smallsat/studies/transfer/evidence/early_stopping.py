"""The experiment behind an inference: early-stopped runs beside the printed times."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.transfer.evidence.printed_cases import printed_cases


def early_stopping_table(cases: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Compare as-published runs at every tolerance with Table 4.

    Parameters
    ----------
    cases
        As-published cases of direct multiple shooting at all tolerances.
    ledger
        The document's printed numbers.

    Returns
    -------
    DataFrame
        One row a case and tolerance: degree, intervals, tolerance, iterations, final_time, printed,
        equal_to_printed (to the last digit), in_printed_band (between the smallest and the largest
        printed final time of the table).
    """
    half_unit = printed_cases(ledger, "Table 4", "half_unit")["terminal time"].max()
    printed = (
        printed_cases(ledger, "Table 4")["terminal time"].droplevel("method").rename("printed")
    )
    rows = cases[(cases["intervals"] > 1) & (cases["run"] == "as published")]
    columns = ["degree", "intervals", "tolerance", "iterations", "final_time"]
    table = rows[columns].merge(printed.reset_index(), on=["degree", "intervals"], how="inner")
    table["equal_to_printed"] = (table["final_time"] - table["printed"]).abs() <= half_unit
    table["in_printed_band"] = table["final_time"].between(
        printed.min() - half_unit, printed.max() + half_unit
    )
    return table.sort_values(columns[:3], ascending=[True, True, False], ignore_index=True)
