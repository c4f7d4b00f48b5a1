"""Weights of a miss, drifting rings, open-loop flights: limits in which they are the baseline."""

from dataclasses import replace

import numpy as np
import pytest

from smallsat.dynamics.orbits.clohessy_wiltshire import transition
from smallsat.studies.racing.methods import dispersions
from smallsat.studies.racing.methods.course_program import CourseProgram
from smallsat.studies.racing.methods.drifting_rings import READINGS, DriftingProgram
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.methods.races import whole_leg
from smallsat.studies.racing.methods.weighted_misses import (
    WeightedProgram,
    misses,
    ring_multipliers,
)
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat, cubesat

RINGS, PIECES = 2, 8


@pytest.fixture(scope="module")
def short(parameters) -> Course:
    """The first rings of Scenario 1."""
    course = parameters.races["scenario-1"].course
    return Course(
        course.start,
        course.centres[:RINGS],
        course.normals[:RINGS],
        course.semi_axes[:RINGS],
        course.centres[RINGS],
    )


@pytest.fixture(scope="module")
def craft(short) -> CubeSat:
    return cubesat("any", 0.25, short.start)


@pytest.fixture(scope="module")
def plan(parameters, short, craft):
    solver = CourseProgram(RINGS, "state", PIECES)
    return solver.solve(whole_leg(short, craft), craft, parameters.mean_motion)


@pytest.fixture(scope="module")
def weighted():
    return WeightedProgram(RINGS, "state", PIECES)


def test_above_the_multipliers_no_miss_pays(parameters, short, craft, plan, weighted):
    """The penalised optimum is that through the centres: 1 cm, the smoothing, and 0.01 s."""
    largest = ring_multipliers(plan, short, parameters.mean_motion).max()
    leg = replace(whole_leg(short, craft), weight=1.5 * largest)
    found = weighted.solve(leg, craft, parameters.mean_motion)
    assert found.converged
    assert misses(found, short).max() < 0.01
    assert found.time == pytest.approx(plan.time, abs=0.01)


def test_below_the_largest_multiplier_one_ring_is_missed(parameters, short, craft, plan, weighted):
    """It is the ring of that multiplier, within its plane, for a better cost and by its rule."""
    multipliers = ring_multipliers(plan, short, parameters.mean_motion)
    weight = 0.9 * multipliers.max()
    assert np.sort(multipliers)[-2] < weight
    leg = replace(whole_leg(short, craft), weight=weight)
    found = weighted.refine(leg, craft, parameters.mean_motion, plan)
    assert found.converged
    missed = misses(found, short)
    assert missed.argmax() == multipliers.argmax()
    assert missed.max() > 0.1
    assert found.time + weight * missed.sum() < plan.time
    offsets = found.ends[:RINGS, :3] - short.centres
    assert np.abs(np.sum(offsets * short.normals, axis=1)).max() < 1e-6
    flown = propagate_plan(found, parameters.mean_motion)
    assert residual(found, flown, craft, None) < 1e-6


def test_a_multiplier_is_the_rate_of_the_time(parameters, short, craft, plan):
    """Half a metre off the first centre, across its normal, by solving anew: to 5 %."""
    solver = CourseProgram(RINGS, "state", PIECES)
    rates = []
    for aside in short.axes[0]:
        times = []
        for way in (-0.5, 0.5):
            centres = short.centres.copy()
            centres[0] += way * aside
            leg = whole_leg(replace(short, centres=centres), craft)
            times.append(solver.solve(leg, craft, parameters.mean_motion).time)
        rates.append(times[1] - times[0])
    known = ring_multipliers(plan, short, parameters.mean_motion)[0]
    assert np.hypot(*rates) == pytest.approx(known, rel=0.05)


@pytest.mark.parametrize("ratio", READINGS.values(), ids=READINGS)
def test_rings_on_the_orbit_do_not_drift(parameters, short, craft, ratio):
    """On the track of the origin rings at rest stay: the very optimum of fixed rings, to 1e-6."""
    along = np.array([0.0, 1.0, 0.0])
    course = replace(
        short,
        start=-500.0 * along,
        centres=np.array([-200.0, 120.0])[:, None] * along,
        end=400.0 * along,
    )
    own = replace(craft, position=course.start + 5.0)
    leg = whole_leg(course, own)
    fixed = CourseProgram(RINGS, "state", PIECES).solve(leg, own, parameters.mean_motion)
    found = DriftingProgram(RINGS, PIECES, ratio).solve(leg, own, parameters.mean_motion)
    assert fixed.converged and found.converged
    assert found.time == pytest.approx(fixed.time, rel=1e-6)
    assert found.controls == pytest.approx(fixed.controls, abs=1e-4)


@pytest.mark.parametrize("ratio", READINGS.values(), ids=READINGS)
def test_drifting_rings_are_met_where_they_are(parameters, short, craft, ratio):
    """At the ring's place of then, along its normal relative to it, at rest with the end: 1e-6."""
    n = parameters.mean_motion
    leg = whole_leg(short, craft)
    found = DriftingProgram(RINGS, PIECES, ratio).solve(leg, craft, n)
    assert found.converged
    ends = propagate_plan(found, n)[:, -1]
    places = np.vstack([short.centres, short.end])
    for k, (place, arrival) in enumerate(zip(places, np.cumsum(found.durations), strict=True)):
        ring = transition(n, arrival) @ np.r_[place, 0.0, ratio * n * place[0], 0.0]
        assert np.linalg.norm(ends[k, :3] - ring[:3]) < 1e-6
        relative = ends[k, 3:] - ring[3:]
        if k < RINGS:
            assert np.linalg.norm(np.cross(relative, short.normals[k])) < 1e-6
            assert relative @ short.normals[k] > 0.0
        else:
            assert np.linalg.norm(relative) < 1e-6


def test_natural_orbits_come_back(parameters):
    """After a period the rings of that reading are where they were."""
    n, place = parameters.mean_motion, np.array([-600.0, 100.0, 500.0])
    start = np.r_[place, 0.0, READINGS["natural orbits"] * n * place[0], 0.0]
    assert transition(n, 2.0 * np.pi / n) @ start == pytest.approx(start, abs=1e-6)


def test_without_errors_nothing_is_missed(parameters, short, plan):
    sensitivity = dispersions.sensitivities(plan, parameters.mean_motion, False)
    assert not dispersions.flown_misses(sensitivity, short, np.zeros((3, 10))).any()


def test_errors_are_those_of_flights(parameters, short, craft, plan):
    """Flights anew, by another integrator, with each of the ten errors: offsets to 1e-3 of them."""
    found = dispersions.sensitivities(plan, parameters.mean_motion, False)
    planned = propagate_plan(plan, parameters.mean_motion)[:, -1]
    sizes = np.r_[np.full(3, 0.1), np.full(3, 1e-3), 0.01, np.full(3, 1e-4)]
    for place, size in enumerate(sizes):
        error = size * (np.arange(10) == place)
        turned = plan.controls + np.cross(error[7:], plan.controls)
        starts = plan.starts.copy()
        starts[0] += error[:6]
        moved = replace(plan, starts=starts, controls=(1.0 + error[6]) * turned)
        offsets = propagate_plan(moved, parameters.mean_motion)[:, -1] - planned
        assert found[:, :, place] * size == pytest.approx(offsets, rel=1e-3, abs=1e-6)


def test_put_back_forgets_what_was_before(parameters, plan):
    """The first segment is the same; the errors of the start reach no other, thrust's do."""
    n = parameters.mean_motion
    run, back = (dispersions.sensitivities(plan, n, put_back) for put_back in (False, True))
    assert (run[0] == back[0]).all()
    assert not back[1:, :, :6].any()
    assert np.abs(back[-1][:, 6]).max() > 0.0
    assert np.abs(run[-1][:3, 6]).max() > np.abs(back[-1][:3, 6]).max()


def test_statistics_of_known_misses():
    """Of 20 flights one misses ring 2, two more ring 3; errors a fifth as large miss none."""
    missed = np.full((20, 3), 0.5)
    missed[0, 1] = missed[1, 2] = missed[2, 2] = 5.0
    rows, short = dispersions._statistics(missed, np.ones(3), np.array([1.0, 2.0, 3.0]))
    assert [row["passed_share"] for row in rows] == pytest.approx([1.0, 0.95, 0.85])
    assert short["first_ring"] == 3
    assert short["first_s"] == 3.0
    assert short["factor"] == pytest.approx(0.2)
