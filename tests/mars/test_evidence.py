"""Proofs and predicates: they hold on the default configuration, and they can fail."""

import copy

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.mars.evidence import claims, errata
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.methods.simulation import as_table, day_run


@pytest.fixture(scope="module")
def results(tmp_path_factory, section, given, runs):
    folder = tmp_path_factory.mktemp("results")
    tables = [as_table(record).assign(run=name) for name, record in runs.items()]
    pd.concat(tables).to_parquet(folder / "trajectories.parquet")
    check_runs(section, given).to_parquet(folder / "independent.parquet")
    as_table(day_run(section, given)).to_parquet(folder / "day.parquet")
    return folder


PROOFS = [
    "table_8_misprint",
    "nadir_frame_sign",
    "kinetic_energy_half",
    "attitude_matrix_factor",
    "gmo_frame_roots",
    "gain_name",
    "gain_fraction",
    "latitude_angle_start",
    "visibility_overlap",
    "second_rate_panel",
    "reference_rate_frame",
    "day_length",
    "switch_thresholds",
    "tracking_rate_formula",
]


@pytest.mark.parametrize("name", PROOFS)
def test_proof_holds(section, results, name):
    """Each erratum is proven with the document's own configuration."""
    proof = getattr(errata, name)({"mars": section}, results)
    assert proof.holds, proof.statement


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        ("nadir_frame_sign", ("orbits", "lmo", "inclination_deg"), 0.0),
        ("kinetic_energy_half", ("spacecraft", "initial_rate_deg_s"), [0.1, 0.1, 0.1]),
        ("latitude_angle_start", ("orbits", "lmo", "latitude_angle_deg"), 0.0),
        ("gain_fraction", ("spacecraft", "inertia_kg_m2"), [10.0, 0.6, 7.5]),
        ("day_length", ("orbits", "gmo", "rate_rad_s"), 2.0 * np.pi / 90000.0),
        ("switch_thresholds", ("mrp_switch",), dict.fromkeys(["torque", "sun", "nadir"], 1.0)),
    ],
)
def test_proof_fails_where_the_document_would_be_right(section, results, name, key, value):
    """A configuration in which the printed version is as good: the proof must not hold."""
    changed = copy.deepcopy(section)
    entry = changed
    for part in key[:-1]:
        entry = entry[part]
    entry[key[-1]] = value
    assert not getattr(errata, name)({"mars": changed}, results).holds


@pytest.mark.parametrize(
    ("name", "place", "right"),
    [
        ("visibility_overlap", "table-1-footnote/not-visible-lmo-gmo-angular-separation", "> 35"),
        # A table that followed from the printed formula.
        ("tracking_rate_formula", "table-3/omega-b-r-t0/sun-pointing/2", "0.0000"),
    ],
)
def test_proof_fails_with_another_literal(section, results, monkeypatch, name, place, right):
    """What the document prints is read from the ledger; printed otherwise, it would be right."""
    printed = errata.literal
    monkeypatch.setattr(errata, "literal", lambda key: right if key == place else printed(key))
    assert not getattr(errata, name)({"mars": section}, results).holds


def test_claims_of_the_fixed_torque_run(section, results):
    """omega_2 spins up instead of oscillating; the one-second step is too long, as suspected."""
    config = {"mars": section}
    assert claims.rates_oscillate_about_zero(config, results).outcome == "fails"
    assert claims.step_leaves_artefacts(config, results).outcome == "holds"


def test_convergence_is_judged_by_the_requirement(section, results):
    """With a requirement a hundred times stricter the same run does not converge in time."""
    assert claims.gmo_pointing_converges({"mars": section}, results).outcome == "holds"
    strict = copy.deepcopy(section)
    strict["requirements"]["largest_decay_time_s"] = 20.0
    assert claims.gmo_pointing_converges({"mars": strict}, results).outcome == "fails"


def test_a_short_run_decides_nothing(section, results):
    """A requirement longer than the run can show: undecided, not failed."""
    slow = copy.deepcopy(section)
    slow["requirements"]["largest_decay_time_s"] = 1e4
    assert claims.sun_pointing_converges({"mars": slow}, results).outcome == "undecided"
