"""The optimum on a short course: crossings, independent flight, meshes, the minimum principle."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.racing.methods import indirect
from smallsat.studies.racing.methods.checks import primer_check
from smallsat.studies.racing.methods.course_program import CourseProgram, Leg
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.model.cubesat import cubesat

RINGS = 3
REST = np.zeros(3)
FREE = cubesat("free", 0.25, np.zeros(3))
AXIAL = cubesat("axial", 0.1667, np.zeros(3), axial=True)


@pytest.fixture(scope="module")
def leg(parameters):
    race = parameters.races["scenario-1"]
    course = race.course
    return Leg(
        race.cubesats[1].position,
        REST,
        course.centres[:RINGS],
        course.normals[:RINGS],
        course.centres[RINGS],
        REST,
    )


@pytest.fixture(scope="module")
def program():
    return CourseProgram(RINGS, "state", 20)


@pytest.mark.parametrize("craft", [FREE, AXIAL], ids=["free", "axial"])
def test_rings_are_crossed_when_flown_adaptively(parameters, leg, program, craft):
    """Flown by an adaptive method of order 8 from the start on: 1e-6 m, 1e-8 m/s, within limits."""
    plan = program.solve(leg, craft, parameters.mean_motion)
    assert plan.converged
    a, state = rate_matrix(parameters.mean_motion), plan.starts[0]
    for k in range(RINGS + 1):
        h = plan.durations[k] / plan.controls.shape[1]
        for u in plan.controls[k]:
            push = np.r_[REST, u]
            flown = solve_ivp(
                lambda _, x, push=push: a @ x + push,
                (0.0, h), state, method="DOP853", rtol=1e-12, atol=1e-12,
            )  # fmt: skip
            state = flown.y[:, -1]
        if k < RINGS:
            assert np.linalg.norm(state[:3] - leg.centres[k]) < 1e-6
            assert np.linalg.norm(np.cross(state[3:], leg.normals[k])) < 1e-6
            assert state[3:] @ leg.normals[k] > 0.0
    assert np.linalg.norm(state[:3] - leg.end_position) < 1e-6
    assert np.linalg.norm(state[3:]) < 1e-6
    assert residual(plan, propagate_plan(plan, parameters.mean_motion), craft, None) < 1e-6


def test_nested_meshes_never_get_worse(parameters, leg):
    """Halved pieces contain the old plan: times fall, by less and less."""
    times = [CourseProgram(RINGS, "state", n).solve(leg, FREE, parameters.mean_motion).time
             for n in (10, 20, 40)]  # fmt: skip
    assert times[0] >= times[1] >= times[2]
    assert times[0] - times[1] > times[1] - times[2]


def test_rest_anywhere_is_no_slower(parameters, leg, program):
    """Freeing the finish cannot cost time."""
    free = CourseProgram(RINGS, "rest anywhere", 20).solve(leg, FREE, parameters.mean_motion)
    assert free.converged
    assert free.time < program.solve(leg, FREE, parameters.mean_motion).time


def test_whole_course_beats_its_segments(parameters, leg, program):
    """One problem is at least as good as ring after ring."""
    state, total = np.r_[leg.position, leg.velocity], 0.0
    for k in range(RINGS + 1):
        last = k == RINGS
        part = Leg(state[:3], state[3:], leg.centres[k : k + 1], leg.normals[k : k + 1],
                   leg.end_position, REST)  # fmt: skip
        solver = CourseProgram(0 if last else 1, "state" if last else "ring", 20)
        plan = solver.solve(part, FREE, parameters.mean_motion)
        assert plan.converged
        total, state = total + plan.time, plan.final
    assert program.solve(leg, FREE, parameters.mean_motion).time <= total + 1e-6


def test_the_minimum_principle(parameters, leg, program):
    """Thrust against the multipliers' primer to 0.1 deg; H = -1 to 5 %, in the median 0.5 %."""
    plan = program.solve(leg, FREE, parameters.mean_motion)
    found = primer_check(plan, FREE, parameters.mean_motion)
    assert found["primer_angle_largest_deg"] < 0.1
    assert found["hamiltonian_error"] < 0.05
    assert found["hamiltonian_median_error"] < 0.005
    assert found["full_thrust_share"] > 0.95
    assert found["largest_ring_multiplier_s_m"] < 1.0


def test_a_wrong_costate_would_show(parameters, leg, program):
    """The check of the principle fails where the costates are turned."""
    from dataclasses import replace

    plan = program.solve(leg, FREE, parameters.mean_motion)
    turned = replace(plan, costates=plan.costates[:, [1, 0, 2, 4, 3, 5]])
    assert primer_check(turned, FREE, parameters.mean_motion)["primer_angle_largest_deg"] > 1.0


def test_direct_and_indirect_agree(parameters, leg):
    """First segment: the extremal is faster than the held plan by less than 0.5 %."""
    part = Leg(leg.position, REST, leg.centres[:1], leg.normals[:1], leg.end_position, REST)
    plan = CourseProgram(1, "ring", 20).solve(part, FREE, parameters.mean_motion)
    goal = indirect.Goal(leg.centres[0], leg.normals[0])
    found = indirect.solve(plan.starts[0], goal, FREE.thrust, parameters.mean_motion,
                           plan.costates[0], plan.time, 64)  # fmt: skip
    assert found.converged
    assert 0.995 * plan.time < found.duration <= plan.time + 1e-9
    assert np.linalg.norm(found.end[:3] - leg.centres[0]) < 1e-6
