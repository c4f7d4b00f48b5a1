"""The average computation times that chapter 6 prints."""

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.printed import Printed
from smallsat.studies.rendezvous.guidance.law import PHASES

# Where each phase's averages stand; an id ends with the horizon.
PRINTED = {
    PHASES[0]: "section-6-1-1/average-computation-time/rendezvous-n1",
    PHASES[1]: "section-6-1-2/average-computation-time/approach-n2",
    PHASES[2]: "section-6-2/average-computation-time/docking-n3",
}


def printed_averages(ledger: Ledger, phase: str) -> dict[int, Printed]:
    """The printed average computation times, ms, by horizon."""
    found = (row["id"].partition("/")[2].rpartition("-") for row in ledger.rows)
    return {
        int(horizon): ledger.value(f"{place}-{horizon}")
        for place, _, horizon in found
        if place == PRINTED[phase]
    }
