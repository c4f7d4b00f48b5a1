"""Proofs of the errata of chapters 2 and 3: they hold on the default configuration and can fail.

The flights that two of them read are made up here: the far range of one ends at a margin above the
keep-out zone, the mid range of the other lies anywhere.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.evidence import claims, errata
from smallsat.studies.rendezvous.inference.parameter_set import ParameterSet
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.parameters import law


def made_up(section, depth=0.0):
    """Two flights: far samples down to 1.05 r1 less a depth, m, mid samples from 1.1 r1 inwards."""
    r1 = section.inferred.keep_out_m
    rows = []
    for flight in ("v-bar", "r-bar"):
        for phase, ends in (("far", (5.0 * r1, 1.05 * r1 - depth)), ("mid", (1.1 * r1, 0.1 * r1))):
            for number, y in enumerate(np.linspace(*ends, 6)):
                rows.append([flight, phase, 30.0 * number, 0.0, y, *[0.0] * 7])
    return pd.DataFrame(rows, columns=["flight", "phase", "time_s", *STATE, *CHANGE])


@pytest.fixture(scope="module")
def on(grounds):
    """The grounds for a section of the configuration and results."""
    return lambda section, results: grounds("rendezvous", section, results)


@pytest.fixture(scope="module")
def results(tmp_path_factory, section):
    folder = tmp_path_factory.mktemp("results")
    made_up(section).to_parquet(folder / "flights.parquet")
    return folder


PROOFS = [
    "control_bound_unit",
    "initial_distance",
    "thrust_as_delta_v",
    "impulse_matrix",
    "drag_direction",
    "on_time",
    "last_state_twice",
    "quadratic_stage_cost",
    "docking_cone_apex",
    "rendezvous_end_distance",
    "rendezvous_end_cone",
    "approach_end_vector",
]


@pytest.mark.parametrize("name", PROOFS)
def test_proof_holds(section, results, name, on):
    """Each erratum is proven with the document's own configuration."""
    proof = getattr(errata, name)(on(section, results))
    assert proof.holds, proof.statement


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        # Another thruster, of which the bounds are no whole seconds.
        ("control_bound_unit", "spacecraft.thruster_N", 0.37),
        # So strong a thruster that the bounds are accelerations within its reach.
        ("control_bound_unit", "spacecraft.thruster_N", 14 * 0.1786),
        ("initial_distance", "start.position_m", [140.0, -1690.0, 60.0]),
        ("thrust_as_delta_v", "spacecraft.thruster_N", 5.0),
        # In so short a step nothing is moved that one could see.
        ("impulse_matrix", "phases.far.sample_time_s", 0.1),
        # With samples of a second force and impulse are the same number.
        ("on_time", "phases.far.sample_time_s", 1.0),
        ("docking_cone_apex", "inferred.rotation_rate_rad_s", 0.0),
        # After so long a horizon there is no state left to count twice.
        ("last_state_twice", "phases.final.horizon", 4000),
    ],
)
def test_proof_fails_where_the_document_would_be_right(
    section, results, name, key, value, on, changed
):
    """A configuration in which the printed version is as good: the proof must not hold."""
    assert not getattr(errata, name)(on(changed(section, key, value), results)).holds


def test_the_end_of_the_far_range_would_hold_inside_the_zone(section, tmp_path, on):
    """With samples inside the zone the printed end could come."""
    made_up(section, depth=60.0).to_parquet(tmp_path / "flights.parquet")
    assert not errata.rendezvous_end_distance(on(section, tmp_path)).holds


def test_the_corrected_end_of_the_far_range_must_be_what_is_flown(section, results, on, changed):
    """Measured along the axis, or ended farther off than the distance, the phase ends otherwise."""
    for key, value in (("readings.switches", "along axis"), ("switch_1", 1.001)):
        other = changed(section, f"inferred.{key}", value)
        assert not errata.rendezvous_end_distance(on(other, results)).holds


def test_the_end_of_the_mid_range_needs_a_sample_that_is_far(section, tmp_path, on, changed):
    """A flight that is within r2 all the time shows nothing."""
    near = made_up(section)
    near[STATE[:3]] = 0.0
    near.to_parquet(tmp_path / "flights.parquet")
    start = changed(section, "start.position_m", [0.0, -1.0, 0.0])
    assert not errata.approach_end_vector(on(start, tmp_path)).holds


def test_the_mid_range_must_come_by_the_octant(section, tmp_path, on):
    """Flown beside the axis by more than r2, the mirrored flight meets the condition nowhere."""
    beside = made_up(section)
    beside["z_m"] = -3.0 * law(section, "v-bar").overshoot
    beside.to_parquet(tmp_path / "flights.parquet")
    assert not errata.approach_end_vector(on(section, tmp_path)).holds


def test_the_cone_must_be_entered(section, tmp_path, on):
    """With a mid range that begins outside the cone the corrected condition ends nothing."""
    outside = made_up(section)
    outside["x_m"] = outside["y_m"]
    outside.to_parquet(tmp_path / "flights.parquet")
    assert not errata.rendezvous_end_cone(on(section, tmp_path)).holds


def test_a_quadratic_form_printed_would_be_no_erratum(section, monkeypatch, on):
    """With u' R u printed the proof does not hold."""
    monkeypatch.setattr(errata, "printed_stage_cost", lambda u, weight: float(u @ (weight * u)))
    given = on(section, Path("nowhere"))
    assert not errata.quadratic_stage_cost(given).holds


def test_a_drag_along_the_flow_is_no_erratum(monkeypatch, section, on):
    """With the flow's direction on the right the proof does not hold."""
    monkeypatch.setattr(errata, "printed_drag", lambda flow, _: -flow * np.linalg.norm(flow))
    assert not errata.drag_direction(on(section, Path("nowhere"))).holds


def flown(folder, reading, **totals):
    """Made-up phases: (time, delta-v) a case, that did not dock where the time is zero."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = [
        [case.replace("_", "-"), phase, time > 0, time / 3, delta_v / 3]
        for case, (time, delta_v) in totals.items()
        for phase in ("far", "mid", "final")
    ]
    columns = ["flight", "phase", "ended", "time_s", reading]
    pd.DataFrame(rows, columns=columns).to_csv(folder / "phases.csv", index=False)


@pytest.mark.parametrize(
    ("second", "acceptable", "outcome"),
    [
        ([(1500, 12.0)] * 5, [True] * 5, "holds"),
        ([(1730, 14.0)] * 5, [True] * 5, "undecided"),  # the configured set says otherwise
        ([(1500, 12.0)] * 4 + [(1730, 14.5)], [True] * 5, "holds"),  # four of five
        ([(1500, 12.0)] * 3 + [(1730, 14.5)] * 2, [True] * 5, "undecided"),
        # A set that misses the printed time of a case by more than a tenth is no witness.
        ([(1500, 12.0)] * 3 + [(1900, 14.5)] * 2, [True] * 5, "holds"),
        # Sets that are not acceptable do not count.
        ([(1500, 12.0)] * 3 + [(1730, 14.5)] * 2, [True] * 3 + [False] * 2, "holds"),
        # A set that does not dock cannot tell; half of the sets must be able to.
        ([(1500, 12.0)] * 3 + [(0, 0.0)] * 2, [True] * 5, "holds"),
        ([(1500, 12.0)] * 2 + [(0, 0.0)] * 3, [True] * 5, "undecided"),
    ],
)
def test_a_claim_needs_the_stated_share_of_the_ensemble(
    section, tmp_path, second, acceptable, outcome, on
):
    """Case 2 takes less than Case 1 with the configured set, and with so many of five others."""
    size = section.inference.ensemble.with_(sets=len(second), agree=0.8)
    section = section.with_(inference=section.inference.with_(ensemble=size))
    reading = section.inferred.readings.delta_v
    flown(tmp_path, reading, v_bar=(1744, 13.3), r_bar=(1579, 12.1))
    for number, (case, accepted) in enumerate(zip(second, acceptable, strict=True), start=1):
        folder = tmp_path / f"ensemble/{number:02d}"
        flown(folder, reading, v_bar=(1744, 13.3), r_bar=case)
        row = ParameterSet.configured(section).row | {"delta_v": reading, "acceptable": accepted}
        pd.DataFrame([row]).to_csv(folder / "set.csv", index=False)
    judged = claims.r_bar_takes_less(on(section, tmp_path))
    assert judged.outcome == outcome, judged.evidence


def test_claims_that_need_no_flight(section, tmp_path, on):
    """Arithmetic of the printed tables, and the count of thrusters."""
    given = on(section, tmp_path)
    assert claims.totals_add_up(given).outcome == "holds"
    assert claims.times_are_whole_samples(given).outcome == "holds"
    assert claims.velocity_is_of_a_stable_ellipse(given).outcome == "holds"
    assert claims.six_thrusters_move_in_six_degrees(given).outcome == "fails"


def test_the_same_claims_can_come_out_otherwise(section, tmp_path, on, changed):
    """Other samples, another velocity, eight thrusters."""
    other = changed(section, "phases.mid.sample_time_s", 30.0)
    other = changed(other, "start.velocity_m_s", [-0.90, -0.42, 0.0])
    given = on(changed(other, "spacecraft.thrusters", 12), tmp_path)
    assert claims.times_are_whole_samples(given).outcome == "fails"
    assert claims.velocity_is_of_a_stable_ellipse(given).outcome == "fails"
    assert claims.six_thrusters_move_in_six_degrees(given).outcome == "holds"


def test_the_law_reads_the_inferred_values(section):
    """Shares become metres, full angles are halved, the R-bar has the inferred side."""
    inferred = section.inferred
    given = law(section, "r-bar")
    assert given.set_points[0] == pytest.approx(inferred.set_point_1 * inferred.keep_out_m)
    approach, docking = (
        {"half": 1.0, "full": 0.5}[inferred.readings[f"{cone}_cone"]]
        for cone in ("approach", "docking")
    )
    angles = np.array([15.0 * approach, 15.0 * approach, 8.0 * docking])
    assert np.degrees(given.cone_angles) == pytest.approx(angles)
    assert (
        given.axis == {"above": (1.0, 0.0, 0.0), "below": (-1.0, 0.0, 0.0)}[inferred.readings.r_bar]
    )
