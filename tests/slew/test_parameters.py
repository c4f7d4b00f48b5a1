"""What follows from the quaternions, and what contradicts and is refused."""

import numpy as np
import pytest

from smallsat.errors import InputError
from smallsat.studies.slew.methods.bound import bound_time, needed
from smallsat.studies.slew.methods.minimum_time import DOCUMENT_GUESS, guess
from smallsat.studies.slew.methods.one_axis import eigenaxis_time
from smallsat.studies.slew.methods.plan_names import MODELS, plan_titles
from smallsat.studies.slew.parameters import Parameters, check, half_angle_deg, quarter_angle_deg


def about(axis, angle_deg):
    """Quaternion of a turn about an axis, scalar last."""
    half = np.radians(angle_deg) / 2.0
    return [*(np.sin(half) * np.array(axis) / np.linalg.norm(axis)).tolist(), float(np.cos(half))]


def test_printed_angles_follow_from_the_quaternions(section):
    """Exactly 90 and 180 deg, as printed."""
    assert quarter_angle_deg(section) == 90.0
    assert half_angle_deg(section) == 180.0


@pytest.mark.parametrize("angle", [45.0, 120.0])
def test_names_follow_the_turns(section, changed, angle):
    """A turn is called by its angle whatever its axis, and relative to where it begins."""
    start = about((1.0, 2.0, -1.0), 70.0)
    turned = changed(section, "manoeuvre.initial_quaternion", [0.0, 0.0, 0.0, 1.0])
    turned = changed(turned, "manoeuvre.half.target_quaternion", about((1.0, 1.0, 1.0), angle))
    parameters = Parameters.from_section(turned)
    assert parameters.angle_deg("half") == pytest.approx(angle)
    assert parameters.names["half"] == f"{angle:g} deg"
    np.testing.assert_allclose(parameters.axis("half"), np.full(3, 3**-0.5))
    moved = changed(turned, "manoeuvre.initial_quaternion", start)
    assert Parameters.from_section(moved).angle_deg("half") != pytest.approx(angle)


def test_turns_of_one_angle_have_two_names(section, changed):
    """Else one table would hold two plans of one name."""
    same = changed(section, "manoeuvre.quarter.target_quaternion", about((1.0, 0.0, 0.0), 180.0))
    names = Parameters.from_section(same).names
    assert names == {"quarter": "180 deg, quarter", "half": "180 deg, half"}


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("manoeuvre.half.target_quaternion", [0.0, 0.0, 0.0, 1.0], ("half.target", "initial")),
        ("manoeuvre.quarter.target_quaternion", [0.0, 0.0, 0.0, -1.0], ("quarter.target",)),
        ("spacecraft.size_m.length", 0.2, ("panel_area_m2.side", "0.03", "0.02")),
        ("spacecraft.size_m.height", 0.2, ("panel_area_m2.side", "length times height")),
        ("spacecraft.panel_area_m2.end", 0.02, ("panel_area_m2.end", "breadth times height")),
        ("orbit.eccentricity", 0.1, ("orbit.eccentricity", "6100.2", "6378")),
        ("onboard.step_s", 101.0, ("onboard.step_s", "duration_s 100")),
        ("resampling_hz", 0.001, ("resampling_hz", "0.001")),
        ("environment.density_factors", [0.5, 2.0], ("density_factors", "factor 1")),
    ],
)
def test_what_contradicts_is_refused(section, changed, key, value, words):
    """One line that names the key, the value and what would agree."""
    check(section)
    with pytest.raises(InputError) as refusal:
        check(changed(section, key, value))
    for word in words:
        assert word in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_guesses_of_least_times_follow_body_and_wheels(section, parameters, changed):
    """The document's own for its turns; twice the time for a quarter of the torque."""
    assert {case: guess(parameters, case) for case in DOCUMENT_GUESS} == DOCUMENT_GUESS
    weak = Parameters.from_section(changed(section, "wheels.torque_mN_m", 0.025))
    assert guess(weak, "half") == pytest.approx(2.0 * DOCUMENT_GUESS["half"])


def test_a_full_wheel_coasts(parameters):
    """By hand: the momentum over the torque to fill it, and the rest of the angle at its rate."""
    angle, moment, torque, momentum = np.pi, 0.126, 6.25e-4, 10.3e-3
    time = eigenaxis_time(angle, moment, torque, momentum)
    filling = momentum / torque
    turned = momentum / moment * (time - filling)
    assert turned == pytest.approx(angle)
    assert time > 2.0 * np.sqrt(angle * moment / torque)


def test_bound_is_that_of_the_turn(section, parameters, changed):
    """A smaller turn is proven impossible in less time only; one about x not at all."""
    assert needed(parameters, "half") == pytest.approx(np.pi)
    third = Parameters.from_section(
        changed(section, "manoeuvre.half.target_quaternion", about((0, 0, 1), 120))
    )
    assert bound_time(third, True) < bound_time(parameters, True)
    rolled = Parameters.from_section(
        changed(section, "manoeuvre.half.target_quaternion", [1.0, 0.0, 0.0, 0.0])
    )
    assert bound_time(rolled, True) == 0.0
    weak = Parameters.from_section(changed(section, "wheels.torque_mN_m", 1e-4))
    assert bound_time(weak, False) == pytest.approx(np.sqrt(1e3) * bound_time(parameters, False))


def test_bound_counts_products_of_inertia(section, parameters, changed):
    """The rates that a momentum can make grow with them, and the bound must not exclude those."""
    tensor = [[0.059, 0.02, 0.0], [0.02, 0.114, -0.03], [0.0, -0.03, 0.126]]
    other = Parameters.from_section(changed(section, "spacecraft.inertia_kg_m2", tensor))
    assert bound_time(other, False) < bound_time(parameters, False)


def test_titles_say_what_is_known(section, changed):
    """Impossible only where the bound of that model proves it, and each model by its name."""
    later = changed(section, "manoeuvre.duration_s", 104.0)
    for timed, words in (
        (section, ("no plan can", "none was found")),
        (later, ("none was found",) * 2),
    ):
        titles = plan_titles(timed, "half")
        assert len(titles) == 2
        for model, title, said in zip(MODELS, titles, words, strict=True):
            feasible, least = title.values()
            assert feasible == model
            assert least.startswith(model) and said in least
    (only,) = plan_titles(later, "quarter")
    assert next(iter(only.values())) == ""
