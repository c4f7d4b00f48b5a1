"""The document's own numbers of Section 3.6, as its tables print them."""

from functools import cache
from pathlib import Path

import pandas as pd

from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.printed import parse_printed
from smallsat.studies.rendezvous.guidance.law import PHASES

PUBLISHED = Path(__file__).parents[5] / "data/published/rendezvous"
LEDGER, ARTEFACTS = PUBLISHED / "values.csv", PUBLISHED / "artefacts.csv"
# Case of ours: where the document prints it, and what its rows are called there.
CASE_TABLES = {
    "v-bar": ("table-3-3", "case-1-v-bar"),
    "r-bar": ("table-3-4", "case-2-r-bar"),
    "rotating": ("table-3-5", "case-3-rotating-target"),
}
PHASE_NAMES = {"far": "far-range", "mid": "mid-range", "final": "final-approach"}
TOTAL = "total"
# Table 3.6 has totals, in minutes.
COMPARED = {
    "no-set-point": "qp-without-set-point",
    "v-bar": "qp-with-set-point",
    "lp": "lp",
}
MINUTE = 60.0


@cache
def _values() -> dict[str, tuple[float, float]]:
    rows = [row for row in read_ledger(LEDGER) if row["document"] == "rendezvous"]
    parsed = {row["id"]: parse_printed(row["printed"]) for row in rows}
    return {key: (one.value, one.half_unit) for key, one in parsed.items() if one is not None}


def value(identifier: str) -> float:
    """One printed number by its id, without the document's name."""
    return _values()[f"rendezvous/{identifier}"][0]


def value_list(place: str) -> list[float]:
    """The printed numbers of a list, ``place/item-1`` and so on, in the document's order.

    Raises
    ------
    KeyError
        If the document prints no such list.
    """
    found = [value for key, (value, _) in _values().items()
             if key.startswith(f"rendezvous/{place}/item-")]  # fmt: skip
    if not found:
        raise KeyError(place)
    return found


def cell_id(quantity: str, case: str, phase: str) -> str:
    """Ledger id of a cell of Tables 3.3 to 3.5; the phase may be the total."""
    table, name = CASE_TABLES[case]
    return f"rendezvous/{table}/{quantity}/{name}/{PHASE_NAMES.get(phase, phase)}"


def phase_cells() -> pd.DataFrame:
    """Tables 3.3 to 3.5: ``case``, ``phase`` (and the total), ``delta_v_m_s``, ``time_s``."""
    rows = []
    for case in CASE_TABLES:
        for phase in (*PHASES, TOTAL):
            rows.append(
                {
                    "case": case,
                    "phase": phase,
                    "delta_v_m_s": _values()[cell_id("total-delta-v", case, phase)][0],
                    "time_s": _values()[cell_id("time", case, phase)][0],
                }
            )
    return pd.DataFrame(rows)


def total_cells() -> pd.DataFrame:
    """Table 3.6: ``case``, ``delta_v_m_s``, ``time_min``."""
    rows = []
    for case, name in COMPARED.items():
        rows.append(
            {
                "case": case,
                "delta_v_m_s": value(f"table-3-6/total-delta-v/{name}"),
                "time_min": value(f"table-3-6/time/{name}"),
            }
        )
    return pd.DataFrame(rows)
