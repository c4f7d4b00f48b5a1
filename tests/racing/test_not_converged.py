"""A race without a solution is a row with what was tried; what can be solved is right."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot as plt
from scipy.integrate import solve_ivp

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.results import write_table
from smallsat.studies.racing.evidence import race_claims
from smallsat.studies.racing.evidence.observations import observations
from smallsat.studies.racing.evidence.scores import missed_table, printed_scores, score_table
from smallsat.studies.racing.figures import plots
from smallsat.studies.racing.methods import attempts, checks
from smallsat.studies.racing.methods.course_program import CourseProgram
from smallsat.studies.racing.methods.dynamic_programming import dynamic_programming
from smallsat.studies.racing.methods.races import WHOLE, solve_optima, whole_leg
from smallsat.studies.racing.model.course import Course
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Race

RINGS = 2
# The tide at the first ring is 0.66 mm/s^2; below that nothing stands still there.
WEAK, SLOW = 3e-4, 1e-3


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
def weak(parameters, section, short):
    """Tables of a race in which the first of two CubeSats is weaker than the tide."""
    cubesats = tuple(CubeSat(n, u, (), short.start) for n, u in (("Eeny", WEAK), ("Meeny", 0.25)))
    small = section.with_(optimum=section.optimum.with_(intervals=8))
    changed = replace(parameters, races=parameters.races | {"scenario-1": Race(short, cubesats)})
    return solve_optima(changed, small, "scenario-1")


def _flown(plan, mean_motion):
    """States at the ends of the segments by an adaptive method of order 8."""
    a, state, ends = rate_matrix(mean_motion), plan.starts[0], []
    for duration, controls in zip(plan.durations, plan.controls, strict=True):
        for u in controls:
            push = np.r_[np.zeros(3), u]
            state = solve_ivp(
                lambda _, x, push=push: a @ x + push,
                (0.0, duration / len(controls)), state, method="DOP853", rtol=1e-12, atol=1e-12,
            ).y[:, -1]  # fmt: skip
        ends.append(state)
    return np.array(ends)


def test_a_millimetre_per_second_squared(parameters, short):
    """Flown anew by another method every ring is crossed at its centre, to 1e-5 m."""
    craft = CubeSat("slow", SLOW, (), short.start)
    program = CourseProgram(RINGS, "state", 20)
    plan = attempts.solve(program, whole_leg(short, craft), craft, parameters.mean_motion)
    assert plan.converged
    ends = _flown(plan, parameters.mean_motion)
    assert np.linalg.norm(ends[:RINGS, :3] - short.centres, axis=1).max() < 1e-5
    assert np.linalg.norm(np.cross(ends[:RINGS, 3:], short.normals), axis=1).max() < 1e-7
    assert np.linalg.norm(ends[-1] - np.r_[short.end, np.zeros(3)]) < 1e-5
    assert np.linalg.norm(plan.controls, axis=2).max() < SLOW * (1.0 + 1e-6)


@pytest.mark.parametrize("length", [0.01, 100.0])
def test_time_goes_with_the_root_of_the_length(parameters, short, length):
    """Without a tide to speak of the same course in another size takes the root of it as long."""
    program = CourseProgram(RINGS, "state", 8)
    times = []
    for factor in (1.0, length):
        course = replace(
            short,
            start=short.start * factor,
            centres=short.centres * factor,
            end=short.end * factor,
        )
        craft = CubeSat("any", 0.25, (), course.start)
        plan = attempts.solve(program, whole_leg(course, craft), craft, 1e-9)
        assert plan.converged
        times.append(plan.time)
    assert times[1] / times[0] == pytest.approx(np.sqrt(length), rel=1e-6)


def test_continuation_finds_what_the_arcs_miss(parameters, short, monkeypatch):
    """With arcs that lead nowhere the continuation comes to the same optimum."""
    craft = CubeSat("any", 0.25, (), short.start)
    program = CourseProgram(RINGS, "state", 8)
    leg = whole_leg(short, craft)
    known = program.solve(leg, craft, parameters.mean_motion)
    solve, calls = program.solve, []

    def stubborn(leg, cubesat, mean_motion, guess=None, arcs=None):
        calls.append(mean_motion)
        plan = solve(leg, cubesat, mean_motion, guess, arcs)
        first = guess is None and mean_motion == parameters.mean_motion
        return replace(plan, solution=replace(plan.solution, converged=False)) if first else plan

    monkeypatch.setattr(program, "solve", stubborn)
    plan = attempts.solve(program, leg, craft, parameters.mean_motion)
    assert plan.converged
    assert plan.time == pytest.approx(known.time, rel=1e-6)
    assert plan.tried[0] == attempts.SMOOTH
    assert plan.tried[-1].endswith("100 % of it")
    assert min(calls) < parameters.mean_motion


@pytest.mark.parametrize("largest", [0.4, 2.3])
def test_dynamic_programming_finds_its_range(parameters, section, short, largest):
    """Too small a range of speeds is widened, to within 0.5 % of the whole-course optimum.

    A finer grid contains the best path of the coarser one, so that it is never slower.
    """
    craft = CubeSat("Meeny", 0.25, (), short.start)
    small = section.with_(
        optimum=section.optimum.with_(intervals=8),
        dynamic_programming=section.dynamic_programming.with_(
            largest_speed=largest, speeds=5, refinements=3
        ),
    )
    changed = replace(parameters, races=parameters.races | {"scenario-1": Race(short, (craft,))})
    table, missing = dynamic_programming(changed, small, "scenario-1")
    whole = CourseProgram(RINGS, "state", 8).solve(
        whole_leg(short, craft), craft, parameters.mean_motion
    )
    assert not missing
    assert whole.time <= table["time_s"].iloc[-1] < 1.005 * whole.time
    assert (np.diff(table["time_s"]) <= 0.0).all()


def test_dynamic_programming_without_a_path_is_a_row(parameters, section, short):
    """Weaker than the tide, no segment is solved: no time, and what was tried."""
    craft = CubeSat("Meeny", WEAK, (), short.start)
    small = section.with_(
        optimum=section.optimum.with_(intervals=4),
        dynamic_programming=section.dynamic_programming.with_(speeds=3, refinements=1),
    )
    changed = replace(parameters, races=parameters.races | {"scenario-1": Race(short, (craft,))})
    table, missing = dynamic_programming(changed, small, "scenario-1")
    assert table["time_s"].isna().all()
    assert [one.case for one in missing] == ["scenario-1, Meeny, dynamic programming"]
    assert "3 speeds" in missing[0].tried


def test_a_thrust_is_solved_alike_among_any_others(parameters, section, short):
    """A hard one after a weaker and before a far stronger one: equal to the last digit."""
    weaker, hard, strong = 5e-4, 5.1e-4, 1.0
    changed = replace(parameters, races=parameters.races | {"scenario-1": Race(short, ())})
    small = section.with_(optimum=section.optimum.with_(intervals=4))
    rows, tried = [], []
    for thrusts in ((weaker, hard), (hard, strong)):
        own = small.with_(thrust_sweep_m_s2=thrusts)
        table, missing = checks.thrust_sweep(changed, own, "scenario-1")
        rows.append(table[table["thrust_m_s2"] == hard].reset_index(drop=True))
        tried.append([case for case in missing if f"{hard:g}" in case.case])
    # All ways were gone: a plan of another thrust would have been one of them.
    assert tried[0] == tried[1] and "continuation" in tried[0][0].tried
    pd.testing.assert_frame_equal(*rows, check_exact=True)


def test_a_race_without_a_solution_is_a_row(weak):
    """No numbers, where it is missing, what was tried; the other CubeSat races all the same."""
    races = weak.files("weak")["weak-races.csv"].set_index(["cubesat", "solution"])
    assert races.loc["Eeny", ["cost", "time_s", "missed", "residual"]].isna().all(axis=None)
    assert (races.loc["Eeny", "not_converged"] > 0).all()
    assert races.loc["Meeny", "time_s"].notna().all()
    assert (
        set(weak.trajectory()["cubesat"])
        == set(weak.files("weak")["weak-rings.csv"]["cubesat"])
        == {"Meeny"}
    )
    listed = {case.case: case for case in weak.not_converged}
    whole = listed[f"scenario-1, Eeny, {WHOLE}"]
    assert "continuation" in whole.tried
    assert whole.residual > 1.0
    assert len(listed) == 4


def test_observations_and_scores_of_a_missing_race(weak, ledger):
    """Not a number, and said why; no place among the others."""
    every = observations(weak.files("weak")["weak-races.csv"], ledger("racing"))
    found = [one for one in every if one.id.endswith("scenario-1-eeny")]
    assert found
    assert all(np.isnan(one.computed) and one.note.startswith("not converged") for one in found)
    printed = printed_scores(ledger("racing"))
    scores = score_table(weak.files("weak")["weak-races.csv"], printed).set_index(
        ["cubesat", "solution"]
    )
    assert pd.isna(scores.loc[("Eeny", WHOLE), "place"])
    assert scores.loc[("Meeny", WHOLE), "place"] == 1
    assert set(missed_table(weak.files("weak")["weak-rings.csv"])["cubesat"]) == {"Meeny"}


def test_a_missing_race_is_drawn_as_missing(weak, short):
    """The figures are there, and say in words what is not."""
    paths = weak.trajectory()
    figure = plots.trajectory_figure(short, paths, "Eeny")
    words = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert words.count("not converged") == 14
    for segment in range(RINGS + 1):
        plots.segment_figure(short, paths[paths["cubesat"] == "Eeny"], segment)
    plt.close("all")


def test_claims_wait_for_a_missing_race(weak, tmp_path, section, grounds):
    """They need all CubeSats, and raise what makes a claim undecided."""
    write_table(weak.files("weak")["weak-races.csv"], tmp_path / "races.csv")
    given = grounds("racing", section, tmp_path)
    for claim in (
        race_claims.mo_slower_than_meeny,
        race_claims.whole_course_remedies,
        race_claims.not_smooth,
    ):
        with pytest.raises(LookupError):
            claim(given)
