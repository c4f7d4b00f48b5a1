"""Proofs of the slips in chapters 4 and 5.

Some are contradictions of the document with itself: those are read off the ledger, and say so. The
others are decided by what the manoeuvres of our studies do, and could come out otherwise.
"""

import numpy as np

from smallsat.dynamics.units import MINUTE
from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.evidence.monte_carlo_observations import DOCKING_TICKS
from smallsat.studies.rendezvous.evidence.sensitivity_claims import SIMILAR
from smallsat.studies.rendezvous.evidence.sweeps import (
    DELTA_V,
    STEPS,
    TIME,
    Sweep,
    infeasible_share,
)
from smallsat.studies.rendezvous.monte_carlo.cases import LP, NO_SET_POINT
from smallsat.studies.rendezvous.monte_carlo.tables import totals

BY_ITSELF = "the document contradicts itself; nothing is computed"
SMALL_SAVING = "section-4-2/interval-with-small-delta-v-difference/diminishing-returns/second"
TIMES = "x-axis-tick-range-maneuver-time-min"
INTERVALS = "number-of-control-intervals-label-printed-approach"


def sample_time_subscript(grounds: Grounds) -> Proof:
    """Which phase was tested with the sample time, by the document's own lists."""
    slipped = grounds.ledger.value(SMALL_SAVING).value
    lists = {
        "Ts,1": _values(grounds, "section-4-2/rendezvous-sample-times-tested"),
        "Ts,2": _values(grounds, "section-4-3/approach-sample-times-tested"),
    }
    tested = [name for name, times in lists.items() if slipped in times]
    return Proof(
        tested == ["Ts,1"],
        f"Ts,2 of {_list(lists['Ts,2'])} s",
        f"Ts,1 of {_list(lists['Ts,1'])} s",
        f"{slipped:g} s is printed among the tested values of {' and '.join(tested)} only: "
        f"{BY_ITSELF}",
        f"{' and '.join(tested)} = {slipped:g} s",
    )


def approach_figures_swapped(grounds: Grounds) -> Proof:
    """Which horizon makes the sample time infeasible that the legend of Figure 4.7 lacks."""
    legend = _values(grounds, "figure-4-7-a/legend-ts2/n2-5")
    times = _values(grounds, "section-4-3/approach-sample-times-tested")
    missing = [t for t in times if t not in legend]
    called_infeasible = grounds.ledger.value("section-4-3/infeasible-sample-time/n2-5").value
    sweep = Sweep(grounds, "approach")
    shares = {
        n: float(infeasible_share(sweep.rows(n, called_infeasible), "approach").mean())
        for n in sweep.horizons[:2]
    }
    short, longer = shares
    return Proof(
        missing == [called_infeasible] and shares[longer] < 0.5 * shares[short],
        f"Figure 4.7 would show N2 = {longer}, at which {100 * shares[longer]:.0f} % of our "
        f"approaches with {called_infeasible:g} s meet an infeasible program",
        f"Figure 4.7 shows N2 = {short}, at which {100 * shares[short]:.0f} % do",
        f"of the tested sample times the legend of Figure 4.7 lacks {_list(missing)} s alone, "
        f"which Section 4.3 calls infeasible at N2 = {short}; in our runs too that horizon is the "
        f"one at which it is",
    )


def docking_horizons(grounds: Grounds) -> Proof:
    """The horizon of a caption, in the text's list and in that of Section 6.2."""
    caption = grounds.ledger.value("figure-4-12-caption/docking-prediction-horizon-n3").value
    text = _values(grounds, "section-4-4/docking-prediction-horizons-n3-tested")
    later = _values(grounds, "section-6-2/docking-horizons-n3-benchmarked")
    return Proof(
        caption not in text and caption in later,
        f"no figure for N3 = {caption:g}",
        f"a figure for each of N3 = {_list(later)}",
        f"the caption of Figure 4.12 has N3 = {caption:g}, which Section 4.4 does not list and "
        f"Section 6.2 does: {BY_ITSELF}",
        f"N3 = {_list(later)}",
    )


def docking_axis_label(grounds: Grounds) -> Proof:
    """The time of the most intervals that the axis shows, against the printed axes of time.

    An automatic axis shows more than its last tick but one.
    """
    end = grounds.ledger.value(f"figure-4-10-b/x-axis-tick-range-{INTERVALS}/n3-5/max").value
    intervals = end - DOCKING_TICKS[STEPS]
    filled, shown = {}, {}
    for phase, tested, axis in (
        ("approach", "section-4-3/approach-sample-times-tested", "figure-4-7-a/{}/n2-5/max"),
        ("docking", "section-4-4/docking-sample-times-tested", "figure-4-10-a/{}/n3-5/max"),
    ):
        filled[phase] = min(_values(grounds, tested)) * intervals / MINUTE
        shown[phase] = grounds.ledger.value(axis.format(TIMES)).value
    return Proof(
        filled["docking"] <= shown["docking"] and filled["approach"] > shown["approach"],
        f"approach: {intervals:g} intervals last {filled['approach']:.3g} min or longer, and the "
        f"axis of its times ends at {shown['approach']:g} min",
        f"docking: {filled['docking']:.3g} min or longer, on an axis to {shown['docking']:g} min",
        f"an axis to {end:g} intervals shows more than {intervals:g}; of the phases' shortest "
        f"tested sample times only that of the docking phase fits them into the printed axis of "
        f"its times: {BY_ITSELF}",
    )


def appendix_caption(grounds: Grounds) -> Proof:
    """Two figures of one caption in sections of two variants, and whether these look alike."""
    same = grounds.captions["Figure A.3"] == grounds.captions["Figure A.6"]
    one, other = (
        grounds.rows("studies/domain.parquet", case=case, completed=True).set_index("sample")
        for case in (NO_SET_POINT, LP)
    )
    both = one.index.intersection(other.index)
    if both.empty:
        raise LookupError(f"manoeuvres that end with {NO_SET_POINT} and with {LP}")
    ratio = {
        quantity: float(
            np.median(totals(one.loc[both], quantity) / totals(other.loc[both], quantity))
        )
        for quantity in (DELTA_V, TIME)
    }
    return Proof(
        same and max(abs(r - 1.0) for r in ratio.values()) > SIMILAR,
        "two figures of the LP, one in each section, and none of the QP without set point",
        "one figure of each variant",
        f"Figures A.3 and A.6, in the sections of the two variants, have one caption. In our runs "
        f"the QP without set point takes {ratio[TIME]:.2f} times the time and "
        f"{ratio[DELTA_V]:.2f} times the delta-v of the LP in the median of {len(both)} initial "
        f"states that end with both, so that one figure cannot stand for both",
    )


def _values(grounds: Grounds, place: str) -> list[float]:
    return [one.value for one in grounds.ledger.values(place)]


def _list(values: list[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def docking_recommendation(grounds: Grounds) -> Proof:
    """Section 4.4: the recommended sample times against the longest tested one."""
    tested = _values(grounds, "section-4-4/docking-sample-times-tested")
    least, most = (
        grounds.ledger.value(f"section-4-4/recommended-docking-sample-time/{end}").value
        for end in ("min", "max")
    )
    return Proof(
        max(tested) > most,
        f"{least:g} to {most:g} s, to minimise delta-v",
        f"{max(tested):g} s, by the sentences before",
        f"the same section says that the smallest and the largest delta-v decrease with longer "
        f"sample times, of which {max(tested):g} s is the longest tested: {BY_ITSELF}",
    )
