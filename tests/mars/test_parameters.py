"""What no type can refuse, and what follows instead of being refused."""

import pytest

from smallsat.errors import InputError
from smallsat.studies.mars.parameters import MARS_MU, check


def test_the_documents_own_values_agree(section):
    """Altitudes, rates and times as printed."""
    check(section)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("orbits.lmo.altitude_km", 500.0, ("lmo.rate_rad_s", "500", "0.000850953")),
        ("orbits.gmo.rate_rad_s", 7.09e-5, ("gmo.rate_rad_s", "7.090032e-05")),
        ("orbits.mars_radius_km", 6378.0, ("lmo.rate_rad_s",)),
        ("spacecraft.inertia_kg_m2", [1.0, 3.0, 1.0], ("of no body", "sum of the other two")),
        ("step_s", 0.3, ("durations_s.response", "multiple of step_s 0.3")),
        ("durations_s.response", 300.0, ("answer_times_s.no_torque", "within the run's 300 s")),
        ("answer_times_s.mission", [300.0, 7000.0], ("answer_times_s.mission.1", "7000")),
        ("answer_times_s.pointing", [15.5], ("answer_times_s.pointing.0", "15.5")),
    ],
)
def test_keys_that_contradict_one_another(section, changed, key, value, words):
    """One line that names the key, the value and what would agree."""
    with pytest.raises(InputError) as refusal:
        check(changed(section, key, value))
    for word in words:
        assert word in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_the_rate_that_the_line_names_is_taken(section, changed):
    """Its digits are enough; half a unit of the sixth is not let pass."""
    higher = changed(section, "orbits.lmo.altitude_km", 500.0)
    radius = 1e3 * (section.orbits.mars_radius_km + 500.0)
    rate = (MARS_MU / radius**3) ** 0.5
    check(changed(higher, "orbits.lmo.rate_rad_s", float(f"{rate:.7g}")))
    with pytest.raises(InputError, match="does not belong"):
        check(changed(higher, "orbits.lmo.rate_rad_s", rate * (1.0 + 2e-6)))


def test_a_flat_plate_is_a_body(section, changed):
    """The largest moment may equal the sum of the others."""
    check(changed(section, "spacecraft.inertia_kg_m2", [10.0, 5.0, 15.0]))
