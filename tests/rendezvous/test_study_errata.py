"""Proofs of the slips in chapters 4 and 5: they hold as printed, and can fail."""

from pathlib import Path

import pytest
import synthetic

from smallsat.results import write_table
from smallsat.studies.rendezvous.evidence import monte_carlo_errata as study_errata
from smallsat.studies.rendezvous.monte_carlo.cases import LP, NO_SET_POINT, sweep_case

NOWHERE = Path("nowhere")
COUNT = 40


def fly(folder, infeasible_at=5):
    """A made-up sweep of the approach, with the horizon at which 5 s is infeasible."""
    grid = [5, 15, 30], [5.0, 10.0, 15.0, 20.0, 25.0, 30.0]
    table = synthetic.sweep("approach", *grid, COUNT, lambda n, t: 4.0, lambda n, t: 600.0)
    met = table["case"] == sweep_case(infeasible_at, 5.0)
    table.loc[met, "approach_softened"] = 1
    write_table(table, folder / "studies/approach-sweep.parquet")


def domain(folder, factor):
    """Both variants of the appendix, one with so many times the delta-v and time of the other."""
    parts = [
        synthetic.manoeuvres(
            name, COUNT, rendezvous_time_s=900.0 * by, rendezvous_delta_v_m_s=9.0 * by
        )
        for name, by in ((NO_SET_POINT, factor), (LP, 1.0))
    ]
    write_table(synthetic.pd.concat(parts, ignore_index=True), folder / "studies/domain.parquet")


def test_sample_time_subscript(section, grounds):
    """Printed in one list only; in both, the subscript would be no slip."""
    found = study_errata.sample_time_subscript(grounds("rendezvous", section, NOWHERE))
    assert found.holds and found.correct == "Ts,1 = 60 s"
    both = {"section-4-3/approach-sample-times-tested/item-6": "60"}
    changed = grounds("rendezvous", section, NOWHERE, both)
    assert not study_errata.sample_time_subscript(changed).holds


@pytest.mark.parametrize(
    ("place", "other"),
    [
        ("section-4-4/docking-prediction-horizons-n3-tested/item-1", "30"),
        ("section-6-2/docking-horizons-n3-benchmarked/item-3", "5"),
    ],
)
def test_docking_horizons(section, grounds, place, other):
    """Missing in one list and printed in another; listed in both, or nowhere, it is no slip."""
    found = study_errata.docking_horizons(grounds("rendezvous", section, NOWHERE))
    assert found.holds and found.correct == "N3 = 5, 12, 30"
    changed = grounds("rendezvous", section, NOWHERE, {place: other})
    assert not study_errata.docking_horizons(changed).holds


def test_approach_figures_swapped(section, tmp_path, grounds):
    """Infeasible at the shortest horizon; at the next one, the text would be right."""
    fly(tmp_path)
    assert study_errata.approach_figures_swapped(grounds("rendezvous", section, tmp_path)).holds
    fly(tmp_path, infeasible_at=15)
    assert not study_errata.approach_figures_swapped(grounds("rendezvous", section, tmp_path)).holds


@pytest.mark.parametrize(
    ("place", "other"),
    [
        # An approach with so short a sample time, or so few intervals, could be what is shown.
        ("section-4-3/approach-sample-times-tested/item-1", "2"),
        (f"figure-4-10-b/x-axis-tick-range-{study_errata.INTERVALS}/n3-5/max", "200"),
        # A docking phase that ends sooner could not.
        (f"figure-4-10-a/{study_errata.TIMES}/n3-5/max", "4"),
    ],
)
def test_docking_axis_label(section, grounds, place, other):
    """The printed axes alone tell which phase has so many intervals."""
    assert study_errata.docking_axis_label(grounds("rendezvous", section, NOWHERE)).holds
    changed = grounds("rendezvous", section, NOWHERE, {place: other})
    assert not study_errata.docking_axis_label(changed).holds


def test_appendix_caption(section, tmp_path, grounds):
    """Two variants that look alike could share a figure."""
    domain(tmp_path, 3.0)
    assert study_errata.appendix_caption(grounds("rendezvous", section, tmp_path)).holds
    domain(tmp_path, 1.0)
    assert not study_errata.appendix_caption(grounds("rendezvous", section, tmp_path)).holds


def test_docking_recommendation(section, grounds):
    """It contradicts its own section, unless the longest tested sample time were recommended."""
    found = study_errata.docking_recommendation(grounds("rendezvous", section, NOWHERE))
    assert found.holds
    longest = {"section-4-4/recommended-docking-sample-time/max": "10"}
    changed = grounds("rendezvous", section, NOWHERE, longest)
    assert not study_errata.docking_recommendation(changed).holds
