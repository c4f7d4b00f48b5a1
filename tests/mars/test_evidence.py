"""Proofs and predicates: they hold on the default configuration, and they can fail."""

import pandas as pd
import pytest

from smallsat.studies.mars.configuration import Spacecraft
from smallsat.studies.mars.evidence import claims, errata
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.methods.simulation import as_table, day_run


@pytest.fixture(scope="module")
def results(tmp_path_factory, section, parameters, runs):
    folder = tmp_path_factory.mktemp("results")
    tables = [as_table(record).assign(run=name) for name, record in runs.items()]
    pd.concat(tables).to_parquet(folder / "trajectories.parquet")
    check_runs(section, parameters).to_parquet(folder / "independent.parquet")
    as_table(day_run(section, parameters)).to_parquet(folder / "day.parquet")
    return folder


# At rest in the Sun frame, which is half a turn about the axis (0, 1, 1) away.
AT_REST = Spacecraft(
    inertia_kg_m2=(10.0, 5.0, 7.5),
    initial_mrp=(0.0, 0.5**0.5, 0.5**0.5),
    initial_rate_deg_s=(0.0, 0.0, 0.0),
)
PROOFS = [
    "table_8_misprint",
    "nadir_frame_sign",
    "kinetic_energy_half",
    "attitude_matrix_factor",
    "gmo_frame_roots",
    "gain_name",
    "gain_fraction",
    "argument_of_latitude_start",
    "visibility_overlap",
    "second_rate_panel",
    "reference_rate_frame",
    "first_row_of_listings",
    "tracking_rate_formula",
]


@pytest.mark.parametrize("name", PROOFS)
def test_proof_holds(section, results, grounds, name):
    """Each erratum is proven with the document's own configuration."""
    proof = getattr(errata, name)(grounds("mars", section, results))
    assert proof.holds, proof.statement


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        ("nadir_frame_sign", "orbits.lmo.inclination_deg", 0.0),
        ("kinetic_energy_half", "spacecraft.initial_rate_deg_s", [0.1, 0.1, 0.1]),
        ("argument_of_latitude_start", "orbits.lmo.argument_of_latitude_deg", 0.0),
        ("gain_fraction", "spacecraft.inertia_kg_m2", [10.0, 0.6, 7.5]),
        ("first_row_of_listings", "spacecraft", AT_REST),
    ],
)
def test_proof_fails_where_the_document_would_be_right(
    section, results, grounds, changed, name, key, value
):
    """A configuration in which the printed version is as good: the proof must not hold."""
    other = changed(section, key, value)
    assert not getattr(errata, name)(grounds("mars", other, results)).holds


@pytest.mark.parametrize(
    ("name", "place", "right"),
    [
        ("visibility_overlap", "table-1-footnote/not-visible-lmo-gmo-angular-separation", "> 35"),
        ("table_8_misprint", "table-8/sigma-b-n-at-t-4400-s/full-mission/1", "-0.433"),
        ("nadir_frame_sign", "section-vi-d/dcm-rnn-330-s/lmo/32", "0.4698"),
        ("gain_name", "section-x-b/gain-1-6-in-summary-sentence", "1/180"),
        ("gain_fraction", "section-x-b/k-intermediate-fraction", "(1/36)/5"),
        # The energy that follows from the printed formula.
        ("kinetic_energy_half", "section-ix-b/kinetic-energy-t-500-s/no-torque", "0.01877"),
        ("argument_of_latitude_start", "section-iii-c/inertial-position-r-lmo-450-s/lmo/x", "0.0"),
        # A table that followed from the printed formula.
        ("tracking_rate_formula", "table-3/omega-b-r-t0/sun-pointing/2", "0.0000"),
    ],
)
def test_proof_fails_with_another_literal(section, results, grounds, name, place, right):
    """What the document prints is read from the ledger; printed otherwise, it would be right."""
    changed = grounds("mars", section, results, {place: right})
    assert not getattr(errata, name)(changed).holds


def test_claims_of_the_fixed_torque_run(section, results, grounds):
    """omega_2 spins up instead of oscillating; the one-second step is too long, as suspected."""
    given = grounds("mars", section, results)
    assert claims.rates_oscillate_about_zero(given).outcome == "fails"
    assert claims.step_leaves_artefacts(given).outcome == "holds"


def test_convergence_is_judged_by_the_requirement(section, results, grounds, changed):
    """With a requirement a hundred times stricter the same run does not converge in time."""
    given = grounds("mars", section, results)
    assert claims.gmo_pointing_converges(given).outcome == "holds"
    strict = changed(section, "requirements.largest_decay_time_s", 20.0)
    given = grounds("mars", strict, results)
    assert claims.gmo_pointing_converges(given).outcome == "fails"


def test_a_short_run_decides_nothing(section, results, grounds, changed):
    """A requirement longer than the run can show: undecided, not failed."""
    slow = changed(section, "requirements.largest_decay_time_s", 1e4)
    given = grounds("mars", slow, results)
    assert claims.sun_pointing_converges(given).outcome == "undecided"
