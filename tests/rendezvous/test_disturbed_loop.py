"""The loop with disturbances: against the linear one, and against itself in other batches."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state
from smallsat.studies.rendezvous.monte_carlo.cases import base, cases, in_phase
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table
from smallsat.studies.rendezvous.monte_carlo.runs import simulate_cases
from smallsat.studies.rendezvous.simulation import pool
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.disturbances import disturbed_motion, nonlinear_motion
from smallsat.studies.rendezvous.simulation.motion import BURNS, COMMANDED


@pytest.fixture(scope="module")
def starts(section):
    """Six initial states of the studies, well outside the keep-out zone."""
    table = states_table(section, 20, 11)
    far = table[table["distance_m"] > 2.0 * section.inferred.keep_out_m].head(6)
    return far[["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"]].to_numpy()


def streams(count, seed=3):
    return [stream(seed, k) for k in range(count)]


def test_without_disturbances_it_is_the_linear_loop_but_for_the_field(section, starts):
    """Two-body truth, no drag, no noise: delta-v of the far range within 3 % in the median.

    What is left is the curvature of the orbit over a kilometre and the length of the pulses.
    """
    law = base(section)
    truth = section.truth.with_(gravity_degree=0, gravity_order=0, density_factor=0.0)
    calm = section.with_(truth=truth)
    motion = disturbed_motion(calm, law, thrust_error=False, measurement_error=False)
    flown = simulate([law], starts, (0, 0), motion, streams(len(starts)))
    linear = simulate([law], starts, (0, 0))
    assert flown.docked.all() and linear.docked.all()
    change = flown.delta_v[:, 0] / linear.delta_v[:, 0] - 1.0
    assert abs(np.median(change)) < 0.03
    assert np.abs(flown.steps[:, 0] - linear.steps[:, 0]).max() <= 3


@pytest.mark.parametrize("actuation", [COMMANDED, BURNS])
def test_ledger_of_the_nonlinear_motion_closes(section, starts, actuation):
    """Each recorded state follows from the last one and its command by the bodies' motion alone."""
    law = base(section)
    motion = nonlinear_motion(section, law, actuation)
    steps = simulate([law], starts[0], (0, 0), motion, streams(1), with_steps=True).record(0)
    pair = pair_from_relative(motion.target, starts[0])
    on_times, burn = np.zeros(3), np.zeros(3)
    assert len(steps.time) > 10
    for time, state, command in zip(steps.time, steps.state, steps.impulse, strict=True):
        np.testing.assert_array_equal(state, relative_state(pair))
        if actuation == BURNS:
            pulse_on_times(command, motion.mass, motion.force, 0.0, 0.0, on_times)
            thrust_acceleration(command, motion.mass, motion.force, burn)
        else:
            pair = pair_from_relative(pair[0], state + np.concatenate([np.zeros(3), command]))
        advance(pair, time, law.sample_times[0], burn, on_times, motion.environment)


def test_a_manoeuvre_does_not_depend_on_its_batch(section, starts):
    """Alone or among others, to the last bit: it has a random stream of its own."""
    law = base(section)
    motion = disturbed_motion(section, law)
    together = simulate([law], starts, (0, 1), motion, streams(len(starts)))
    for m in (0, len(starts) - 1):
        alone = simulate([law], starts[m : m + 1], (0, 1), motion, [stream(3, m)])
        np.testing.assert_array_equal(alone.ends[0], together.ends[m])
        np.testing.assert_array_equal(alone.delta_v[0], together.delta_v[m])


def test_a_manoeuvre_does_not_depend_on_how_its_numbers_come(section, starts, monkeypatch):
    """A few at a time, or all at once: the same stream, so the same to the last bit."""
    law = base(section)
    motion = disturbed_motion(section, law)
    found = {}
    for numbers in (19, 1024):
        monkeypatch.setattr(pool, "NUMBERS", numbers)
        found[numbers] = simulate([law], starts, (0, 1), motion, streams(len(starts)))
    assert 8 * found[19].steps.sum(axis=1).min() > 3 * 19
    np.testing.assert_array_equal(found[19].ends, found[1024].ends)
    np.testing.assert_array_equal(found[19].delta_v, found[1024].delta_v)


def test_passages_are_what_manoeuvres_with_that_distance_and_limit_do(section, starts):
    """One manoeuvre to the smallest distance tells the outcome at a larger one, and at a limit."""
    distances, limit = (0.2, 0.4), 2400.0
    law = base(section)
    closest = replace(law, switch_distances=in_phase(law.switch_distances, 2, distances[0]))
    motion = disturbed_motion(section, closest)
    numbers = streams(len(starts))
    passed = simulate(
        [closest], starts, motion=motion, generators=numbers, distances=distances, limits=[limit]
    ).passages
    for i, distance in enumerate(distances):
        other = replace(
            law, switch_distances=in_phase(law.switch_distances, 2, distance), time_limit=limit
        )
        flown = simulate([other], starts, motion=motion, generators=streams(len(starts)))
        docked = passed.times[:, i] <= limit
        np.testing.assert_array_equal(flown.docked, docked)
        times, spent = flown.end_times.max(axis=1), flown.delta_v.sum(axis=1)
        np.testing.assert_array_equal(times[docked], passed.times[docked, i])
        np.testing.assert_allclose(spent[docked], passed.delta_v[docked, i], rtol=1e-12)
        np.testing.assert_allclose(spent[~docked], passed.delta_v_at_limits[~docked, 0], rtol=1e-12)


def test_the_thrust_error_changes_what_is_burnt_and_nothing_else_draws_its_numbers(section, starts):
    """Variants share their random numbers: with both errors off, streams do not matter."""
    law = base(section)
    calm = disturbed_motion(section, law, thrust_error=False, measurement_error=False)
    one = simulate([law], starts[:2], (0, 0), calm, streams(2))
    other = simulate([law], starts[:2], (0, 0), calm, streams(2, seed=9))
    np.testing.assert_array_equal(one.ends, other.ends)
    wrong = disturbed_motion(section, law, measurement_error=False)
    third = simulate([law], starts[:2], (0, 0), wrong, streams(2))
    assert not np.array_equal(third.delta_v, one.delta_v)


@pytest.mark.parametrize("group", ["approach-sweep", "robustness"])
def test_shards_fly_what_the_whole_flies(section, starts, group):
    """Rows of three shards, put together, equal the rows of one: schema, values and order."""
    flown = cases(section, group)[:2]
    table = pd.DataFrame(starts, columns=["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"])
    if group == "approach-sweep":
        # On the approach axis, where that phase begins.
        table[:] = 0.0
        table["y_m"] = 100.0 + np.arange(len(table))
    table["sample"] = np.arange(len(table), dtype=np.int32)
    table["run"] = np.int32(0)
    short = [replace(case, phases=(case.phases[0], min(case.phases[1], 1))) for case in flown]
    whole = simulate_cases(section, short, [table] * 2)
    parts = pd.concat(
        [simulate_cases(section, short, [table.iloc[k::3]] * 2) for k in range(3)],
        ignore_index=True,
    )
    key = ["case", "sample", "run"]
    pd.testing.assert_frame_equal(
        whole.sort_values(key, ignore_index=True), parts.sort_values(key, ignore_index=True)
    )
