"""What the document prints of its cases: by method, degree and number of intervals."""

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.printed import parse_printed
from smallsat.studies.transfer.results import PrintedCase, parse_case


def printed_cases(ledger: Ledger, locator: str, aspect: str = "value") -> pd.DataFrame:
    """Printed numbers of a table or section, one row a case, one column a quantity.

    The index is (method, degree, intervals); the aspect may be ``half_unit`` instead, half a unit
    of the last printed digit.
    """
    keys = ["method", "degree", "intervals"]
    rows = [
        (case.method, case.degree, case.intervals, row["quantity"], getattr(number, aspect))
        for row in ledger.rows
        if row["locator"] == locator
        and (case := parse_case(row["case"]))
        and (number := parse_printed(row["printed"]))
    ]
    table = pd.DataFrame(rows, columns=[*keys, "quantity", "value"])
    return table.pivot(index=keys, columns="quantity", values="value")


def contradictions(ledger: Ledger, place: str, other: str, renamed: dict[str, str]) -> pd.DataFrame:
    """Cases that two places of the document print differently, beyond rounding and cutting off.

    Parameters
    ----------
    ledger
        The document's printed numbers.
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
        (row["locator"], row["case"], row["quantity"]): row["printed"] for row in ledger.rows
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


def printed_time(ledger: Ledger, case: PrintedCase) -> str:
    """Final time of a case as its table prints it; empty where none does."""
    printed = (
        row["printed"]
        for row in ledger.rows
        if row["locator"].startswith("Table ")
        and row["quantity"] == "terminal time"
        and parse_case(row["case"]) == case
    )
    return next(printed, "")
