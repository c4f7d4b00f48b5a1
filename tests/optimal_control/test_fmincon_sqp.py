"""The documented SQP method: known optima, redundant and contradictory equalities, its limits."""

import numpy as np
import pytest

from smallsat.optimal_control.fmincon_sqp import Problem, minimise

FREE = np.full(2, np.inf)


def _at_each(function):
    """A function of one point as one of several."""
    return lambda points: np.array([function(z) for z in points])


@_at_each
def _rosenbrock(z):
    """MathWorks' example: Rosenbrock's function within the unit disc."""
    return np.r_[100.0 * (z[1] - z[0] ** 2) ** 2 + (1.0 - z[0]) ** 2, z @ z - 1.0]


def test_the_documented_example():
    """Fmincon's page: Rosenbrock in the unit disc from the origin ends at (0.7864, 0.6177)."""
    found = minimise(Problem(_rosenbrock, -FREE, FREE, 0), np.zeros(2), 3000)
    assert found.exit_flag == 1
    assert found.variables == pytest.approx([0.7864, 0.6177], abs=5e-5)


@pytest.mark.parametrize("copies", [1, 2, 5])
def test_redundant_equalities_do_no_harm(copies):
    """Least x + y on a circle is at (-1, -1), however often the equality is written."""

    @_at_each
    def functions(z):
        return np.r_[z.sum(), np.full(copies, z @ z - 2.0)]

    found = minimise(Problem(functions, -FREE, FREE, copies), np.array([-2.0, 0.5]), 3000)
    assert found.exit_flag in (1, 2)
    assert found.variables == pytest.approx([-1.0, -1.0], abs=1e-5)


def test_a_contradiction_ends_infeasible():
    """Both x = 0 and x = 1: relaxed steps lead between them, and the flag says so."""
    found = minimise(
        Problem(_at_each(lambda z: np.r_[0.0, z[0], z[0] - 1.0]), -FREE, FREE, 2),
        np.array([5.0, 0.0]),
        3000,
    )
    assert found.exit_flag == -2
    assert -1e-6 <= found.variables[0] <= 1.0 + 1e-6
    assert found.violation >= 0.5 - 1e-6


def test_inequalities_and_bounds():
    """Nearest point to (2, 2) with x + y <= 2 and x <= 0.5: (0.5, 1.5) to 1e-5."""

    @_at_each
    def functions(z):
        return np.r_[np.sum((z - 2.0) ** 2), z.sum() - 2.0]

    found = minimise(Problem(functions, -FREE, np.array([0.5, np.inf]), 0), np.zeros(2), 3000)
    assert found.exit_flag in (1, 2)
    assert found.variables == pytest.approx([0.5, 1.5], abs=1e-5)


@pytest.mark.parametrize("ahead", [1, 8])
def test_bounds_are_never_left(ahead):
    """Strict feasibility with respect to bounds: no evaluation lies beyond them."""
    seen = []

    @_at_each
    def functions(z):
        seen.append(z.copy())
        return np.r_[-z.sum(), z @ z - 2.0]

    lower, upper = np.zeros(2), np.array([0.3, 5.0])
    minimise(Problem(functions, lower, upper, 0, ahead), np.array([0.3, 5.0]), 3000)
    assert all(((lower <= z) & (z <= upper)).all() for z in seen)


def test_evaluations_are_counted():
    """Differences included; with few of them the flag is 0."""
    calls = []

    def functions(points):
        calls.extend(points)
        return _rosenbrock(points)

    found = minimise(Problem(functions, -FREE, FREE, 0), np.zeros(2), 10)
    assert (found.exit_flag, found.evaluations) == (0, len(calls))


@pytest.mark.parametrize("evaluations", [10, 11, 12, 13, 3000])
@pytest.mark.parametrize("ahead", [2, 8])
def test_steps_evaluated_together_change_nothing(evaluations, ahead):
    """The same points to the last bit, and the same count: what lies beyond the end is not seen."""
    one, other = (
        minimise(Problem(_rosenbrock, -FREE, FREE, 0, count), np.zeros(2), evaluations)
        for count in (1, ahead)
    )
    assert one.variables.tobytes() == other.variables.tobytes()
    assert (one.exit_flag, one.iterations) == (other.exit_flag, other.iterations)
    assert one.evaluations == other.evaluations
