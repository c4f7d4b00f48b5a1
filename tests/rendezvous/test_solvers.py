"""The stage-wise solver, against other solvers and against the conditions of optimality."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smallsat.dynamics.lanes import LANES
from smallsat.optimal_control.riccati_interior_point import (
    EXCESS,
    SOLVED,
    WEIGHT,
    Program,
    solve,
    solve_together,
    workspace,
)
from smallsat.optimal_control.riccati_interior_point import ITERATION_LIMIT as OUT_OF_STEPS
from smallsat.studies.rendezvous.guidance import law as guidance
from smallsat.studies.rendezvous.guidance.controller import (
    ITERATION_LIMIT,
    SOFTENED,
    TOLERANCE,
    together_for,
    write_lane,
)
from smallsat.studies.rendezvous.guidance.phase_programs import (
    BOUNDS,
    PLANES,
    empty_program,
    in_use,
    shape,
    write_program,
)
from smallsat.studies.rendezvous.methods import qp_solvers, solver_comparison
from smallsat.studies.rendezvous.methods.qp_solvers import Sample, cost
from smallsat.studies.rendezvous.methods.solver_comparison import QP_SOLVERS, samples


@pytest.fixture(scope="module")
def programs(laws, chasers):
    """Programs of all phases and kinds of law from closed loops: 5 laws, up to 4 x 3 each."""
    return samples(laws, chasers[:3], 4)


def test_all_solvers_find_the_same_cost(programs):
    """Costs agree to 1e-6 of what the control saves, but for OSQP's at its usual tolerance.

    The stage-wise solver and Clarabel solve every program.
    """
    answers, _ = solver_comparison.compare(programs)
    for name in QP_SOLVERS:
        mine = answers[answers["back_end"] == name]
        if name != "OSQP":
            assert mine["solved"].all(), name
            assert mine["cost_error"].max() < 1e-6, name
    table = solver_comparison.summary(answers)
    assert set(table["kind"]) == {sample.kind for sample in programs}
    # the check can fail: OSQP's answers would not pass for the others'
    assert answers[answers["back_end"] == "OSQP"]["cost_error"].max() > 1e-6


def test_osqp_finds_the_same_where_it_is_let_run(programs):
    """At 1e-7 instead of 1e-4, docking programs: costs within 1e-4 of what the control saves."""
    docking = [sample for sample in programs if sample.kind.startswith("final")]
    for sample in docking:
        data = qp_solvers.sparse_program(sample)
        answer = qp_solvers.osqp(data, 1e-7)
        mine = QP_SOLVERS["stage-wise"](sample)
        saved = cost(sample, np.zeros_like(mine.controls)) - cost(sample, mine.controls)
        assert answer.solved
        assert cost(sample, answer.controls) - cost(sample, mine.controls) < 1e-4 * saved


def test_programs_are_of_every_kind(programs, laws):
    kinds = {sample.kind for sample in programs}
    assert len(kinds) == 13 and len(programs) >= 40


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.floats(1e-3, 0.3))
def test_no_other_control_is_better(programs, seed, size):
    """Random feasible changes of the plan never lower the cost by more than rounding."""
    random = np.random.default_rng(seed)
    sample = programs[seed % len(programs)]
    answer = QP_SOLVERS["stage-wise"](sample)
    best = cost(sample, answer.controls)
    change = size * random.normal(size=answer.controls.shape)
    change[random.random(len(change)) < random.random()] = 0.0
    other = cost(sample, np.clip(answer.controls + change, -1.0, 1.0))
    saved = cost(sample, np.zeros_like(answer.controls)) - best
    assert other >= best - 1e-8 * max(saved, abs(best))


@settings(max_examples=25)
@given(
    st.integers(0, 10**6),
    st.integers(1, 12),
    st.floats(0.01, 100.0),
    st.booleans(),
)
def test_random_programs_agree_with_clarabel(seed, stages, weight, one_norm):
    """Made-up programs with random planes, bounds, weights: costs within 1e-6."""
    random = np.random.default_rng(seed)
    a = np.eye(6) + 0.1 * random.normal(size=(stages, 6, 6))
    # the solver's A does not mix motion in the orbit's plane and out of it
    inside, outside = np.array([0, 1, 3, 4]), np.array([2, 5])
    a[:, inside[:, None], outside] = 0.0
    a[:, outside[:, None], inside] = 0.0
    root = random.normal(size=(6, 6))
    bounds = 4
    program = Program(
        a,
        random.uniform(0.0, 1.0, 6),
        root @ root.T,
        random.normal(size=(stages + 1, 6)),
        np.zeros(3) if one_norm else random.uniform(0.1, 1.0, 3),
        random.uniform(0.1, 1.0, 3) if one_norm else np.zeros(3),
        random.integers(0, 4, stages + 1),
        random.normal(size=(stages + 1, 3, 3)),
        random.normal(size=(stages + 1, 3)),
        weight * random.uniform(0.5, 2.0, (stages + 1, 3)),
        random.integers(0, 6, bounds),
        random.choice([-1.0, 1.0], bounds),
        random.normal(size=(stages + 1, bounds)),
        weight * random.uniform(0.5, 2.0, (stages + 1, bounds)),
    )
    sample = Sample("random", program, stages, random.normal(size=6))
    mine = qp_solvers.own(sample, 1e-10)
    other = qp_solvers.clarabel(qp_solvers.sparse_program(sample), 1e-9)
    assert mine.solved
    costs = [cost(sample, x.controls) for x in (mine, other)]
    assert costs[0] <= costs[1] + 1e-6 * (1.0 + abs(costs[1]))


def test_a_constraint_gives_way_only_where_it_must(law):
    """Before the overshoot plane: softened for a chaser that cannot stop, not for one that can."""
    record = guidance.settings([law])[0]
    empty, work = empty_program(15), workspace(15, PLANES, BOUNDS)
    excess = {}
    for speed in (-0.1, -3.0):
        state = np.array([0.0, 30.0, 0.0, 0.0, speed, 0.0])
        program, outside = write_program(record, 1, state, 0.0, empty)
        scaled = state / record["scales"][1]
        solution = solve(program, 15, scaled, work, TOLERANCE, ITERATION_LIMIT)
        assert solution.status == SOLVED and not outside
        assert len(solution.excesses) == 15 * 5
        excess[speed] = solution.excesses[solution.weights == record["hard_weights"][1]].max()
    assert excess[-0.1] < 0.01 * SOFTENED
    assert excess[-3.0] > 1e4 * SOFTENED


def test_an_interrupted_solution_says_so(programs):
    sample = programs[0]
    work = workspace(sample.stages, PLANES, BOUNDS)
    solution = solve(sample.program, sample.stages, sample.start, work, TOLERANCE, 3)
    assert (solution.status, solution.iterations) == (OUT_OF_STEPS, 3)


def test_not_a_number_is_no_solution(programs):
    sample = programs[0]
    work = workspace(sample.stages, PLANES, BOUNDS)
    start = np.full(6, np.nan)
    solution = solve(sample.program, sample.stages, start, work, TOLERANCE, ITERATION_LIMIT)
    assert solution.status != SOLVED


def test_answers_do_not_depend_on_what_was_solved_before(programs):
    """The workspace carries nothing from one program to the next: equal to the last bit."""
    largest = max(sample.stages for sample in programs)
    shared = workspace(largest, PLANES, BOUNDS)
    for sample in programs:
        alone = workspace(sample.stages, PLANES, BOUNDS)
        for work in (shared, alone):
            solve(sample.program, sample.stages, sample.start, work, TOLERANCE, ITERATION_LIMIT)
        assert np.array_equal(shared.controls[: sample.stages], alone.controls[: sample.stages]), (
            sample.kind
        )


@pytest.mark.parametrize("limit", [ITERATION_LIMIT, 7])
def test_programs_in_lanes_end_as_alone(law, limit):
    """Equal to the last bit for starts near and far, one that no step keeps in, and no number."""
    record = guidance.settings([law])[0]
    random = np.random.default_rng(5)
    for phase, scale in enumerate((1000.0, 100.0, 3.0)):
        states = scale * random.normal(size=(8, 6)) * np.r_[np.ones(3), np.full(3, 1e-3)]
        states[1], states[4], states[6] = 1e-3 * states[1], np.nan, 30.0 * states[6]
        groups = states.reshape(-1, LANES, 6)
        steps = [_ended_as_alone(law, record, phase, group, limit) for group in groups]
        assert len(set(np.ravel(steps))) > 1


def _ended_as_alone(law, record, phase, states, limit):
    """Steps of the programs of as many states as there are lanes, the same one by one."""
    stages = law.horizons[phase]
    together = together_for(max(law.horizons))
    for lane, state in enumerate(states):
        write_lane(record, phase, state, 0.0, together, lane)
    rows = solve_together(
        in_use(together.programs, record, phase), stages, together.scaled, together.work,
        TOLERANCE, limit, together.ends,
    )  # fmt: skip
    work = together.work
    for lane, state in enumerate(states):
        program, _ = write_program(record, phase, state, 0.0, empty_program(stages))
        alone = workspace(stages, PLANES, BOUNDS)
        scaled = state / record["scales"][phase]
        solution = solve(program, stages, scaled, alone, TOLERANCE, limit)
        assert (solution.status, solution.iterations) == tuple(together.ends[:, lane])
        for found, expected in (
            (work.controls[:stages, :, lane], solution.controls),
            (work.rows[EXCESS, :rows, lane], solution.excesses),
            (work.rows[WEIGHT, :rows, lane], solution.weights),
        ):
            assert np.array_equal(found, expected, equal_nan=True)
    return together.ends[1]


def test_programs_of_one_shape_have_their_rows_in_common(law, laws):
    """What lanes share is the same for equal keys, and the keys tell apart what differs."""
    every = [
        *laws.values(),
        law.with_(horizons=(20, 15, 12)),
        law.with_(penalties=(0.0, *law.penalties[1:])),
        law.with_(rotation_rate=1e-3),
        law.with_(eccentricity=0.1, true_anomaly=1.0),
    ]
    state, kinds = np.array([10.0, -200.0, 5.0, 0.0, 0.1, 0.0]), {}
    for record in guidance.settings(every):
        for phase in range(3):
            empty = empty_program(max(law.horizons))
            program, _ = write_program(record, phase, state, 0.0, empty)
            shared = (
                int(record["horizons"][phase]),
                tuple(program.plane_count[1 : record["horizons"][phase] + 1]),
                tuple(program.components),
                tuple(program.signs),
                bool(program.control_norm[0] > 0.0),
                len(program.transitions),
            )
            assert kinds.setdefault(shape(record, phase), shared) == shared
    assert len(set(kinds.values())) == len(kinds) > 4
