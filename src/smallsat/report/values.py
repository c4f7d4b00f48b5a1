"""Tables of published values beside ours, with repeated remarks gathered below the table."""

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import count, product
from math import isfinite, nan
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import pandas as pd

from smallsat.report.number import computed_text, difference_text, significant_text
from smallsat.results import read_table

Content = dict[str, Any]
# Said once, where the report explains its verdicts.
OBVIOUS = ("equal to the printed digits",)
# How a surpassing value says how well it meets its constraints.
RESIDUAL = re.compile(r"constraints met to (\d\S*)")
# Seconds vary from run to run, so more digits would say nothing.
TIMING_DIGITS = 3


# Columns of verdicts, errata and claims that are no text.
NUMBERS = ("computed", "difference", "tolerance", "holds")


def read_findings(path: Path) -> pd.DataFrame:
    """Verdicts, errata or claims, with every literal as printed: ``0.75550`` keeps its zeros."""
    table = read_table(path)
    text = pd.read_csv(path, dtype=str, keep_default_na=False)
    return table.assign(**{name: text[name] for name in text.columns if name not in NUMBERS})


def of_table(verdicts: pd.DataFrame, table: str) -> pd.DataFrame:
    """Rows of one printed table: located there, or in a part of it such as its footnote.

    Parameters
    ----------
    verdicts
        Verdicts of one document.
    table
        Its name in the document, such as ``Table 1``.
    """
    locators = verdicts["locator"]
    return verdicts[(locators == table) | locators.str.startswith(f"{table} ")]


def value_table(verdicts: pd.DataFrame) -> Content:
    """Texts of a table: printed, computed, difference and verdict, remarks as lettered notes.

    A case or a unit that all rows share is given once, for the whole table.
    """
    letters: dict[str, str] = {}
    names = _letters()
    rows = []
    remarks = _without_own_residuals(str(reason) for reason in verdicts["reason"])
    for row, reason in zip(records(verdicts), remarks, strict=True):
        if reason in OBVIOUS:
            letter = ""
        else:
            letter = letters[reason] if reason in letters else next(names)
            letters[reason] = letter
        quantity = ", ".join(str(row[key]) for key in ("quantity", "component") if row[key])
        rows.append({**value_texts(row), "quantity": quantity, "note": letter})
    shared = {"case": _common_words(rows, "case"), "unit": _common(rows, "unit")}
    return {
        "rows": rows,
        "shared": {key: value for key, value in shared.items() if value},
        "notes": [{"letter": letter, "text": reason} for reason, letter in letters.items()],
    }


def value_texts(row: Mapping[str, Any]) -> dict[str, str]:
    """One row of the verdicts as text; ``seconds``, where ours were measured, is the value."""
    printed = str(row["printed"])
    seconds = row.get("seconds", nan)
    return {
        "case": str(row["case"]),
        "printed": printed,
        "computed": significant_text(seconds, TIMING_DIGITS)
        if isfinite(seconds)
        else computed_text(row["computed"], printed),
        "difference": difference_text(row["difference"], row["computed"]),
        "unit": str(row["unit"]),
        "verdict": str(row["verdict"]),
    }


def records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of a table."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def _without_own_residuals(reasons: Iterable[str]) -> list[str]:
    """The same remarks, with one bound for the residuals of those that differ in nothing else."""
    reasons = list(reasons)
    largest: dict[str, set[str]] = {}
    for reason in reasons:
        for residual in RESIDUAL.findall(reason):
            largest.setdefault(RESIDUAL.sub("", reason), set()).add(residual)

    def remark(reason: str) -> str:
        residuals = largest.get(RESIDUAL.sub("", reason), set())
        if len(residuals) < 2:
            return reason
        return RESIDUAL.sub(f"constraints met to {max(residuals, key=float)} or better", reason)

    return [remark(reason) for reason in reasons]


def _letters() -> Iterator[str]:
    for length in count(1):
        yield from ("".join(letters) for letters in product(ascii_lowercase, repeat=length))


def _common(rows: list[dict[str, str]], key: str) -> str:
    """The text that all rows share, taken out of them."""
    texts = {row[key] for row in rows}
    if len(texts) != 1:
        return ""
    for row in rows:
        row[key] = ""
    return texts.pop()


def _common_words(rows: list[dict[str, str]], key: str) -> str:
    """The words with which all rows begin, taken out of them; each row keeps one word at least."""
    if len({row[key] for row in rows}) == 1:
        return _common(rows, key)
    words = [row[key].split() for row in rows]
    shortest = min(len(text) for text in words) - 1
    same = next((n for n in range(shortest) if len({text[n] for text in words}) > 1), shortest)
    for row, text in zip(rows, words, strict=True):
        row[key] = " ".join(text[max(same, 0) :])
    return " ".join(words[0][: max(same, 0)])
