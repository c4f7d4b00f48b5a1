"""Claims and errata of chapter 6, on made-up counts: all hold as the thesis says, and can fail."""

from itertools import product

import numpy as np
import pandas as pd
import pytest

from smallsat.evidence.claims import judge_claims
from smallsat.results import write_table
from smallsat.strict_yaml import read_yaml
from smallsat.studies.rendezvous.evidence import flight_errata
from smallsat.studies.rendezvous.evidence.flight_observations import flight_observations
from smallsat.studies.rendezvous.figures import flight as figures

SOLVERS, PROCESSORS = ("stage-wise", "generated"), ("Cortex-A8", "Cortex-A9")
DEFAULTS = {"far": (30, 30.0), "mid": (15, 20.0), "final": (12, 5.0)}
# Million instructions by phase and horizon, as the printed averages are in ms.
AS_PRINTED = {
    "far": {15: 119.18, 30: 270.40, 45: 863.91},
    "mid": {5: 53.40, 10: 110.0, 15: 181.55, 30: 394.89},
    "final": {5: 9.1, 12: 30.1, 15: 31.0, 30: 98.8},
}
OTHERWISE = {
    "far": {15: 30.0, 30: 20.0, 45: 25.0},
    "mid": {5: 50.0, 10: 40.0, 15: 30.0, 30: 90.0},
    "final": {5: 60.0, 12: 50.0, 15: 95.0, 30: 40.0},
}
# Deviations of the runs' averages, million instructions.
SPREADS = {"far": {15: 20.0, 30: 30.0, 45: 10.0}, "mid": 5.0, "final": 1.0}
OTHER_SPREADS = {"far": {15: 1.0, 30: 0.5, 45: 9.0}, "mid": 20.0, "final": 30.0}


def spread_of(spreads, phase, horizon):
    return spreads[phase][horizon] if isinstance(spreads[phase], dict) else spreads[phase]


def write(folder, means, spreads, ms=100.0, sampled=1.0, **link):
    """Tables with these averages; at other sample times than the default so many times as many."""
    wave = np.linspace(-1.0, 1.0, 8)
    runs, cycles = [], []
    for phase, (horizon, sample_time) in DEFAULTS.items():
        cases = [(n, sample_time, 1.0) for n in means[phase]]
        others = {"far": (45.0, 60.0), "mid": (10.0, 30.0), "final": ()}[phase]
        cases += [(horizon, other, sampled) for other in others]
        for (n, ts, factor), solver, processor in product(cases, SOLVERS, PROCESSORS):
            key = {"processor": processor, "solver": solver, "phase": phase, "horizon": n,
                   "sample_time_s": ts}  # fmt: skip
            deviation = 1.7 * spread_of(spreads, phase, n)
            instructions = 1e6 * factor * (means[phase][n] + deviation * wave)
            runs += [key | {"run": k, "instructions": v} for k, v in enumerate(instructions)]
            bounds = {"ms_low": 0.1 * ms, "ms_high": ms}
            cycles += [key | bounds | {"solve": solve} for solve in ("mean", "most")]
    write_table(pd.DataFrame(runs), folder / "flight/runs.csv")
    write_table(pd.DataFrame(cycles), folder / "flight/cycles.csv")
    row = {"processor": "Cortex-A8", "steps": 100, "native_steps": 100, "docked": True,
           "position_m": 1e-5, "tolerance_m": 0.01}  # fmt: skip
    write_table(pd.DataFrame([row | link]), folder / "flight/link.csv")


@pytest.fixture
def judge(root, section, tmp_path, grounds):
    """Outcomes of all claims of the chapter for tables written by `write`."""
    entries = read_yaml(root / "data/published/rendezvous/claims.yaml")
    entries = [entry for entry in entries if entry["id"].startswith("flight-")]

    def outcomes(*tables, **changes):
        write(tmp_path, *tables, **changes)
        found = judge_claims(entries, grounds("rendezvous", section, tmp_path), "claims.yaml")
        return dict(zip(found["id"], found["outcome"], strict=True))

    return outcomes


def test_claims_hold_where_counts_are_as_the_thesis_says(judge):
    """All but "almost double", which its own averages contradict."""
    outcomes = judge(AS_PRINTED, SPREADS)
    assert outcomes.pop("flight-double") == "fails"
    assert set(outcomes.values()) == {"holds"}, outcomes


def test_claims_fail_where_counts_are_otherwise(judge):
    """Each of them, "almost double" with a factor of three."""
    outcomes = judge(OTHERWISE, OTHER_SPREADS, ms=20000.0, sampled=2.0, steps=90, position_m=1.0)
    assert set(outcomes.values()) == {"fails"}, outcomes


def test_nearly_double_can_hold(judge):
    means = AS_PRINTED | {"mid": AS_PRINTED["mid"] | {30: 1.9 * 181.55}}
    assert judge(means, SPREADS)["flight-double"] == "holds"


def otherwise_configured(section):
    """Other horizons, sample times and sweeps than those that were counted."""
    far, mid = section.phases.far, section.phases.mid
    phases = section.phases.with_(
        far=far.with_(horizon=20, sample_time_s=45.0), mid=mid.with_(horizon=8)
    )
    computer = section.flight_computer
    swept = computer.with_(far=computer.far.with_(horizons=(10, 20), sample_times_s=(5.0,)))
    return section.with_(phases=phases, flight_computer=swept)


def test_another_configuration_changes_nothing_that_was_counted(root, section, tmp_path, grounds):
    """Claims, observations and figures of the chapter follow the tables, not the what-if."""
    write(tmp_path, AS_PRINTED, SPREADS)
    entries = read_yaml(root / "data/published/rendezvous/claims.yaml")
    entries = [entry for entry in entries if entry["id"].startswith("flight-")]
    pairs = []
    for own in (section, otherwise_configured(section)):
        here = grounds("rendezvous", own, tmp_path)
        runs = here.table("flight/runs.csv")
        drawn = [
            figures.counts(runs, phase, varied, 25.0, here.ledger)[1]
            for phase, varied in (
                ("far", "horizon"),
                ("far", "sample_time_s"),
                ("final", "horizon"),
            )
        ]
        claims = judge_claims(entries, here, "claims.yaml")["evidence"]
        pairs.append((list(claims), list(flight_observations(here)), drawn))
    (claims, observations, drawn), (other_claims, other_observations, other_drawn) = pairs
    assert claims == other_claims and observations == other_observations
    assert all(
        one.equals(other) and len(one) for one, other in zip(drawn, other_drawn, strict=True)
    )


def test_bounds_that_include_the_limit_decide_nothing(judge):
    """A second between the least and the most that the worst solve takes."""
    outcomes = judge(AS_PRINTED, SPREADS, ms=3000.0)
    assert outcomes["flight-second"] == "undecided"
    assert judge(AS_PRINTED, SPREADS, docked=False)["flight-runs"] == "fails"


def test_errata(section, tmp_path, grounds):
    """They hold as printed; with other literals there would be no slip."""
    printed = grounds("rendezvous", section, tmp_path)
    assert flight_errata.approach_nearly_double(printed).holds
    found = flight_errata.approach_horizons(printed)
    assert found.holds and found.correct == "N2 = 5, 15, 30"
    place = "section-6-1-2/average-computation-time/approach-n2-30"
    less = grounds("rendezvous", section, tmp_path, {place: "350.00"})
    assert not flight_errata.approach_nearly_double(less).holds
    place = "section-6-1-2/approach-horizons-n2-tested-stated/item"
    listed = {f"{place}-2": "15", f"{place}-3": "30"}
    assert not flight_errata.approach_horizons(
        grounds("rendezvous", section, tmp_path, listed)
    ).holds


def test_every_printed_time_is_observed(section, tmp_path, grounds):
    """Each average with the bound of its own case, and both bounds with the worst of all."""
    write(tmp_path, AS_PRINTED, SPREADS, ms=250.0)
    found = list(flight_observations(grounds("rendezvous", section, tmp_path)))
    assert len(found) == len({one.id for one in found}) == 11
    averages = [one for one in found if "average" in one.id]
    assert len(averages) == 9 and all(one.computed == 250.0 for one in averages)
    assert all(one.computed == 0.25 for one in found if "bound" in one.id)
