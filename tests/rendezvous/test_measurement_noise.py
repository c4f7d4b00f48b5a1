"""Measurement errors that fall with the range: the law, and where the disturbed loop has it."""

import numpy as np
import pytest

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.model.measurement_noise import error_share
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.disturbances import disturbed_motion
from smallsat.studies.rendezvous.simulation.motion import begin, next_estimate, relative


@pytest.mark.parametrize(
    ("distance", "share"), [(5000.0, 1.0), (250.0, 1.0), (125.0, 0.5), (25.0, 0.1), (0.0, 0.1)]
)
def test_errors_are_full_far_away_and_fall_in_proportion_to_the_range(distance, share):
    """Full from 250 m on, half at half of it, never below a tenth; direction does not matter."""
    for direction in np.random.default_rng(1).normal(size=(5, 3)):
        position = distance * direction / np.linalg.norm(direction)
        state = np.concatenate([position, [1.0, 2.0, 3.0]])
        assert error_share(state, 250.0, 0.1) == pytest.approx(share, rel=1e-12)
        assert error_share(state, 0.0, 1.0) == 1.0


@pytest.mark.parametrize(("distance", "share"), [(600.0, 1.0), (60.0, 0.2), (1.0, 0.05)])
def test_the_loop_measures_with_these_deviations(section, distance, share):
    """4000 measurements at rest: root mean square errors within 3 % of what the law says.

    Their sampling error is 0.65 %, for 12 000 numbers.
    """
    law = base(section).with_(switch_distances=(300.0, 20.0, 0.1))
    motion = disturbed_motion(section, law, near_error_share=0.05)
    start = np.array([0.0, distance, 0.0, 0.0, 0.0, 0.0])
    state = relative(motion, begin(motion, start))
    estimates, covariance = np.empty((4000, 6)), np.empty((6, 6))
    numbers, drawn = stream(5, 1).standard_normal(estimates.size), np.zeros(1, np.int64)
    for estimate in estimates:
        next_estimate(motion, 2, 5.0, np.zeros(3), state, numbers, drawn, estimate, covariance)
    assert drawn[0] == len(numbers)
    found = np.sqrt(((estimates - state) ** 2).reshape(-1, 2, 3).mean(axis=(0, 2)))
    table = section.studies.robustness
    expected = share * np.array([table.position_deviation_m, table.velocity_deviation_m_s])
    np.testing.assert_allclose(found, expected, rtol=0.03)


def test_far_manoeuvres_do_not_know_of_sensors_near(section):
    """To the last bit until the chaser comes within the distance, and no longer than that."""
    law = base(section)
    start = states_table(section, 1, 11)[STATE].to_numpy()
    assert np.linalg.norm(start[0, :3]) > law.switch_distances[0]
    flown = [
        simulate(
            [law], start, (0, 1), disturbed_motion(section, law, near_error_share=share),
            [stream(3, 0)], with_steps=True,
        ).record(0)
        for share in (1.0, 0.1)
    ]  # fmt: skip
    alike = [np.array_equal(*pair) for pair in zip(flown[0].state, flown[1].state, strict=False)]
    distances = np.linalg.norm(flown[0].state[:, :3], axis=1)
    # The first better measurement is the first within the distance; a step later it has acted.
    first = int(np.argmax(distances < law.switch_distances[0]))
    assert alike.index(False) == first + 1
