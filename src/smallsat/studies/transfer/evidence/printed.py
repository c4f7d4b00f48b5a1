"""The document's own numbers, as its tables and prose print them, for errata and claims."""

from functools import cache
from pathlib import Path

import pandas as pd

from smallsat.config import Config
from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.printed import parse_printed
from smallsat.studies.transfer.results import parse_case

LEDGER = Path(__file__).parents[5] / "data/published/transfer/values.csv"


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


def contradictions(place: str, other: str, renamed: dict[str, str]) -> pd.DataFrame:
    """Cases that two places of the document print differently, beyond rounding and cutting off.

    Parameters
    ----------
    place, other
        Locators, such as ``Section 3.4`` and ``Table 4``.
    renamed
        Quantities of ``place`` that ``other`` calls by another name.

    Returns
    -------
    DataFrame
        Columns case, quantity, and one for each place with the literal as printed.
    """
    literals = {
        (row["locator"], row["case"], row["quantity"]): row["printed"]
        for row in _ledger()
        if row["document"] == "transfer"
    }
    rows = []
    for (locator, case, quantity), literal in literals.items():
        twin = literals.get((other, case, renamed.get(quantity, quantity)))
        if locator != place or twin is None:
            continue
        here, there = parse_printed(literal), parse_printed(twin)
        assert here and there, (literal, twin)
        unit = 2 * max(here.half_unit, there.half_unit)
        # The guard keeps a difference of exactly one unit from counting.
        if abs(here.value - there.value) > 1.000001 * unit:
            rows.append({"case": case, "quantity": quantity, place: literal, other: twin})
    return pd.DataFrame(rows, columns=["case", "quantity", place, other])


def mass_from_time(final_time: float, config: Config, exhaust_speed: float | None = None) -> float:
    """Final mass that a final time implies (equation 27), for any exhaust speed."""
    problem = config["transfer"]["problem"]
    speed = exhaust_speed or problem["exhaust_speed"]
    return problem["initial_mass"] - problem["thrust"] / speed * final_time
