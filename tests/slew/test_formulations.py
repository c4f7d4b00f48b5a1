"""What the document says of its formulation: methods against what is known, and predicates."""

import casadi as ca
import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from smallsat.dynamics.attitude.attitude_propagator import transition
from smallsat.optimal_control.collocation_schemes import (
    FINAL_TIME,
    SCHEMES,
    collocation_points,
    errors,
    solution,
)
from smallsat.studies.slew.evidence import formulation_claims as claims
from smallsat.studies.slew.methods.attitude_steps import (
    RUNGE_KUTTA,
    closed_form,
    compared_steps,
    operations,
    runge_kutta,
)
from smallsat.studies.slew.methods.gradient_forms import FORMS

RNG = np.random.default_rng(13)


@pytest.mark.parametrize(("scheme", "degree"), list(zip(SCHEMES, (9, 8, 7), strict=True)))
def test_quadrature_of_the_points_is_exact_as_far_as_it_can_be(scheme, degree):
    """Five points integrate powers up to 2 N - 1, one or two less where ends are points."""
    points, weights = collocation_points(scheme, 5)
    assert (points[0] == -1.0) == (scheme != "Gauss") and (points[-1] == 1.0) == (
        scheme == "Lobatto"
    )
    for power in range(degree + 1):
        exact = (1.0 - (-1.0) ** (power + 1)) / (power + 1)
        assert weights @ points**power == pytest.approx(exact, abs=1e-13)
    assert weights @ points ** (degree + 1) != pytest.approx(
        (1.0 - (-1.0) ** (degree + 2)) / (degree + 2), abs=1e-6
    )


def test_the_known_solution_obeys_its_equations():
    """State and costate by central differences, and the control where the Hamiltonian is flat."""
    t, d = np.linspace(0.1, FINAL_TIME - 0.1, 7), 1e-5
    (y, u, costate), before, after = (solution(t + shift) for shift in (0.0, -d, d))
    np.testing.assert_allclose(u, y / 2.0, rtol=1e-12)
    np.testing.assert_allclose(
        (after[0] - before[0]) / (2 * d), 2.5 * (-y + y * u - u * u), rtol=1e-7
    )
    np.testing.assert_allclose(
        (after[2] - before[2]) / (2 * d), 2.5 * costate * (1.0 - u), rtol=1e-6
    )
    assert solution(np.array([FINAL_TIME]))[2][0] == pytest.approx(-1.0)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_errors_fall_with_the_points(scheme):
    """By more than a hundred from 6 points to 14, in state and control."""
    few, many = errors(scheme, 6), errors(scheme, 14)
    assert few.converged and many.converged
    assert many.state < 1e-2 * few.state and many.control < 5e-2 * few.control


def test_a_program_is_solved_to_its_tolerance_alone():
    """On 20 Lobatto points to a control that is off by 4.68e-5, whatever the linear algebra does.

    The point near the solution at which the solver would stop is off by 1e-11, since it leaves a
    constraint at 2e-10 that only such a control meets.
    """
    found = errors("Lobatto", 20)
    assert found.converged
    assert found.control == pytest.approx(4.677e-5, rel=1e-3)
    assert found.state == pytest.approx(1.953e-10, rel=1e-2)


def test_steps_turn_as_the_compiled_transition_does():
    """The closed form to rounding, the Runge-Kutta methods by their orders."""
    q = RNG.normal(size=4)
    q /= np.linalg.norm(q)
    rate = 0.1 * RNG.normal(size=3)
    expected = np.array(transition(tuple(q), tuple(rate)))
    np.testing.assert_allclose(
        closed_form()(q, rate, rate, 1.0).full().ravel(), expected, atol=1e-14
    )
    off = [
        np.linalg.norm(runge_kutta(name)(q, rate, rate, 1.0).full().ravel() - expected)
        for name in RUNGE_KUTTA
    ]
    assert off == sorted(off, reverse=True) and off[0] < 1e-2 and off[-1] < 1e-6


def test_operations_are_those_of_the_expression():
    """Two additions, a product and a sine."""
    x = ca.SX.sym("x", 3)
    assert operations(ca.Function("f", [x], [ca.sin((x[0] + x[1] + x[2]) * x[0])])) == 4


def test_both_forms_turn_a_vector_alike():
    """As SciPy's rotation does, to rounding."""
    q, r = RNG.normal(size=4), RNG.normal(size=3)
    q /= np.linalg.norm(q)
    for form in FORMS.values():
        symbol = ca.SX.sym("q", 4)
        turned = ca.Function("f", [symbol], [form.in_body(None, symbol, ca.DM(r))])(q)
        np.testing.assert_allclose(turned.full().ravel(), Rotation.from_quat(q).inv().apply(r))


@pytest.fixture
def judged(section, tmp_path, grounds):
    """The outcome of a predicate for a table by its name, and for other printed values."""

    def of(predicate, tables, printed=None):
        for file, table in tables.items():
            table.to_csv(tmp_path / file, index=False)
        return predicate(grounds("slew", section, tmp_path, printed)).outcome

    return of


@pytest.mark.parametrize(("lobatto", "outcome"), [(1e-3, "holds"), (5e-8, "fails")])
def test_schemes_are_told_apart_on_points_that_all_solve(judged, lobatto, outcome):
    """On the most points one scheme did not converge: the fewer ones count."""
    rows = [
        {"scheme": scheme, "points": points, "converged": points < 20 or scheme != "Lobatto"}
        | dict.fromkeys(("state", "control", "costate"), lobatto if scheme == "Lobatto" else 1e-8)
        for points in (10, 20)
        for scheme in SCHEMES
    ]
    tables = {"collocation.csv": pd.DataFrame(rows)}
    assert judged(claims.gauss_and_radau_beat_lobatto, tables) == outcome


def steps(error, operations=50, at_rest=False):
    """Of the closed form with 70 operations and 0.01 deg, and of another method."""
    row = {"flight": "a turn", "step_s": 1.0}
    own = {"method": "closed form", "operations": 70, "error_deg": 0.01, "at_rest": at_rest}
    other = {"method": "another", "operations": operations, "error_deg": error, "at_rest": True}
    table = pd.DataFrame([row | own, row | other])
    return {"attitude-steps.csv": table.assign(operations_per_s=table["operations"])}


def test_a_method_as_accurate_and_cheaper_refutes_the_closed_form(judged):
    """Cheaper but less accurate, or as accurate but dearer, does not."""
    predicate = claims.transition_is_cheaper
    assert judged(predicate, steps(0.02)) == "holds"
    assert judged(predicate, steps(0.01, operations=71)) == "holds"
    assert judged(predicate, steps(0.01)) == "fails"


def test_a_closed_form_with_a_number_at_rest_is_not_singular(judged):
    """As that of the compiled propagator, which continues it."""
    predicate = claims.transition_is_singular_at_rest
    assert judged(predicate, steps(0.01)) == "holds"
    assert judged(predicate, steps(0.01, at_rest=True)) == "fails"


def test_steps_are_compared_on_a_flight():
    """A turn about z at a rate that grows: one row a method and step, and the closed form exact."""
    time = np.arange(0.0, 20.05, 0.1)
    angle = 0.5e-3 * time**2
    flown = pd.DataFrame({"time_s": time, "omega_x": 0.0, "omega_y": 0.0, "omega_z": 1e-3 * time})
    flown = flown.assign(q_1=0.0, q_2=0.0, q_3=np.sin(angle / 2.0), q_4=np.cos(angle / 2.0))
    table = compared_steps({"a turn": flown}, 1.0)
    assert len(table) == 2 * (1 + len(RUNGE_KUTTA))
    own = table[table["method"] == "closed form"]
    assert own["error_deg"].max() < 1e-6 and not own["at_rest"].any()
    assert table.loc[table["method"] == "Euler", "error_deg"].min() > 1e-6


@pytest.mark.parametrize(("angles", "outcome"), [(False, "holds"), (True, "fails")])
def test_forms_are_told_apart_by_what_converges(judged, angles, outcome):
    """One start that the Euler angles lose is enough."""
    forms = {"form": ["quaternion", "Euler angles"], "converged": [True, angles], "iterations": 9}
    tables = {"gradient-forms.csv": pd.DataFrame(forms)}
    assert judged(claims.euler_angles_diverge, tables) == outcome


@pytest.mark.parametrize(
    ("half", "all_", "outcome"),
    [(0.6, 0.2, "fails"), (2.0, 0.2, "holds"), (2.0, 1.5, "fails")],
)
def test_nodes_are_needed_if_half_of_them_do_not_fly(judged, half, all_, outcome):
    """The printed run ends 1.21 deg off."""
    nodes = {"share": [0.5, 1.0], "nodes": [10, 20], "converged": True, "miss_deg": [half, all_]}
    assert judged(claims.nodes_are_needed, {"nodes.csv": pd.DataFrame(nodes)}) == outcome


def test_printed_seconds_and_peaks_decide_the_printed_sentences(judged):
    """Another time for the other nodes; a peak of the minimal size, and one beyond the law's."""
    time = "table-4/propagator-run-time/180-deg-i7-2700k"
    assert judged(claims.propagator_ignores_nodes, {}) == "holds"
    assert judged(claims.propagator_ignores_nodes, {}, {time: "0.8"}) == "fails"
    peak = "section-vi-b/maximum-angular-momentum-usage/180-deg-torque-optimal"
    assert judged(claims.moderate_momentum, {}) == "holds"
    assert judged(claims.moderate_momentum, {}, {f"{peak}/x": "2.0"}) == "fails"
    assert judged(claims.moderate_momentum, {}, {f"{peak}/y": "60.0"}) == "fails"
