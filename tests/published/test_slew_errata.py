"""Proofs of the slew errata can fail: with the printed value right, none of them holds."""

import pytest

from smallsat.studies.slew.evidence import errata


@pytest.mark.parametrize(
    ("proof", "right"),
    [
        ("table_3_time_optimal", {"table-3/t-min/90-deg-time-optimal": "58.81"}),
        ("table_3_eigenaxis", {"table-3/t-max/90-deg-eigenaxis": "88.97"}),
        ("table_2_velocity_sign", {"table-2/r-0/z": "11.69", "table-2/r-f/z": "11.77"}),
        (
            "dimensions",
            {
                f"appendix-after-table-5/cubesat-dimension/{axis}": size
                for axis, size in {"l": "0.3", "b": "0.1", "h": "0.1"}.items()
            },
        ),
        ("zenith_axis", {"table-5/area-normal-vector/panel-3": "+x"}),
        ("guidance_share", {"section-vi-c/guidance-share-of-run-time/min": "93"}),
    ],
)
def test_proof_fails_where_the_document_would_be_right(tested_run, config, grounds, proof, right):
    """The printed literal replaced by the value that the proof calls correct."""
    prove = getattr(errata, proof)
    results = tested_run / "data/results/slew"
    assert prove(grounds("slew", config.slew, results)).holds
    assert not prove(grounds("slew", config.slew, results, right)).holds


@pytest.mark.parametrize(
    ("proof", "key", "value"),
    [
        # In two seconds the factor 2 / (tf - t0) is one, and the printed derivative is right.
        ("scaled_derivative", "manoeuvre.duration_s", 2.0),
        # The target has hardly moved on: the axis of Eq. 27 is still the right one.
        ("gradient_axis", "manoeuvre.duration_s", 0.01),
    ],
)
def test_proof_fails_in_the_special_case(tested_run, config, grounds, changed, proof, key, value):
    """A configuration in which the printed formula is as good as the general one."""
    other = changed(config.slew, key, value)
    results = tested_run / "data/results/slew"
    assert getattr(errata, proof)(grounds("slew", config.slew, results)).holds
    assert not getattr(errata, proof)(grounds("slew", other, results)).holds
