"""Proofs of the slips in chapters 4 and 5, from what the document itself prints elsewhere."""

from pathlib import Path

from smallsat.config import Config
from smallsat.evidence.errata import Proof
from smallsat.rendezvous.sensitivity_claims import DELTA_V, Sweep, studies
from smallsat.results import read_table

# Legend of Figure 4.7, and upper end of its axis of control intervals in Figure 4.10(b).
LEGEND_FIGURE_4_7_S = (10.0, 15.0, 20.0, 25.0, 30.0)
INTERVALS_FIGURE_4_10 = 300
CAPTION_FIGURE_4_12 = 30
PRINTED_TEXT_HORIZONS = (5, 12)
SLIPPED_SAMPLE_TIME_S = 60.0


def sample_time_subscript(config: Config, results: Path) -> Proof:
    """Which phase was tested with the sample time."""
    rendezvous = studies(config)["rendezvous"]["sample_times_s"]
    approach = studies(config)["approach"]["sample_times_s"]
    tested = [
        name
        for name, times in (("Ts,1", rendezvous), ("Ts,2", approach))
        if SLIPPED_SAMPLE_TIME_S in times
    ]
    return Proof(
        tested == ["Ts,1"],
        f"Ts,2 of {_list(approach)} s",
        f"Ts,1 of {_list(rendezvous)} s",
        f"{SLIPPED_SAMPLE_TIME_S:g} s is among the tested values of {' and '.join(tested)} only",
    )


def approach_figures_swapped(config: Config, results: Path) -> Proof:
    """Whose legend lacks the sample time that is infeasible with the shortest horizon."""
    sweep = Sweep(config, results, "approach")
    tested, horizon = sweep.sample_times, sweep.horizons[0]
    missing = [t for t in tested if t not in LEGEND_FIGURE_4_7_S]
    return Proof(
        missing == tested[:1],
        f"Figure 4.7 would show a longer horizon, for which {tested[0]:g} s is feasible",
        f"Figure 4.7 shows N2 = {horizon}",
        f"the legend of Figure 4.7 lacks {_list(missing)} s, which Section 4.3 calls infeasible at "
        f"N2 = {horizon}, and its caption names that horizon",
    )


def docking_horizons(config: Config, results: Path) -> Proof:
    """The horizon of a caption that the text does not list."""
    return Proof(
        CAPTION_FIGURE_4_12 not in PRINTED_TEXT_HORIZONS,
        f"no figure for N3 = {CAPTION_FIGURE_4_12}",
        f"a figure for each of N3 = {_list(studies(config)['docking']['horizons'])}",
        f"the caption of Figure 4.12 has N3 = {CAPTION_FIGURE_4_12}, which Section 4.4 does not "
        f"list and Section 6.2 benchmarks",
    )


def docking_axis_label(config: Config, results: Path) -> Proof:
    """Numbers of actuations that the axis must show, in either phase."""
    approach, docking = (Sweep(config, results, name) for name in ("approach", "docking"))
    most = {
        sweep.phase: max(
            sweep.values("steps", (sweep.horizons[0], t))[0].max(initial=0)
            for t in sweep.sample_times
        )
        for sweep in (approach, docking)
    }
    largest = sweep_largest(approach)
    return Proof(
        bool(abs(most["docking"] - INTERVALS_FIGURE_4_10) < abs(
            most["approach"] - INTERVALS_FIGURE_4_10
        ) and largest > 0.35),
        f"approach: up to {most['approach']:.0f} intervals and {largest:.1f} m/s",
        f"docking: up to {most['docking']:.0f} intervals",
        f"the axes reach {INTERVALS_FIGURE_4_10} intervals and fractions of a metre per second, as "
        f"the docking phase does and the approach phase does not",
    )  # fmt: skip


def sweep_largest(sweep: Sweep) -> float:
    """Largest delta-v of a sweep's shortest horizon, m/s."""
    return max(
        float(sweep.values(DELTA_V, (sweep.horizons[0], t))[0].max(initial=0.0))
        for t in sweep.sample_times
    )


def appendix_caption(config: Config, results: Path) -> Proof:
    """The variants that the two sections of the appendix are about."""
    cases = set(read_table(results / "studies/domain.parquet")["case"])
    both = {"no set point", "LP"} <= cases
    return Proof(
        both,
        "two figures of the LP, one in each section, and none of the QP without set point",
        "one figure of each variant",
        "Sections A.1 and A.2 have three figures each, of the same kinds in the same order; the "
        "third of both is captioned LP",
    )


def _list(values) -> str:
    return ", ".join(f"{value:g}" for value in values)
