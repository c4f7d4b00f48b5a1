"""What the configuration's check and types refuse, in one line each."""

import pytest

from smallsat.config import merged, validate
from smallsat.errors import InputError
from smallsat.studies.rendezvous.parameters import CASES, check, law, start_state


@pytest.mark.parametrize(
    "key, value, words",
    [
        ("start.position_m", [10.0, -50.0, 0.0], "inside the keep-out zone"),
        ("inferred.overshoot_m", 5000.0, "must be less than"),
        ("phases.far.horizon", 0, "must be at least 1"),
        ("phases.mid.sample_time_s", -20.0, "must be at least 0.1"),
        ("phases.final.cone_angle_deg", 90.0, "must be less than"),
        ("plane_rate", 0.0, "must be greater than 0"),
        ("inferred.readings.planes", "tilted", "must be one of"),
        ("inference.ensemble.agree", 0.5, "must be greater than"),
        ("phases.far.control_bound_m_s", 0.0, "must be greater than 0"),
        ("phases.final.control_bound_m_s", 0.5, "burn 14 s for it"),
        ("inferred.mean_motion_rad_s", 0.00125, "Earth's surface"),
        ("inference.bounds.set_point_1", [1.1, 1.1], "must grow"),
        ("studies.delay.delays_s", [0.5, 5.5], "5.5 is not allowed"),
        ("studies.rendezvous.sample_times_s", [20.0, 13000.0], "must be at most"),
        ("studies.approach.horizons", [15, 5], "must grow"),
        ("studies.passages.limits_min", [100.0, 60.0], "must grow"),
        ("studies.distance_km", [2.5, 0.15], "must grow"),
    ],
)
def test_bad_input_is_refused_in_one_line(config, key, value, words):
    key = f"rendezvous.{key}"
    for part in reversed(key.split(".")):
        value = {part: value}
    with pytest.raises(InputError) as refusal:
        check(validate(merged(config.model_dump(), value), type(config)).rendezvous)
    line = str(refusal.value)
    assert words in line and "\n" not in line
    assert key in line


def test_the_default_is_accepted(section):
    check(section)
    assert {law(section, case).horizons for case in CASES} == {(30, 15, 12)}
    assert start_state(section).shape == (6,)
