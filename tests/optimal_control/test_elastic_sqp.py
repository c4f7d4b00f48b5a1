"""The elastic method: known optima, redundant equalities, contradictions."""

import numpy as np
import pytest

from smallsat.optimal_control.elastic_sqp import ElasticSqp

FREE = np.full(2, np.inf)


def _circle(copies):
    """Least x + y on a circle of radius sqrt(2), the equality written ``copies`` times."""

    def functions(z):
        values = np.r_[z.sum(), np.full(copies, z @ z - 2.0)]
        return values, np.vstack([np.ones(2), *(2.0 * z for _ in range(copies))])

    return functions


@pytest.mark.parametrize("copies", [1, 2, 5])
def test_redundant_equalities_do_no_harm(copies):
    """The optimum (-1, -1) to 1e-6, although all rows of the equalities are one row."""
    solver = ElasticSqp(2, copies, 0)
    guess = np.array([-2.0, 0.5])
    _, jacobian = _circle(copies)(guess)
    assert np.linalg.matrix_rank(jacobian[1:]) == 1
    found = solver.solve(_circle(copies), guess, -FREE, FREE, 1e-8, 200)
    assert found.converged
    assert found.variables == pytest.approx([-1.0, -1.0], abs=1e-6)


def test_a_contradiction_is_no_convergence():
    """Both x = 0 and x = 1: the end is between them, and says that it violates."""

    def functions(z):
        return np.r_[0.0, z[0], z[0] - 1.0], np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]])

    found = ElasticSqp(2, 2, 0).solve(functions, np.zeros(2), -FREE, FREE, 1e-8, 100)
    assert not found.converged
    assert found.violation >= 0.5 - 1e-6


def test_inequalities_and_bounds():
    """Nearest point to (2, 2) with x + y <= 2 and x <= 0.5: (0.5, 1.5) to 1e-6."""

    def functions(z):
        values = np.r_[np.sum((z - 2.0) ** 2), z.sum() - 2.0]
        return values, np.vstack([2.0 * (z - 2.0), np.ones(2)])

    upper = np.array([0.5, np.inf])
    found = ElasticSqp(2, 0, 1).solve(functions, np.zeros(2), -FREE, upper, 1e-9, 100, 10.0)
    assert found.converged
    assert found.variables == pytest.approx([0.5, 1.5], abs=1e-6)
