"""Proofs of the slips in chapters 4 and 5.

Some are contradictions of the document with itself: those are read off the ledger, and say so. The
others are decided by what the manoeuvres of our studies do, and could come out otherwise.
"""

import numpy as np

from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.evidence.sensitivity_claims import SIMILAR
from smallsat.studies.rendezvous.evidence.sweeps import DELTA_V, TIME, Sweep, infeasible_share
from smallsat.studies.rendezvous.monte_carlo.cases import LP, NO_SET_POINT
from smallsat.studies.rendezvous.monte_carlo.tables import totals

BY_ITSELF = "the document contradicts itself; nothing is computed"
SMALL_SAVING = "section-4-2/interval-with-small-delta-v-difference/diminishing-returns/second"
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
    """Numbers of actuations and delta-v that the axes must show, in either phase."""
    end, delta_v = (
        grounds.ledger.value(f"figure-4-10-b/{axis}/n3-5/max").value
        for axis in (f"x-axis-tick-range-{INTERVALS}", "y-axis-tick-range-docking-delta-v")
    )
    most, largest = {}, {}
    for phase in ("approach", "docking"):
        sweep = Sweep(grounds, phase)
        most[phase] = _largest(sweep, "steps")
        largest[phase] = _largest(sweep, DELTA_V)
    return Proof(
        abs(most["docking"] - end) < abs(most["approach"] - end) and largest["approach"] > delta_v,
        f"approach: up to {most['approach']:.0f} intervals and {largest['approach']:.1f} m/s",
        f"docking: up to {most['docking']:.0f} intervals",
        f"the axes reach {end:.0f} intervals and fractions of a metre per second, as "
        f"the docking phase does and the approach phase does not",
    )


def _largest(sweep: Sweep, quantity: str) -> float:
    """Largest value of a quantity over the cases of a sweep's shortest horizon."""
    return max(
        float(sweep.values(quantity, (sweep.horizons[0], t))[0].max(initial=0.0))
        for t in sweep.sample_times
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
    most = grounds.ledger.value("section-4-4/recommended-docking-sample-time/max").value
    return Proof(
        max(tested) > most,
        f"{_list(tested[1:3])} s, to minimise delta-v",
        f"{max(tested):g} s, by the sentences before",
        f"the same section says that the smallest and the largest delta-v decrease with longer "
        f"sample times, of which {max(tested):g} s is the longest tested: {BY_ITSELF}",
    )
