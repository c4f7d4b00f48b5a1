"""Predicates of what the document says of its models: each holds as configured and can fail."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.evidence import model_claims
from smallsat.studies.rendezvous.model.actuation_noise import Noise
from smallsat.studies.rendezvous.simulation import disturbances

CLAIMS = [
    "linear_motion_is_local",
    "hold_suits_short_samples",
    "bound_makes_impulsive",
    "constant_mass_is_conservative",
    "phases_save_work",
    "noise_is_bounded",
    "oblateness_dominates",
    "light_and_third_bodies_are_small",
]


@pytest.fixture
def on(grounds, tmp_path):
    """The grounds for a section, and other printed literals, with a flight by burns."""
    table = pd.DataFrame({"model": ["burns"] * 2, "steps": [9, 8], "steps_linear": [8, 8]})
    table.to_csv(tmp_path / "truth.csv", index=False)
    return lambda section, printed=None: grounds("rendezvous", section, tmp_path, printed)


@pytest.mark.parametrize("name", CLAIMS)
def test_claim_holds_as_configured(section, on, name):
    """With the document's own numbers."""
    judgement = getattr(model_claims, name)(on(section))
    assert judgement.outcome == "holds", judgement.evidence


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        # Burns that fill the step: held controls are exact then, and worst for the short steps.
        ("hold_suits_short_samples", "spacecraft.thruster_N", 0.085),
        # So strong a thruster that every burn is an impulse, and nothing is left to be halved.
        ("bound_makes_impulsive", "spacecraft.thruster_N", 1e30),
        # One phase with the finest sampling would look no further ahead.
        ("phases_save_work", "phases.far.horizon", 120),
        # A field whose other terms stand alone.
        ("oblateness_dominates", "truth.gravity_order", 0),
        # Air as thin as ten times higher up.
        ("light_and_third_bodies_are_small", "truth.density_factor", 0.1),
    ],
)
def test_claim_can_fail(section, on, changed, monkeypatch, name, key, value):
    """Where the world is another one, the sentence is false."""
    if name == "oblateness_dominates":
        # The oblateness is a thousandth of what it is.
        weak = [(n, m, c * (1e-3 if (n, m) == (2, 0) else 1.0), s)
                for n, m, c, s in model_claims.egm96.COEFFICIENTS]  # fmt: skip
        monkeypatch.setattr(model_claims.egm96, "COEFFICIENTS", weak)
    judgement = getattr(model_claims, name)(on(changed(section, key, value)))
    assert judgement.outcome == "fails", judgement.evidence


def test_a_linear_motion_that_errs_alike_everywhere_is_not_local(section, on, monkeypatch):
    """Errors of the same share near and far, on a circle and on an ellipse."""
    monkeypatch.setattr(model_claims, "_prediction_error", lambda *_: 1e-3)
    assert model_claims.linear_motion_is_local(on(section)).outcome == "fails"


def test_a_constant_mass_is_no_estimate_of_a_large_change(section, on):
    """With a tenth of the specific impulse it is a third too much."""
    given = on(section, {"section-2-1-2/isp-of-af-m315e-ascent": "22"})
    assert model_claims.constant_mass_is_conservative(given).outcome == "fails"


def test_a_random_walk_is_not_bounded(section, on, monkeypatch):
    """Without the terms that pull back the deviation grows with the square root of time."""
    walk = Noise(1e12, 1e-12, 1.0, 0.1, 1e-30)
    monkeypatch.setattr(disturbances, "thrust_noise", lambda error: walk)
    assert model_claims.noise_is_bounded(on(section)).outcome == "fails"


@pytest.mark.parametrize(
    ("key", "value"), [("truth.gravity_degree", 2), ("truth.density_factor", 0.0)]
)
def test_claims_wait_for_what_a_run_leaves_out(section, on, changed, key, value):
    """Without higher degrees, or without air, there is nothing to compare with."""
    name = "oblateness_dominates" if "degree" in key else "light_and_third_bodies_are_small"
    with pytest.raises(LookupError):
        getattr(model_claims, name)(on(changed(section, key, value)))


def test_the_linear_motion_errs_by_the_square_of_the_distance(section):
    """Second-order terms are left out: a tenth of the distance, a tenth of the relative error."""
    given = model_claims.law(section)
    near, away = (model_claims._prediction_error(given, d, 0.0) for d in (1000.0, 10_000.0))
    assert np.isclose(away / near, 10.0, rtol=0.02)
