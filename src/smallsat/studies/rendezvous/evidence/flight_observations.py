"""What is computed for the printed times of chapters 6 and 7: bounds, in ms, at a stated clock."""

from collections.abc import Iterator

from smallsat.evidence.grounds import Grounds
from smallsat.evidence.observation import Observation
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.flight_claims import SECOND_MS
from smallsat.studies.rendezvous.flight_computer.printed_times import PRINTED, printed_averages
from smallsat.studies.rendezvous.flight_computer.sweeps import swept
from smallsat.studies.rendezvous.guidance.law import PHASES

SOLVER, PROCESSOR = "generated", "Cortex-A8"


def flight_observations(grounds: Grounds[Configuration]) -> Iterator[Observation]:
    """The most that the mean solve takes, of each printed average; and the worst of all solves.

    Of the solver that stands for the document's, on the slower of its processors.
    """
    table = grounds.rows("flight/cycles.csv", solver=SOLVER, processor=PROCESSOR)
    run = f"{SOLVER}, {PROCESSOR}, {grounds.section.flight_computer.clock_MHz:g} MHz, at most"
    for phase in PHASES:
        own = swept(table[table["solve"] == "mean"], phase, "horizon").set_index("horizon")
        for horizon in printed_averages(grounds.ledger, phase):
            name = f"rendezvous/{PRINTED[phase]}-{horizon}"
            yield Observation(name, float(own["ms_high"][horizon]), run)
    worst = table[table["phase"] != PHASES[2]]["ms_high"].max() / SECOND_MS
    yield Observation("rendezvous/chapter-7/computation-time-bound/both-phases", worst, run)
    far = table[table["phase"] == PHASES[0]]["ms_high"].max() / SECOND_MS
    yield Observation("rendezvous/section-6-1-1/computation-time-bound/rendezvous", far, run)
