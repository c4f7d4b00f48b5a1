"""Proofs of the slew errata can fail: with the printed value right, none of them holds."""

import copy

import pytest

from smallsat.studies.slew.evidence import errata


@pytest.mark.parametrize(
    ("proof", "literal", "right"),
    [
        ("table_3_time_optimal", "PRINTED_LEAST_TIME", 58.81),
        ("table_3_eigenaxis", "PRINTED_LONGEST", 88.97),
        ("table_2_velocity_sign", "PRINTED_HEIGHTS_KM", (11.69, 11.77)),
        ("dimensions", "PRINTED_SIZE", {"length": 0.3, "breadth": 0.1, "height": 0.1}),
        ("guidance_share", "PRINTED_SHARE_PCT", 93.2),
    ],
)
def test_proof_fails_where_the_document_would_be_right(
    tested_run, config, monkeypatch, proof, literal, right
):
    """The printed literal replaced by the value that the proof calls correct."""
    prove = getattr(errata, proof)
    results = tested_run / "data/results/slew"
    assert prove(config, results).holds
    monkeypatch.setattr(errata, literal, right)
    assert not prove(config, results).holds


@pytest.mark.parametrize(
    ("proof", "key", "value"),
    [
        # In two seconds the factor 2 / (tf - t0) is one, and the printed derivative is right.
        ("scaled_derivative", ("manoeuvre", "duration_s"), 2.0),
        # The target has hardly moved on: the axis of Eq. 27 is still the right one.
        ("gradient_axis", ("manoeuvre", "duration_s"), 0.01),
    ],
)
def test_proof_fails_in_the_special_case(tested_run, config, proof, key, value):
    """A configuration in which the printed formula is as good as the general one."""
    changed = copy.deepcopy(config)
    changed["slew"][key[0]][key[1]] = value
    results = tested_run / "data/results/slew"
    assert getattr(errata, proof)(config, results).holds
    assert not getattr(errata, proof)(changed, results).holds
