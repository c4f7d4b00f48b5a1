"""The solve of the listings: what it must reproduce of them, and that it is deterministic."""

from dataclasses import replace

import numpy as np
import pytest

from smallsat.studies.racing.evidence.errata import ranks_at
from smallsat.studies.racing.methods.as_published import Target, guess, least_time, solve_segment
from smallsat.studies.racing.methods.flight import propagate_segment
from smallsat.studies.racing.model.shooting import (
    AXIS_BY_AXIS,
    DIRECTED,
    NORM_OF_AXES,
    costate_matrix,
    end_of_segment,
    thrust_components,
)

LIMITS = np.full(3, 0.1667)
PRIMERS = np.random.default_rng(7).normal(size=(50, 3)) * 2.0


def _first(parameters):
    race = parameters.races["scenario-1"]
    craft = race.cubesats[2]
    course = race.course
    target = Target(course.centres[0], course.normals[0], 5.0, course.start, False)
    return np.r_[craft.position, np.zeros(3)], target, craft


def test_least_time_is_that_of_constant_acceleration():
    """Then d = v t + u t^2 / 2, to rounding."""
    for distance, speed, thrust in ((350.0, 0.0, 0.5), (320.0, 7.0, 0.1)):
        t = least_time(distance, speed, thrust)
        assert speed * t + 0.5 * thrust * t**2 == pytest.approx(distance, rel=1e-12)


def test_guess_is_the_listings(parameters):
    """At rest both parts are unit vectors; the duration is ten times the least."""
    state, target, craft = _first(parameters)
    start, shortest = guess(state, target, craft.thrust, parameters.as_published)
    assert np.linalg.norm(start[:3]) == pytest.approx(1.0)
    assert np.linalg.norm(start[3:6]) == pytest.approx(1.0)
    assert start[6] == pytest.approx(10.0 * shortest)


@pytest.mark.parametrize("primer", PRIMERS)
def test_laws_of_thrust(primer):
    """Full thrust against the primer; off within the deadzone; no box control is better."""
    u = np.array(thrust_components(primer, DIRECTED, LIMITS, 1.0))
    assert np.linalg.norm(u) == pytest.approx(LIMITS[0])
    assert np.cross(u, primer) == pytest.approx(np.zeros(3), abs=1e-12)
    u = np.array(thrust_components(primer, NORM_OF_AXES, LIMITS, 1.0))
    active = np.abs(primer) > 1.0
    assert np.linalg.norm(u) == pytest.approx(np.linalg.norm(LIMITS[active]), abs=1e-12)
    best = np.array(thrust_components(primer, AXIS_BY_AXIS, LIMITS, 1.0))
    assert primer @ best == pytest.approx(-np.sum(LIMITS * np.abs(primer)))


def test_no_thrust_where_no_axis_is_active():
    """Section IV.A: the deadzone can force the available thrust to zero."""
    assert thrust_components(np.full(3, 0.5), NORM_OF_AXES, LIMITS, 1.0) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("transposed", [True, False])
def test_quadrature_is_the_flight(parameters, transposed):
    """A segment by Gauss points against an adaptive method of order 8: 1e-5 m after 100 s."""
    state, target, craft = _first(parameters)
    start, _ = guess(state, target, craft.thrust, parameters.as_published)
    costate = start[:6] * np.repeat([0.02, 1.0], 3)
    from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix

    x, p = end_of_segment(
        state, costate, 100.0, rate_matrix(parameters.mean_motion),
        costate_matrix(parameters.mean_motion, transposed), DIRECTED, np.full(3, craft.thrust),
        1.0, 128,
    )  # fmt: skip
    _, flown = propagate_segment(
        state, costate, 100.0, craft, parameters.mean_motion, 1.0, 1e-12, transposed
    )
    assert np.abs(x[:3] - flown[-1, :3]).max() < 1e-5
    assert p == pytest.approx(flown[-1, 6:], rel=1e-9)


def test_the_same_solve_twice(parameters):
    """Not a bit differs."""
    state, target, craft = _first(parameters)
    solves = [
        solve_segment(state, target, craft, parameters.mean_motion, parameters.as_published)
        for _ in range(2)
    ]
    assert np.array_equal(solves[0].costate, solves[1].costate)
    assert solves[0].duration == solves[1].duration


def test_the_equalities_are_dependent_everywhere_and_ours_bears_them(parameters):
    """Rank 3 of twelve rows at the guess, and at other points: no solution makes them so.

    Seven rows never move, H0 = Hf is an identity along any extremal, and of a direction in space
    two components are free. Each step of ours has a solution nevertheless.
    """
    state, target, _ = _first(parameters)
    meeny = next(c for c in parameters.races["scenario-1"].cubesats if c.name == "Meeny")
    state[:3] = meeny.position
    start, _ = guess(state, target, meeny.thrust, parameters.as_published)
    for z in (start, start * [1.0, 0.7, 1.3, 1.2, 0.9, 0.8, 0.5]):
        moving, rank, pointing = ranks_at(parameters, z, transposed=True)
        assert (moving <= 5, rank, pointing) == (True, 3, 2)
    settings = replace(parameters.as_published, transposed=True)
    found = solve_segment(state, target, meeny, parameters.mean_motion, settings)
    assert found.status != "no step" and np.isfinite(found.costate).all()
