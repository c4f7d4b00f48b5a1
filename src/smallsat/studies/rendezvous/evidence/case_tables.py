"""Tables 3.3 to 3.6: which case stands where, and what the document prints of it."""

from collections.abc import Iterable

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.guidance.law import PHASES

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


def cell_id(quantity: str, case: str, phase: str) -> str:
    """Id of a cell of Tables 3.3 to 3.5 in the ledger; the phase may be the total."""
    table, name = CASE_TABLES[case]
    return f"{table}/{quantity}/{name}/{PHASE_NAMES.get(phase, phase)}"


def phase_cells(ledger: Ledger) -> pd.DataFrame:
    """Tables 3.3 to 3.5: ``case``, ``phase`` (and the total), ``delta_v_m_s``, ``time_s``."""
    keys = [(case, phase) for case in CASE_TABLES for phase in (*PHASES, TOTAL)]
    return pd.DataFrame(
        {
            "case": [case for case, _ in keys],
            "phase": [phase for _, phase in keys],
            "delta_v_m_s": _numbers(ledger, (cell_id("total-delta-v", *key) for key in keys)),
            "time_s": _numbers(ledger, (cell_id("time", *key) for key in keys)),
        }
    )


def total_cells(ledger: Ledger) -> pd.DataFrame:
    """Table 3.6: ``case``, ``delta_v_m_s``, ``time_min``."""
    return pd.DataFrame(
        {
            "case": list(COMPARED),
            "delta_v_m_s": _numbers(
                ledger, (f"table-3-6/total-delta-v/{name}" for name in COMPARED.values())
            ),
            "time_min": _numbers(ledger, (f"table-3-6/time/{name}" for name in COMPARED.values())),
        }
    )


def _numbers(ledger: Ledger, identifiers: Iterable[str]) -> list[float]:
    return [ledger.value(identifier).value for identifier in identifiers]
