"""The compiled closed loop, against the plain one and its own ledger."""

from itertools import pairwise

import numpy as np
import pytest
import reference_loop
from scipy.integrate import solve_ivp

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.guidance import law as guidance
from smallsat.studies.rendezvous.guidance.controller import memory_for, next_control
from smallsat.studies.rendezvous.methods import constraint_check, qp_solvers
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.motion import add_burns

CASES = ["v-bar", "r-bar", "rotating"]


@pytest.fixture(scope="module")
def flown(laws, chaser):
    cases = list(laws.values())
    return simulate(cases, np.tile(chaser, (len(cases), 1)), with_steps=True)


@pytest.mark.parametrize("case", CASES)
def test_plain_loop_flies_the_same(laws, chaser, case):
    """NumPy, the document's formulas and Clarabel: same steps; paths within 1 cm, 0.1 mm/s."""
    plain = reference_loop.simulate(
        laws[case], chaser, lambda program: qp_solvers.clarabel(program, 1e-9)
    )
    compiled = simulate([laws[case]], chaser, with_steps=True)
    states = compiled.record(0).state
    assert plain.steps == compiled.steps[0].tolist()
    difference = np.abs(plain.states[: len(states)] - states)
    assert difference[:, :3].max() < 1e-2 and difference[:, 3:].max() < 1e-4


def test_ledger_closes(flown, laws, law):
    """Each state follows from the last one, its impulse and the equations; so do the sums."""
    matrix = rate_matrix(law.mean_motion)
    for m in range(len(flown.docked)):
        steps = flown.record(m)
        before = steps.state.copy()
        before[:, 3:] += steps.impulse
        for phase in range(3):
            mine = np.flatnonzero(steps.phase == phase)
            after = before[mine] @ transition(matrix, law.sample_times[phase]).T
            inner = mine[mine < len(steps.time) - 1]
            assert np.allclose(after[: len(inner)], steps.state[inner + 1], rtol=0, atol=1e-9)
            if len(mine) and flown.docked[m]:
                assert np.allclose(after[-1], flown.ends[m, phase], rtol=0, atol=1e-9)
            impulses = steps.impulse[mine]
            assert flown.delta_v[m, phase] == pytest.approx(np.linalg.norm(impulses, axis=1).sum())
            assert flown.delta_v_axes[m, phase] == pytest.approx(np.abs(impulses).sum())
            assert flown.steps[m, phase] == len(mine)
            assert flown.iterations[m, phase] == steps.iterations[mine].sum()
            bound = law.control_bounds[phase]
            assert np.abs(impulses).max(initial=0.0) <= bound * (1 + 1e-9)


def test_delta_v_is_the_change_of_velocity(flown, law):
    """Against the equations' integral: what the velocity gains less what the motion gives it."""
    steps = flown.record(0)
    matrix = rate_matrix(law.mean_motion)
    gained, given = np.zeros(3), np.zeros(3)
    for k in range(len(steps.time) - 1):
        duration = steps.time[k + 1] - steps.time[k]
        start = steps.state[k] + np.concatenate([np.zeros(3), steps.impulse[k]])
        weights, nodes = [5 / 18, 8 / 18, 5 / 18], [0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5]
        for weight, node in zip(weights, nodes, strict=True):
            state = transition(matrix, node * duration) @ start
            given += weight * duration * (matrix @ state)[3:]
    gained = steps.state[-1, 3:] - steps.state[0, 3:]
    assert np.allclose(gained - given, steps.impulse[:-1].sum(axis=0), atol=1e-6)


def test_results_do_not_depend_on_the_batch(law, chasers):
    """All at once, one by one and in the other order: equal to the last bit."""
    together = simulate([law], chasers)
    backwards = simulate([law], chasers[::-1])
    for m in range(len(chasers)):
        alone = simulate([law], chasers[m])
        for name in ("steps", "delta_v", "ends", "iterations", "softened"):
            one = getattr(alone, name)[0]
            assert np.array_equal(one, getattr(together, name)[m], equal_nan=True)
            assert np.array_equal(one, getattr(backwards, name)[-1 - m], equal_nan=True)


def test_phases_flown_apart_are_those_of_the_whole(law, chaser):
    """A law that does not rotate: the mid range from where the far range ended, and so on."""
    whole = simulate([law], chaser)
    state = chaser
    for phase in range(3):
        part = simulate([law], state, phases=(phase, phase))
        assert part.docked[0] and part.steps[0, phase] == whole.steps[0, phase]
        assert np.array_equal(part.ends[0, phase], whole.ends[0, phase])
        state = part.ends[0, phase]


def test_phases_end_where_the_law_says(flown, laws):
    for m, law in enumerate(laws.values()):
        if not flown.docked[m]:
            continue
        for phase in range(3):
            state, time = flown.ends[m, phase], flown.end_times[m, phase]
            assert reference_loop.phase_ended(law, phase, state, time)
        # and not a step before
        steps = flown.record(m)
        for k in range(1, len(steps.time)):
            if steps.phase[k] == steps.phase[k - 1]:
                ended = reference_loop.phase_ended(
                    law, int(steps.phase[k]), steps.state[k], steps.time[k]
                )
                assert not ended


def test_time_limit_ends_a_manoeuvre(law, chaser):
    flown = simulate([law.with_(time_limit=600.0)], chaser)
    assert not flown.docked[0] and flown.steps[0].tolist() == [20, 0, 0]
    assert np.isnan(flown.ends[0, 1:]).all()


def test_a_known_delay_is_made_up_for(law, chaser):
    """With 5 s of delay in the far range the law that knows it flies nearly the same path."""
    free = simulate([law], chaser, phases=(0, 0))
    known = simulate([law.with_(delay=5.0, delay_known=True)], chaser, phases=(0, 0))
    unknown = simulate([law.with_(delay=5.0)], chaser, phases=(0, 0))
    off = [abs(x.delta_v[0, 0] - free.delta_v[0, 0]) for x in (known, unknown)]
    assert known.docked[0] and unknown.docked[0]
    assert off[0] < off[1]


def test_an_unsolved_program_takes_the_last_plan(law, chaser):
    """A state that is no number cannot be solved for: the plan goes on, then nothing is done."""
    record = guidance.settings([law])[0]
    memory, command = memory_for(30), np.zeros(3)
    lost = np.full(6, np.nan)
    status, *_ = next_control(record, 0, lost, 0.0, memory, command)
    assert status != 0 and not command.any()
    status, *_ = next_control(record, 0, chaser, 0.0, memory, command)
    assert status == 0 and np.array_equal(command, memory.plan[0]) and command.any()
    kept = memory.plan.copy()
    for i in range(1, 30):
        status, *_ = next_control(record, 0, lost, 0.0, memory, command)
        assert status != 0 and np.array_equal(command, kept[i])
    next_control(record, 0, lost, 0.0, memory, command)
    assert not command.any()


def test_constraints_hold_where_no_row_gave_way(law, chasers):
    """Linear motion: at samples no constraint is violated but where the program says so."""
    scale = guidance.settings([law])[0]["scales"]
    flown = simulate([law], chasers, with_steps=True)
    checked = 0
    for m in range(len(flown.docked)):
        steps = flown.record(m)
        for k in range(len(steps.time) - 1):
            if steps.softened[k] or steps.status[k] or steps.phase[k + 1] != steps.phase[k]:
                continue
            phase = int(steps.phase[k])
            found = constraint_check.violations(law, phase, steps.state[k + 1], steps.time[k + 1])
            found.pop("cone penalty", None)
            assert max(found.values()) < 1e-5 * scale[phase, 0], (m, k)
            checked += 1
    assert checked > 0.8 * flown.steps.sum()


def test_constraints_are_also_looked_at_between_samples(law, chaser):
    """What the programs cannot see: the keep-out zone may be touched between samples."""
    table = constraint_check.follow(law, chaser)
    worst = table.groupby(["phase", "constraint", "place"])["violation"].max()
    far = worst["far", "keep out"]
    assert far["sample"] <= 1e-3
    assert far["between"] < 0.01 * law.keep_out
    assert set(table["place"]) == {"start", "sample", "between"}


def test_linear_motion_is_the_loop_s(law, chaser):
    """The checked path is the compiled loop's: same number of steps."""
    table = constraint_check.follow(law, chaser)
    flown = simulate([law], chaser)
    samples = table[(table["place"] == "sample")].groupby(["phase", "constraint"]).size()
    assert samples["far", "keep out"] == flown.steps[0, 0]
    assert samples["final", "speed"] == flown.steps[0, 2]


def test_burns_in_linear_motion_are_those_of_constant_force():
    """Change of state by burns from now on, against an integration to 1e-9; 1e-6 m and m/s."""
    n, burn_time = 0.00114, 28.0
    change = np.array([0.17, -0.11, 0.05])
    durations = burn_time * np.abs(change)
    start = np.array([120.0, -900.0, 40.0, 0.3, -0.2, 0.1])

    def motion(time, state):
        force = np.where(time < durations, np.sign(change) / burn_time, 0.0)
        return rate_matrix(n) @ state + np.concatenate([np.zeros(3), force])

    state = start.copy()
    for begin, end in pairwise(sorted({0.0, *durations, 30.0})):
        state = solve_ivp(motion, (begin, end - 1e-12), state, rtol=1e-12, atol=1e-12).y[:, -1]
    found = start.copy()
    add_burns(burn_time, n, change, found)
    found = transition(rate_matrix(n), 30.0) @ found
    np.testing.assert_allclose(found[:3], state[:3], atol=2e-5)
    np.testing.assert_allclose(found[3:], state[3:], atol=2e-6)
    at_once = start.copy()
    add_burns(0.0, n, change, at_once)
    np.testing.assert_array_equal(at_once, start + np.concatenate([np.zeros(3), change]))
