"""Proofs of the errata hold, and fail where what they rest on is changed."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from smallsat.results import write_table
from smallsat.studies.racing.evidence import claims, errata

RESULTS = Path("nowhere")


@pytest.mark.parametrize(
    "proof", ["start_covariance", "start_ring_comment", "angle_steps", "costate_transpose"]
)
def test_proofs_without_results_hold(section, proof, grounds):
    """Those that need no solve."""
    assert getattr(errata, proof)(grounds("racing", section, RESULTS)).holds


@pytest.mark.parametrize(
    ("proof", "change"),
    [
        ("start_covariance", ("start.sigma_level", 1.0)),
        ("start_ring_comment", ("start.axis_multiple", 5.0)),
    ],
)
def test_proofs_fail_with_the_printed_number(section, changed, proof, change, grounds):
    """With the printed number in the configuration its proof does not hold."""
    other = changed(section, *change)
    assert not getattr(errata, proof)(grounds("racing", other, RESULTS)).holds


def test_angle_steps_need_the_seeds(section, changed, grounds):
    """Another seed gives neither start."""
    other = changed(section, "scenarios.scenario-2.seed", 739743)
    assert not errata.angle_steps(grounds("racing", other, RESULTS)).holds


def test_costate_proof_can_fail(section, monkeypatch, grounds):
    """If the listing's matrix were the right one, nothing would be proven."""
    right = errata.hamiltonian_drift
    monkeypatch.setattr(errata, "hamiltonian_drift", lambda c, transposed: right(c, True))
    assert not errata.costate_transpose(grounds("racing", section, RESULTS)).holds


def test_adjoint_proof_can_fail(section, monkeypatch, grounds):
    """With the corrected entry printed there would be no erratum."""
    printed = errata.printed_adjoint_transition

    def mended(n, t):
        matrix = printed(n, t)
        matrix[4, 1] = 3.0 * t - 4.0 / n * np.sin(n * t)
        return matrix

    assert errata.adjoint_transition(grounds("racing", section, RESULTS)).holds
    monkeypatch.setattr(errata, "printed_adjoint_transition", mended)
    assert not errata.adjoint_transition(grounds("racing", section, RESULTS)).holds


def test_ring_size_and_axial_thrust(section, monkeypatch, grounds):
    """Both hold; the law's proof fails where no component lies in the deadzone."""
    assert errata.ring_size(grounds("racing", section, RESULTS)).holds
    assert errata.axial_thrust(grounds("racing", section, RESULTS)).holds
    monkeypatch.setattr(errata, "PRIMER", np.array([2.0, 2.0, -3.0]))
    assert not errata.axial_thrust(grounds("racing", section, RESULTS)).holds


def test_redundancy_proof_can_fail(section, monkeypatch, tmp_path, grounds):
    """Were the twelve rows of rank five, nothing would be redundant beyond the fixed ones."""
    monkeypatch.setattr(errata, "equality_ranks", lambda *_, **__: (5, 5, 3))
    table = pd.DataFrame({"converged": [True]})
    write_table(table, tmp_path / "listing-scenario-1-segments.csv")
    assert not errata.redundant_equalities(grounds("racing", section, tmp_path)).holds


def test_printed_scores_add_up(section, grounds):
    """The claim on cost, time and accuracy fails with one digit changed."""
    assert claims.cost_is_time_plus_accuracy(grounds("racing", section, RESULTS)).outcome == "holds"
    wrong = {"table-2/final-overall-cost/scenario-1-mo": "2129.008"}
    changed = grounds("racing", section, RESULTS, wrong)
    assert claims.cost_is_time_plus_accuracy(changed).outcome == "fails"


def test_five_printed_runs_missed(section, grounds):
    """Eeny and Mo of Scenario 1, Eeny, Miny and Mo of Scenario 2."""
    judgement = claims.printed_runs_missed(grounds("racing", section, RESULTS))
    assert judgement.outcome == "holds"
    for name in ("Eeny 92.1", "Mo 693.7", "Eeny 609.0", "Miny 665.8", "Mo 143.3"):
        assert name in judgement.evidence


@pytest.mark.parametrize(
    ("costs", "unconverged", "outcome"),
    [
        ([4300.0, 2800.0], 23, "holds"),
        ([4300.0, 4300.1], 23, "fails"),
        ([4300.0, 2800.0], 0, "fails"),
    ],
)
def test_a_solve_is_erratic_where_nothing_it_should_depend_on_changes(
    section, tmp_path, costs, unconverged, outcome, grounds
):
    """Costs apart and nothing converged; costs alike; or all converged."""
    table = pd.DataFrame(
        {"variant": ["one", "two"], "cost": costs, "missed": 9, "not_converged": unconverged,
         "segments": 23}
    )  # fmt: skip
    write_table(table, tmp_path / "variants.csv")
    assert (
        claims.published_solve_is_erratic(grounds("racing", section, tmp_path)).outcome == outcome
    )
