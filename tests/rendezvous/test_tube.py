"""The docking phase's tube: margins against the worst case and the spread, and what it keeps."""

import numpy as np
import pytest

from smallsat.dynamics.orbits.clohessy_wiltshire import transition
from smallsat.studies.rendezvous.guidance.controller import memory_for, next_control
from smallsat.studies.rendezvous.guidance.law import DOCKING, settings
from smallsat.studies.rendezvous.guidance.tube import (
    Disturbances,
    Margins,
    deviation,
    hold,
    invariant_margins,
    room,
    stationary_margins,
    tip_distance,
    tube_law,
)
from smallsat.studies.rendezvous.methods.constraint_check import violations
from smallsat.studies.rendezvous.monte_carlo.cases import base
from smallsat.studies.rendezvous.monte_carlo.docking_flights import docking_flights
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table
from smallsat.studies.rendezvous.monte_carlo.tubes import flown_margins, sizes
from smallsat.studies.rendezvous.simulation.closed_loop import simulate

NOISE = Disturbances(position=0.004, velocity=0.0001, thrust=0.0003)


def cone_rows(law):
    """The faces of the cone about the V-bar, as rows on the state, (4, 6)."""
    c, s = np.cos(law.cone_angles[DOCKING]), np.sin(law.cone_angles[DOCKING])
    faces = [[c, -s, 0.0], [-c, -s, 0.0], [0.0, -s, c], [0.0, -s, -c]]
    return np.hstack([faces, np.zeros((4, 3))])


def test_worst_disturbances_reach_the_invariant_margins_and_none_exceeds_them(law):
    """Signs chosen backwards in time for each row: the worst of them has the margin, to 1e-8.

    Deviations of 3000 steps with random signs stay below.
    """
    moved, margins = deviation(law, NOISE), invariant_margins(law, NOISE)
    effects = [moved.inputs]
    for _ in range(400):
        effects.append(moved.transition @ effects[-1])

    def worst(row):
        return row @ sum(effect @ np.sign(row @ effect) for effect in effects)

    assert max(map(worst, cone_rows(law))) == pytest.approx(margins.cone, rel=1e-8)
    assert max(map(worst, np.eye(6)[3:])) == pytest.approx(margins.speed, rel=1e-8)
    random, state = np.random.default_rng(2), np.zeros(6)
    for _ in range(3000):
        state = moved.transition @ state + moved.inputs @ random.choice([-1.0, 1.0], 9)
        assert (cone_rows(law) @ state).max() < margins.cone
        assert np.abs(state[3:]).max() < margins.speed


def test_stationary_margins_are_standard_deviations(law):
    """5000 deviations after 100 steps of normal disturbances, within 4 %, four sampling errors."""
    moved, margins = deviation(law, NOISE), stationary_margins(law, NOISE)
    random, states = np.random.default_rng(3), np.zeros((5000, 6))
    for _ in range(100):
        states = states @ moved.transition.T
        states += random.standard_normal((5000, 9)) @ moved.inputs.T
    seen = random.standard_normal((5000, 9)) @ moved.seen.T
    faces = (states @ cone_rows(law).T).std(axis=0)
    assert faces.max() == pytest.approx(margins.cone, rel=0.04)
    assert states[:, 3:].std(axis=0).max() == pytest.approx(margins.speed, rel=0.04)
    control = states @ moved.gain.T + seen
    assert control.std(axis=0).max() == pytest.approx(margins.control, rel=0.04)


def test_the_feedback_adds_to_the_nominal_control_and_the_nominal_state_moves_alone(law):
    """By the definition, to 1e-12; a large deviation is held at the thrusters' bound."""
    held = tube_law(law, deviation(law, NOISE).gain, Margins(0.1, 0.001, 0.002))
    record = settings([held])[0]
    random = np.random.default_rng(4)
    nominal = np.array([0.2, 8.0, -0.1, 0.0, -0.02, 0.001])
    estimate = nominal + random.normal(0.0, [0.05] * 3 + [0.001] * 3)
    control = np.array([0.001, -0.002, 0.0005])
    command, moved = control.copy(), nominal.copy()
    hold(record, estimate, moved, command)
    feedback = held.feedback @ (estimate - nominal)
    np.testing.assert_allclose(command, control + feedback, rtol=1e-12)
    after = transition(law.mean_motion, law.sample_times[DOCKING]) @ (
        nominal + np.r_[np.zeros(3), control]
    )
    np.testing.assert_allclose(moved, after, rtol=1e-12, atol=1e-15)
    hold(record, nominal + 1e3, nominal.copy(), command)
    assert np.abs(command).max() == pytest.approx(law.control_bounds[DOCKING], rel=1e-12)


def test_without_disturbances_and_width_it_is_the_law_itself(law, chasers):
    """In the linear motion the nominal state is the state: same steps, ends within 0.1 mm."""
    held = tube_law(law, deviation(law, NOISE).gain, Margins(0.0, 0.0, 0.0))
    plain, path = (simulate([one], chasers[:4]) for one in (law, held))
    np.testing.assert_array_equal(path.steps, plain.steps)
    np.testing.assert_allclose(path.ends, plain.ends, atol=1e-4)


def docked(law, noise, seed):
    """Largest violations of the untightened cone and speed, m and m/s, of a disturbed docking.

    Linear motion from 8 m at rest, disturbances at their bounds with random signs, 80 steps.
    """
    record, memory = settings([law])[0], memory_for(max(law.horizons))
    matrix = transition(law.mean_motion, law.sample_times[DOCKING])
    random, command = np.random.default_rng(seed), np.zeros(3)
    state = np.array([0.0, 8.0, 0.0, 0.0, 0.0, 0.0])
    nominal, worst = state.copy(), {"cone": -np.inf, "speed": -np.inf}
    memory.remaining[0] = 0
    for step in range(80):
        signs = random.choice([-1.0, 1.0], 9)
        error = signs[:6] * ([noise.position] * 3 + [noise.velocity] * 3)
        estimate = state + error
        time = step * law.sample_times[DOCKING]
        if law.feedback is None:
            next_control(record, DOCKING, estimate, time, memory, command)
        else:
            next_control(record, DOCKING, nominal, time, memory, command)
            hold(record, estimate, nominal, command)
        state = matrix @ (state + np.r_[np.zeros(3), command + noise.thrust * signs[6:]])
        found = violations(law, DOCKING, state, time)
        worst = {name: max(worst[name], found[name]) for name in worst}
    return worst


def test_a_tube_keeps_the_constraints_that_the_law_alone_does_not(law):
    """Ten dockings with disturbances at their bounds: no violation; without the tube, some.

    The tube fits: 8 m from the port the tightened cone is there.
    """
    margins = invariant_margins(law, NOISE)
    assert tip_distance(law, margins) < 7.0 and margins.speed < law.speed_bound
    held = tube_law(law, deviation(law, NOISE).gain, margins)
    for seed in range(10):
        kept = docked(held, NOISE, seed)
        assert kept["cone"] < 0.0 and kept["speed"] < 0.0
    lost = [docked(law, NOISE, seed) for seed in range(10)]
    assert any(one["cone"] > 0.0 for one in lost) and any(one["speed"] > 0.0 for one in lost)


def test_the_flown_tube_lets_the_chaser_dock(section):
    """Its cone begins at the share of the docking distance; the whole tube's would not.

    Margins of a measurement alone go with its deviation.
    """
    law, share = base(section), section.studies.robustness.tube.share
    margins = flown_margins(section, law, 1.0)
    assert tip_distance(law, margins) <= share * law.switch_distances[DOCKING] * (1.0 + 1e-12)
    assert margins.speed < law.speed_bound and margins.control < law.control_bounds[DOCKING]
    assert margins.within(room(law, share)) == margins
    assert margins.scale(room(law, share)) == pytest.approx(1.0)
    assert Margins(0.0, 0.0, 0.0).scale(room(law, share)) == np.inf
    table = sizes(section, law)
    assert (table.loc[table["source"] == "both", "scale"] < 1.0).all()
    for _, rows in table[table["source"] == "measurement"].groupby("tube"):
        tips = rows.set_index("error_share")["tip_m"]
        np.testing.assert_allclose(tips / tips[1.0], tips.index, rtol=1e-9)


def test_docking_flights_are_those_of_the_cases(section):
    """Two states, two runs: a row a case, ways from where docking begins to the port, counts."""
    robustness = section.studies.robustness.with_(variant_runs=2)
    small = section.with_(studies=section.studies.with_(robustness=robustness))
    found = docking_flights(small, states_table(section, 2, robustness.seed))
    kept, ways = found["constraints"], found["ways"]
    assert (kept["manoeuvres"] == 4).all() and kept["case"].is_unique
    for share in ("cone_samples_pct", "speed_samples_pct"):
        assert kept[share].between(0.0, 100.0).all()
    assert (kept["cone_median_m"] <= kept["cone_high_m"]).all()
    assert set(ways["case"]) == set(kept["case"])
    for _, way in ways.groupby(["case", "run"]):
        assert way["time_s"].iloc[0] == 0.0
        assert (np.diff(way["time_s"]) == section.phases.final.sample_time_s).all()
        assert way["distance_m"].iloc[-1] < way["distance_m"].iloc[0]
