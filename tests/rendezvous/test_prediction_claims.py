"""Predicates of chapter 2: each holds and fails where it must."""

import pytest

from smallsat.dynamics.orbits import yamanaka_ankersen
from smallsat.studies.rendezvous.evidence import prediction_claims


def test_the_elliptic_prediction_reduces_and_a_slightly_elliptic_one_does_not(
    section, grounds, tmp_path, monkeypatch
):
    """With no eccentricity it holds; with one of 1e-6 in its place it fails."""
    given = grounds("rendezvous", section, tmp_path)
    assert prediction_claims.elliptic_prediction_reduces(given).outcome == "holds"
    exact = yamanaka_ankersen.transition
    monkeypatch.setattr(yamanaka_ankersen, "transition", lambda n, e, f, t: exact(n, 1e-6, f, t))
    assert prediction_claims.elliptic_prediction_reduces(given).outcome == "fails"


def test_the_difference_grows_in_proportion_to_the_eccentricity(section):
    """A tenth of the eccentricity, a tenth of the difference, to a thousandth."""
    n = section.inferred.mean_motion_rad_s
    small, large = (
        prediction_claims.largest_difference(yamanaka_ankersen.transition, n, e, (900.0,))
        for e in (1e-6, 1e-5)
    )
    assert large / small == pytest.approx(10.0, rel=1e-3)
