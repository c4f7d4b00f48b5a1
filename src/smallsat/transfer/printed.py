"""The document's own numbers, as its tables and prose print them, for errata and claims."""

from functools import cache
from pathlib import Path

import pandas as pd

from smallsat.config import Config
from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.printed import parse_printed
from smallsat.transfer.tables import parse_case

LEDGER = Path(__file__).parents[3] / "data/published/values.csv"


@cache
def _ledger() -> list[dict[str, str]]:
    return read_ledger(LEDGER)


def printed_cases(locator: str) -> pd.DataFrame:
    """Printed numbers of a table or section, one row a case, one column a quantity.

    The index is (method, degree, intervals).
    """
    rows = []
    for row in _ledger():
        case = parse_case(row["case"])
        number = parse_printed(row["printed"])
        if row["document"] == "transfer" and row["locator"] == locator and case and number:
            rows.append(
                {
                    "method": case.method,
                    "degree": case.degree,
                    "intervals": case.intervals,
                    "quantity": row["quantity"],
                    "value": number.value,
                }
            )
    table = pd.DataFrame(rows)
    return table.pivot(index=["method", "degree", "intervals"], columns="quantity", values="value")


def printed_value(identifier: str) -> float:
    """One printed number by its id."""
    number = parse_printed(next(row["printed"] for row in _ledger() if row["id"] == identifier))
    assert number is not None, identifier
    return number.value


def mass_from_time(final_time: float, config: Config, exhaust_speed: float | None = None) -> float:
    """Final mass that a final time implies (equation 27), for any exhaust speed."""
    problem = config["transfer"]["problem"]
    speed = exhaust_speed or problem["exhaust_speed"]
    return problem["initial_mass"] - problem["thrust"] / speed * final_time
