"""Functions as machine code: against CasADi's own evaluation, to the last bit."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smallsat.optimal_control.machine_code import OPERATIONS, Chain, Everywhere

x, p, each = ca.SX.sym("x", 3), ca.SX.sym("p", 2), ca.SX.sym("e", 2)


def step_of(*values):
    return ca.Function("step", [x, p, each], [ca.vertcat(*values)])


# Every operation that has a translation, a constant that no decimal number is, and a register that
# is read after another one has been written.
EVERYTHING = step_of(
    x[1] * 0.1 + ca.sin(x[0]) / (2.0 + ca.cos(p[0])) - x[2] ** 2,
    ca.sin(-x[0]) + 2 * x[1] + 1 / (3 + x[2] ** 2) + ca.sqrt(1 + x[0] ** 2) * each[0],
    (2.0 + ca.sin(x[1])) ** 1.5 * each[1] + (1.5 + ca.cos(x[2])) ** ca.sin(p[1]),
)
EVERYTHING_CHAIN = Chain(EVERYTHING)


def by_casadi(step, state, parameters, own):
    for row in own:
        state = step(state, parameters, row).full().ravel()
    return state


moderate = st.floats(-3.0, 3.0)


@given(
    st.lists(moderate, min_size=3, max_size=3),
    st.lists(moderate, min_size=2, max_size=2),
    st.lists(st.tuples(moderate, moderate), min_size=1, max_size=7),
)
def test_a_chain_has_the_bits_of_casadi(state, parameters, own):
    state, parameters, own = (np.array(values) for values in (state, parameters, own))
    kept = state.copy()
    assert np.array_equal(
        EVERYTHING_CHAIN(state, parameters, own), by_casadi(EVERYTHING, state, parameters, own)
    )
    assert np.array_equal(state, kept)


def test_every_operation_is_tried():
    """What the step above is made of is all that can be translated."""
    used = {EVERYTHING.instruction_id(k) for k in range(EVERYTHING.n_instructions())}
    assert used >= set(OPERATIONS)


def test_what_is_no_number_stays_none():
    chain = Chain(step_of(x[0] / x[1], x[1], ca.sqrt(x[2])))
    with np.errstate(all="ignore"):
        end = chain(np.array([1.0, 0.0, -1.0]), np.zeros(2), np.zeros((1, 2)))
    assert end[0] == np.inf and np.isnan(end[2])


def test_an_operation_without_translation_is_refused():
    with pytest.raises(ValueError, match=r"step: CasADi's operation .* has no translation yet"):
        Chain(step_of(ca.tanh(x[0]), x[1], x[2]))


def test_what_is_not_dense_is_refused():
    sparse = ca.Function("step", [x, p, each], [ca.SX(3, 1)])
    with pytest.raises(ValueError, match="step: a chain takes dense vectors"):
        Chain(sparse)


@pytest.mark.parametrize(
    ("state", "parameters", "own"),
    [((4,), (2,), (1, 2)), ((3,), (1,), (1, 2)), ((3,), (2,), (1, 3)), ((3,), (2,), (0, 2))],
)
def test_other_shapes_are_refused(state, parameters, own):
    with pytest.raises(ValueError, match="is given"):
        EVERYTHING_CHAIN(np.zeros(state), np.zeros(parameters), np.zeros(own))


def test_a_function_everywhere_has_the_bits_of_casadis_map():
    """Of matrices, in an expression of its own, with an argument that CasADi knows to be zero."""
    u, t = ca.SX.sym("u", 2, 2), ca.SX.sym("t")
    values = ca.vertcat(ca.sin(x[0]) * x[1] / u[1, 0] + t, ca.sqrt(2.0 + u[0, 1] ** 2 + x[2] ** 2))
    slopes = ca.densify(ca.jacobian(values, x))
    function, places = ca.Function("f", [x, u, t], [slopes]), 5
    ours, theirs = Everywhere(function, places), function.map(places)
    random = np.random.default_rng(5)
    at, control = random.normal(size=(3, places)), random.normal(size=(2, 2 * places))
    states, controls = ca.MX.sym("x", 3, places), ca.MX.sym("u", 2, 2 * places)
    still = ca.MX.zeros(1, places)
    wrapped = ca.Function("g", [states, controls], [2.0 * ours(states, controls, still)])
    expected = 2.0 * theirs(at, control, np.zeros(places)).full()
    assert np.array_equal(wrapped(at, control).full(), expected)


def test_a_sparse_function_is_not_applied_everywhere():
    with pytest.raises(ValueError, match="f: dense matrices alone"):
        Everywhere(ca.Function("f", [x], [ca.SX(3, 1)]), 2)
