"""Predicates of chapters 4 and 5 on made-up manoeuvres: each can hold, and each can fail."""

import numpy as np
import pytest
import synthetic

from smallsat.evidence.claims import judge_claims
from smallsat.results import write_table
from smallsat.strict_yaml import read_yaml
from smallsat.studies.rendezvous.configuration import Sweep
from smallsat.studies.rendezvous.evidence import ensemble
from smallsat.studies.rendezvous.evidence.monte_carlo_observations import (
    predictive_count,
    predictive_maximum,
)
from smallsat.studies.rendezvous.evidence.sensitivity_claims import proportion_interval
from smallsat.studies.rendezvous.monte_carlo.cases import (
    AS_DOCUMENTED,
    TUBE,
    UNDISTURBED,
    near_errors_case,
)

COUNT = 120
RENDEZVOUS = ([15, 30, 45], [20.0, 30.0, 40.0, 50.0, 60.0])
APPROACH = ([5, 15, 30], [5.0, 10.0, 15.0, 20.0, 25.0, 30.0])
DOCKING = ([5, 12, 30], [1.0, 3.0, 5.0, 10.0])


@pytest.fixture
def judge(root, grounds, monkeypatch):
    """Outcomes of the claims with these names; the ensemble is the made-up run itself."""
    monkeypatch.setattr(ensemble, "members", lambda given: [given])
    entries = read_yaml(root / "data/published/rendezvous/claims.yaml")

    def outcomes(section, folder, names):
        chosen = [entry for entry in entries if entry["id"] in names]
        assert {entry["id"] for entry in chosen} == set(names)
        found = judge_claims(chosen, grounds("rendezvous", section, folder), "claims.yaml")
        return dict(zip(found["id"], found["outcome"], strict=True))

    return outcomes


def write(folder, **tables):
    for name, table in tables.items():
        write_table(table, folder / f"studies/{name.replace('_', '-')}.parquet")


# Laws of delta-v, m/s, and time, s, by horizon and sample time: as the document has it, the other
# way round, and without any effect.
AS_SAID = {
    "rendezvous": (lambda n, t: 5 + 200 / t + 30 / n**2, lambda n, t: 500 + 20 * t + 60000 / n**2),
    "approach": (
        lambda n, t: (2 if n > 5 else 4) * (10 / t) ** 0.3,
        lambda n, t: 200 * (t / 10) ** 0.6,
    ),
    "docking": (lambda n, t: 0.3 - 0.01 * t, lambda n, t: 250 * (1 + 0.05 * t)),
}
REVERSED = {
    "rendezvous": (lambda n, t: 5 + 0.2 * t * n, lambda n, t: 60000 * n / t**1.5),
    "approach": (
        lambda n, t: 2 * (t / 10) ** 0.3 * n,
        lambda n, t: 2000 * (10 / t) * n,
    ),
    "docking": (lambda n, t: 5 + 5 * t * n, lambda n, t: 4000 / n * t**-0.5),
}
NOTHING = {
    phase: (lambda n, t: 5.0, lambda n, t: 6000.0)
    for phase in ("rendezvous", "approach", "docking")
}
EXPECTED = {
    "rendezvous-saves": ("holds", "fails", "undecided"),
    "rendezvous-diminishing": ("holds", None, "undecided"),
    "rendezvous-actuations": ("holds", None, "holds"),
    "rendezvous-longer": ("holds", "fails", "undecided"),
    "rendezvous-spread": ("holds", "fails", "undecided"),
    "n1-15-30": ("holds", "fails", "undecided"),
    "n1-30-45": ("holds", "fails", "holds"),
    "approach-minimum": ("holds", "fails", "undecided"),
    "approach-time-spread": ("holds", "fails", "undecided"),
    "n2-5-15": ("holds", "fails", "fails"),
    "n2-15-30": ("holds", "fails", "holds"),
    "docking-double": ("holds", "holds", "holds"),
    "docking-later": ("holds", "fails", "undecided"),
    "docking-extremes": ("holds", "fails", "undecided"),
    "docking-tiny": ("holds", "fails", "holds"),
    "docking-horizon": ("holds", "fails", "holds"),
    "docking-recommended": ("fails", "fails", "undecided"),
}


@pytest.mark.parametrize("world", [0, 1, 2], ids=["as said", "reversed", "no effect"])
def test_sweep_claims_find_the_effect_that_is_there(judge, section, tmp_path, world):
    """120 initial states with a scatter of 30 % among them and of 2 % from case to case."""
    laws = (AS_SAID, REVERSED, NOTHING)[world]
    tables = {
        f"{phase}_sweep": synthetic.sweep(phase, *grid, COUNT, *laws[phase])
        for phase, grid in (
            ("rendezvous", RENDEZVOUS), ("approach", APPROACH), ("docking", DOCKING)
        )
    }  # fmt: skip
    states = synthetic.states(COUNT)
    write(tmp_path, domain=synthetic.domain(states), initial_states=states, **tables)
    found = judge(section, tmp_path, EXPECTED)
    expected = {name: outcomes[world] for name, outcomes in EXPECTED.items() if outcomes[world]}
    assert {name: found[name] for name in expected} == expected


@pytest.mark.parametrize("times", [2, 3, 5])
@pytest.mark.parametrize("horizons", [1, 2, 4])
def test_sweep_claims_wait_where_a_run_has_other_lists(judge, section, tmp_path, horizons, times):
    """A claim that names places of the document's lists is undecided; none stops the judge."""
    tables, studies = {}, section.studies
    for phase in ("rendezvous", "approach", "docking"):
        grid = ([8 * (i + 1) for i in range(horizons)], [7.0 * (i + 1) for i in range(times)])
        studies = studies.with_(**{phase: Sweep(horizons=grid[0], sample_times_s=grid[1])})
        tables[f"{phase}_sweep"] = synthetic.sweep(phase, *grid, COUNT, *AS_SAID[phase])
    states = synthetic.states(COUNT)
    write(tmp_path, domain=synthetic.domain(states), initial_states=states, **tables)
    found = judge(section.with_(studies=studies), tmp_path, EXPECTED)
    assert set(found) == set(EXPECTED)
    if horizons != 3:
        assert found["n1-30-45"] == found["n2-15-30"] == "undecided"
    if horizons == 1:
        assert found["n1-15-30"] == found["n2-5-15"] == "undecided"
    if times != 4:
        assert found["docking-recommended"] == "undecided"


@pytest.mark.parametrize(
    ("level", "growth", "outcome"),
    [(2.0, 1.0, "holds"), (2.0, -1.0, "fails"), (30.0, -1.0, "undecided")],
)
def test_a_horizon_beyond_the_printed_axis_is_no_witness(
    judge, section, tmp_path, level, growth, outcome
):
    """Spreads that grow with the sample time, but for N 5: within Figure 4.7, and beyond."""
    table = synthetic.sweep(
        "approach",
        *APPROACH,
        COUNT,
        lambda n, t: level * (t / 10) ** growth if n == 5 else 2 * t / 10,
        lambda n, t: 200.0,
    )
    write(tmp_path, approach_sweep=table)
    assert judge(section, tmp_path, ["approach-spread"]) == {"approach-spread": outcome}


def test_claims_of_manoeuvres_that_never_dock(judge, section, tmp_path):
    """Nothing completes, so nothing is decided, and nothing stops the judge."""
    states = synthetic.states(COUNT)
    tables = {
        f"{phase}_sweep": synthetic.sweep(phase, *grid, COUNT, *AS_SAID[phase]).assign(
            completed=False
        )
        for phase, grid in (
            ("rendezvous", RENDEZVOUS), ("approach", APPROACH), ("docking", DOCKING)
        )
    }  # fmt: skip
    domain = synthetic.domain(states).assign(completed=False)
    write(tmp_path, domain=domain, initial_states=states, **tables)
    found = judge(section, tmp_path, {**EXPECTED, "behind-longer": (), "quadrant-alone": ()})
    assert set(found.values()) == {"undecided"}


def test_domain_claims(judge, section, tmp_path):
    """Manoeuvres made to cost more from behind and from afar; then a shuffled quadrant."""
    names = ["behind-longer", "behind-minimum", "distance-minimum", "quadrant-alone"]
    states = synthetic.states(400)
    write(tmp_path, domain=synthetic.domain(states), initial_states=states)
    assert judge(section, tmp_path, names) == dict.fromkeys(names, "holds")
    mirrored = states.assign(
        quadrant=(5 - states["quadrant"]).astype("int8"),
        distance_m=2700.0 - states["distance_m"],
    )
    write(tmp_path, initial_states=mirrored)
    found = judge(section, tmp_path, names)
    assert found["behind-longer"] == found["distance-minimum"] == "fails"


def disturbed(case, runs, docking_time, docking_delta_v, completed=1.0):
    random = np.random.default_rng(len(case))
    parts = []
    for run in range(runs):
        done = random.uniform(size=40) < completed
        noise = random.uniform(0.8, 1.2, (2, 40))
        parts.append(
            synthetic.manoeuvres(
                case, 40, run, completed=done,
                rendezvous_time_s=900.0, rendezvous_delta_v_m_s=9.0,
                docking_time_s=docking_time * noise[0],
                docking_delta_v_m_s=docking_delta_v * noise[1],
            )
        )  # fmt: skip
    return synthetic.pd.concat(parts, ignore_index=True)


@pytest.mark.parametrize(
    ("noisy", "better", "share", "outcomes"),
    [
        ((1500.0, 4.0), (320.0, 0.3), 1.0, ("holds", "holds", "holds", "holds", "holds")),
        ((330.0, 0.25), (1500.0, 4.0), 0.5, (None, "fails", "fails", "undecided", "fails")),
        ((1500.0, 4.0), (1600.0, 5.0), 1.0, ("holds", "holds", "holds", "fails", None)),
    ],
)
def test_robustness_claims(judge, section, tmp_path, noisy, better, share, outcomes):
    """A chaser that bounces, with sensors and a tube that help or hurt; and one that does not."""
    rows = [
        disturbed(UNDISTURBED, 1, 300.0, 0.2),
        disturbed(AS_DOCUMENTED, 5, *noisy, share),
        disturbed(near_errors_case(0.1), 5, *better),
        disturbed(TUBE, 5, *better),
    ]
    write(tmp_path, robustness=synthetic.pd.concat(rows, ignore_index=True))
    names = ("increase-docking", "bounce", "robust", "near-sensors", "tube-robust")
    found = judge(section, tmp_path, names)
    for name, outcome in zip(names, outcomes, strict=True):
        assert outcome is None or found[name] == outcome, name


def test_failures_at_rest_on_the_sphere_are_told_from_others(judge, section, tmp_path):
    """Twelve failures on the keep-out sphere without speed; then with speed."""
    radius = section.inferred.keep_out_m
    table = synthetic.sweep("rendezvous", *RENDEZVOUS, 60, *AS_SAID["rendezvous"])
    failed = (table["case"] == "N 45, Ts 60 s") & (table["sample"] < 12)
    table.loc[failed, "completed"] = False
    table.loc[failed, [f"rendezvous_end_{c}" for c in ("x_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s")]] = 0.0  # fmt: skip # noqa: E501
    table.loc[failed, "rendezvous_end_y_m"] = -radius
    write(tmp_path, rendezvous_sweep=table)
    names = ["failures-stall", "rendezvous-failures"]
    assert judge(section, tmp_path, names) == dict.fromkeys(names, "holds")
    table.loc[failed, "rendezvous_end_vx_m_s"] = 1.0
    write(tmp_path, rendezvous_sweep=table)
    assert judge(section, tmp_path, names)["failures-stall"] == "fails"


def test_failures_elsewhere_are_no_witness(judge, section, tmp_path):
    """At the shortest horizon alone nothing can be told; with one as printed the claim fails."""
    table = synthetic.sweep("rendezvous", *RENDEZVOUS, 60, *AS_SAID["rendezvous"])
    table["completed"] = ~((table["case"] == "N 15, Ts 60 s") & (table["sample"] < 30))
    write(tmp_path, rendezvous_sweep=table)
    names = ["failures-stall", "rendezvous-failures"]
    assert judge(section, tmp_path, names) == dict.fromkeys(names, "undecided")
    table.loc[(table["case"] == "N 45, Ts 60 s") & (table["sample"] == 0), "completed"] = False
    write(tmp_path, rendezvous_sweep=table)
    assert judge(section, tmp_path, names) == dict.fromkeys(names, "fails")


def test_predictive_count_covers_another_sample():
    """The 95 % interval holds the failures of a second set of 500 about as often as it says."""
    random = np.random.default_rng(5)
    first, second = random.binomial(500, 0.01, (2, 400))
    hits = 0
    for a, b in zip(first, second, strict=True):
        low, high = predictive_count(int(a), 500, 0.95, 500)
        hits += low <= b <= high
    assert 0.92 <= hits / 400 <= 1.0
    # Of few manoeuvres little is known.
    assert predictive_count(0, 25, 0.95, 500)[1] > predictive_count(0, 500, 0.95, 500)[1]


def test_predictive_maximum_is_a_bound_of_another_sample():
    """Largest of a second set of 500 below the low end in at most a fortieth of the cases."""
    random = np.random.default_rng(6)
    low = [predictive_maximum(random.normal(size=500), 0.1, 0.95, 500)[0] for _ in range(600)]
    largest = random.normal(size=(600, 500)).max(axis=1)
    assert np.mean(largest < low) <= 0.04
    assert predictive_maximum(random.normal(size=25), 0.1, 0.95, 500)[1] == np.inf


def test_proportion_interval_is_the_exact_one():
    """Clopper and Pearson's interval for 2 of 500: 0.0485 to 1.4374 %, a tabulated value."""
    low, high = proportion_interval(2, 500, 0.95)
    assert 100.0 * low == pytest.approx(0.0485, abs=5e-4)
    assert 100.0 * high == pytest.approx(1.4374, abs=5e-3)
