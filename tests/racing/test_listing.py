"""The solve of the listings: what it must reproduce of them, and that it is deterministic."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from smallsat.dynamics.lanes import LANES
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.racing.evidence.solver_claims import ranks_at
from smallsat.studies.racing.methods import listing_races
from smallsat.studies.racing.methods.flight import COSTATE, least_time, propagate_segment
from smallsat.studies.racing.methods.listing import guess, solve_segment
from smallsat.studies.racing.methods.listing_races import flights, targets, without_thrust
from smallsat.studies.racing.methods.ode45 import end_of_flight, ends_of_flights
from smallsat.studies.racing.model.shooting import (
    AXIS_BY_AXIS,
    DIRECTED,
    NORM_OF_AXES,
    costate_matrix,
    end_of_segment,
    hamiltonian,
    law_of,
    rate,
    thrust_components,
    thrust_of,
)

LIMITS = np.full(3, 0.1667)
PRIMERS = np.random.default_rng(7).normal(size=(50, 3)) * 2.0


def _first(parameters, name="Miny"):
    """State at the start, first target, and CubeSat of Scenario 1."""
    race = parameters.races["scenario-1"]
    craft = next(one for one in race.cubesats if one.name == name)
    return np.r_[craft.position, np.zeros(3)], targets(race.course)[0], craft


def test_least_time_is_that_of_constant_acceleration():
    """Then d = v t + u t^2 / 2, to rounding."""
    for distance, speed, thrust in ((350.0, 0.0, 0.5), (320.0, 7.0, 0.1)):
        t = least_time(distance, speed, thrust)
        assert speed * t + 0.5 * thrust * t**2 == pytest.approx(distance, rel=1e-12)


def test_guess_is_the_listings(parameters):
    """At rest both parts are unit vectors; the duration is ten times the least."""
    state, target, craft = _first(parameters)
    start, shortest = guess(state, 0.0, target, craft.thrust, parameters.listing)
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


@pytest.mark.parametrize("law", [DIRECTED, NORM_OF_AXES, AXIS_BY_AXIS])
def test_no_law_hides_what_is_no_number(law):
    """A primer that is zero gives no thrust, and one that is no number gives none that is one."""
    assert np.all(np.array(thrust_components(np.zeros(3), law, LIMITS, 0.0)) == 0.0)
    assert np.isnan(thrust_components(np.full(3, np.nan), law, LIMITS, 0.0)).all()


@pytest.mark.parametrize("transposed", [True, False])
def test_quadrature_is_the_flight(parameters, transposed):
    """A segment by Gauss points against an adaptive method of order 8: 1e-5 m after 100 s."""
    state, target, craft = _first(parameters)
    start, _ = guess(state, 0.0, target, craft.thrust, parameters.listing)
    costate = start[:6] * np.repeat([0.02, 1.0], 3)
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


@pytest.mark.parametrize("name", ["Miny", "Mo"])
@pytest.mark.parametrize("transposed", [True, False])
def test_the_rate_is_that_of_the_matrices(parameters, name, transposed):
    """State and costate move as their matrices have it, to rounding."""
    _, _, craft = _first(parameters, name)
    law, limits = law_of(craft)
    y, out = np.random.default_rng(1).normal(size=12) * 3.0, np.empty(12)
    rate(y, parameters.mean_motion, transposed, law, limits, 1.0, out)
    push = np.r_[np.zeros(3), thrust_of(y[9:].copy(), law, limits, 1.0)]
    assert out[:6] == pytest.approx(rate_matrix(parameters.mean_motion) @ y[:6] + push)
    assert out[6:] == pytest.approx(costate_matrix(parameters.mean_motion, transposed) @ y[6:])
    u = push[3:]
    wanted = y[6:] @ (rate_matrix(parameters.mean_motion) @ y[:6]) + y[9:] @ u
    assert hamiltonian(y, parameters.mean_motion, law, limits, 1.0) == pytest.approx(wanted)


def test_ode45_ends_where_another_method_does(parameters):
    """A listed segment by an adaptive method of order 8: 1e-7 m; steps as order 5 asks for."""
    state, target, craft = _first(parameters)
    start, _ = guess(state, 0.0, target, craft.thrust, parameters.listing)
    law, limits = law_of(craft)

    def flown(tolerance):
        return end_of_flight(
            np.r_[state, start[:6]], 0.0, start[6], parameters.mean_motion, False, law, limits,
            1.0, tolerance,
        )  # fmt: skip

    _, other = propagate_segment(
        state, start[:6], start[6], craft, parameters.mean_motion, 1.0, 1e-13, False
    )
    (end, fine), (_, coarse) = flown(1e-12), flown(1e-7)
    assert np.abs(end[:3] - other[-1, :3]).max() < 1e-7
    assert fine / coarse == pytest.approx(10.0, rel=0.3)


def test_ode45_takes_a_jump_of_the_thrust(parameters):
    """Where an axis is switched the step shrinks until it is met; the flight goes on: 1e-6 m."""
    state, target, craft = _first(parameters, "Mo")
    start, _ = guess(state, 0.0, target, craft.thrust, parameters.listing)
    law, limits = law_of(craft)
    end, _ = end_of_flight(
        np.r_[state, start[:6]], 0.0, 60.0, parameters.mean_motion, False, law, limits, 1.0, 1e-12
    )
    _, other = propagate_segment(
        state, start[:6], 60.0, craft, parameters.mean_motion, 1.0, 1e-13, False
    )
    assert np.abs(end[:3] - other[-1, :3]).max() < 1e-6


@pytest.mark.parametrize("name", ["Miny", "Mo"])
def test_flights_side_by_side_are_those_on_their_own(parameters, name):
    """To the last bit, though each takes steps of its own, and one has no number in it."""
    state, target, craft = _first(parameters, name)
    start, shortest = guess(state, 0.0, target, craft.thrust, parameters.listing)
    law, limits = law_of(craft)
    random = np.random.default_rng(3)
    for tolerance in (1e-7, 1e-12):
        fixed = (parameters.mean_motion, False, law, limits, 1.0, tolerance)
        starts = np.tile(np.r_[state, start[:6]], (LANES, 1))
        starts[1:, 6:] += random.normal(size=(LANES - 1, 6))
        starts[2, 9:], starts[3, 8] = 0.0, np.nan
        ends = shortest * random.uniform(1.0, 10.0, LANES)
        found = ends_of_flights(starts, 0.0, ends, *fixed)
        alone = [end_of_flight(y, 0.0, end, *fixed) for y, end in zip(starts, ends, strict=True)]
        assert len({steps for _, steps in alone}) > LANES // 2
        assert np.isnan(found[3]).any()
        for end, (same, _) in zip(found, alone, strict=True):
            assert np.array_equal(end, same, equal_nan=True)
            assert end[~np.isnan(end)].tobytes() == same[~np.isnan(same)].tobytes()


def test_the_same_solve_twice(parameters):
    """Not a bit differs; bounds and limits of the listing are kept."""
    state, target, craft = _first(parameters)
    few = replace(parameters.listing, evaluations=200)
    one, other = (
        solve_segment(state, 0.0, target, craft, parameters.mean_motion, few) for _ in range(2)
    )
    assert np.array_equal(one.costate, other.costate)
    assert one.arrival == other.arrival
    _, shortest = guess(state, 0.0, target, craft.thrust, few)
    assert one.arrival >= shortest
    assert np.abs(one.costate).max() <= few.costate_bound
    assert one.evaluations < 200 + 8


def test_the_time_of_a_segment_is_that_of_the_race(parameters):
    """A segment that begins later arrives later by as much, within what its last bits change."""
    state, target, craft = _first(parameters)
    early, _ = guess(state, 0.0, target, craft.thrust, parameters.listing)
    late, _ = guess(state, 100.0, target, craft.thrust, parameters.listing)
    assert late[6] - early[6] == pytest.approx(100.0)
    few = replace(parameters.listing, evaluations=50)
    solved = solve_segment(state, 100.0, target, craft, parameters.mean_motion, few)
    assert solved.arrival > 100.0


def test_the_equalities_are_dependent_everywhere(parameters):
    """Rank 3 of twelve rows at the guess, and at other points: no solution makes them so.

    Seven rows never move, H0 = Hf is an identity along any extremal, and of a direction in space
    two components are free.
    """
    state, target, meeny = _first(parameters, "Meeny")
    start, _ = guess(state, 0.0, target, meeny.thrust, parameters.listing)
    for z in (start, start * [1.0, 0.7, 1.3, 1.2, 0.9, 0.8, 0.5]):
        moving, rank, pointing = ranks_at(parameters, z, transposed=True)
        assert (moving <= 5, rank, pointing) == (True, 3, 2)


def test_the_deadzone_forces_thrust_to_zero(parameters, section, monkeypatch):
    """Where the primer goes from 0 through 1 to 2, Mo has no thrust for half of the segment."""
    costates = dict.fromkeys(COSTATE, 0.0)
    segments = [
        {"cubesat": "Mo", "duration_s": 10.0, **costates, "pvx": 2.0},
        # No primer at first, whose rate the costate of the place is, and the rest hardly moves.
        {"cubesat": "Mo", "duration_s": 10.0, **costates, "pz": -0.2},
    ]
    solved = SimpleNamespace(segments=segments)
    monkeypatch.setattr(listing_races, "solve_listing", lambda *_, paths: solved)
    table = without_thrust(parameters, section)
    assert set(table["scenario"]) == {"scenario-1"}
    assert len(table) == 1 + len(section.listing.other_tolerances)
    assert (table["segments_without_thrust"] == 1).all()
    assert table["without_thrust_s"].to_numpy() == pytest.approx(5.0, rel=1e-3)


def test_flights_differ_in_their_tolerance_alone(parameters, section):
    """The listing's own and the others, each once."""
    solves = flights(parameters.listing, section)
    assert {one.tolerance for one in solves} == {
        parameters.listing.tolerance,
        *section.listing.other_tolerances,
    }
    assert {replace(one, tolerance=1.0) for one in solves} == {
        replace(parameters.listing, tolerance=1.0)
    }
