"""Orders of convergence against theory, and the loss of shooting against its prediction."""

import numpy as np
import pandas as pd
import pytest

from smallsat.optimal_control.collocation import Collocation
from smallsat.studies.transfer.methods import convergence
from smallsat.studies.transfer.methods.direct import Case
from smallsat.studies.transfer.methods.extremals import find_extremals
from smallsat.studies.transfer.methods.indirect import propagate_extremal
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import units_of


@pytest.fixture(scope="module")
def problem(config):
    return TransferProblem.of(config.transfer.problem)


@pytest.fixture(scope="module")
def extremal(problem, config):
    found = find_extremals(problem, units_of(problem), (1,), config.transfer.guess, 192)[1]
    return propagate_extremal(problem, found.extremal, convergence.SAMPLES)[1]


@pytest.mark.parametrize(
    ("points", "degree", "meshes", "room"),
    [
        ("legendre", 1, (40, 80), 0.1),
        ("legendre", 2, (112, 224), 0.4),
        ("radau", 2, (112, 224), 0.2),
    ],
)
def test_collocation_has_its_order_for_the_optimum(problem, extremal, points, degree, meshes, room):
    """The final time's error between two fine meshes: 2 d at Gauss's points, 2 d - 1 at Radau's."""
    optimum = extremal["t"].iloc[-1]
    errors = [
        convergence.collocate(problem, Collocation(count, degree, points), extremal).objective
        - optimum
        for count in meshes
    ]
    measured = np.log(errors[0] / errors[1]) / np.log(meshes[1] / meshes[0])
    theory = convergence.theoretical_order(convergence.collocation_name(points), degree)
    assert measured == pytest.approx(theory, abs=room)


@pytest.mark.parametrize(("degree", "intervals"), [(1, 32), (2, 16), (4, 8), (6, 4)])
def test_shooting_loses_what_the_extremal_says(problem, extremal, degree, intervals):
    """A solved program against a projection of the extremal's control, nothing fitted: to 2 %."""
    case = Case(degree, intervals, "local")
    solution = convergence.shoot(problem, case, extremal, 128)
    lost = solution.objective - extremal["t"].iloc[-1]
    predicted = convergence.predicted_loss(problem, extremal, case)
    assert lost == pytest.approx(predicted, rel=0.02)


def test_predicted_loss_falls_by_the_order_of_theory(problem, extremal):
    """Steps and lines, once they are shorter than the turn of the thrust: orders 2 and 4."""
    for degree in (0, 1):
        losses = [
            convergence.predicted_loss(problem, extremal, Case(degree, count, "local"))
            for count in (256, 512)
        ]
        order = convergence.theoretical_order(convergence.SHOOTING, degree)
        assert np.log2(losses[0] / losses[1]) == pytest.approx(order, abs=0.1)


def test_orders_are_read_above_the_floor():
    """Errors of a known order that end in the solver's noise: the order all the same."""
    intervals = np.array(convergence.INTERVALS)
    error = np.maximum((intervals / 8.0) ** -6.0 * 1e-6, 3e-13)
    table = pd.DataFrame(
        {"method": "direct shooting", "degree": 2, "intervals": intervals, "error": error}
    )
    row = convergence.orders(table).iloc[0]
    assert row["measured"] == pytest.approx(6.0)
    assert row["theory"] == 6
    assert row["error"] > convergence.FLOOR
