"""Proofs of the slips of chapter 6: the document contradicts itself, nothing is computed."""

from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.evidence.monte_carlo_errata import BY_ITSELF
from smallsat.studies.rendezvous.flight_computer.printed_times import printed_averages
from smallsat.studies.rendezvous.guidance.law import PHASES

MID = PHASES[1]


def approach_nearly_double(grounds: Grounds) -> Proof:
    """The least ratio that the printed averages of the two longer horizons can have."""
    _, short, longer = printed_averages(grounds.ledger, MID).values()
    least = (longer.value - longer.half_unit) / (short.value + short.half_unit)
    factor = longer.value / short.value
    return Proof(
        least > 2.0,
        "a factor below two",
        f"a factor of {factor:.2f}",
        f"the averages are {short.value:g} and {longer.value:g} ms, a factor of {factor:.3f}, "
        f"whatever their rounding: {BY_ITSELF}",
    )


def approach_horizons(grounds: Grounds) -> Proof:
    """The horizons that are said to be tested against those whose averages are printed."""
    name = "section-6-1-2/approach-horizons-n2-tested-stated/item"
    stated = [int(grounds.ledger.value(f"{name}-{item}").value) for item in (1, 2, 3)]
    reported = list(printed_averages(grounds.ledger, MID))

    def listed(horizons: list[int]) -> str:
        return f"N2 = {', '.join(map(str, horizons))}"

    return Proof(
        stated != reported,
        f"averages for {listed(stated)}",
        f"averages for {listed(reported)}",
        f"averages are printed for {listed(reported)}: {BY_ITSELF}",
        listed(reported),
    )
