"""Lanes against the same operations on numbers one by one: equal bits, whatever the others hold."""

from itertools import product

import numpy as np
import pytest

from smallsat.dynamics.compiled import compiled_arithmetic
from smallsat.dynamics.lanes import (
    LANES,
    as_lanes,
    at_most,
    larger,
    less,
    power,
    root,
    size,
    smaller,
    some,
    where,
)

OUTCOMES = 10
NUMBERS = (0.0, -0.0, np.inf, -np.inf, np.nan, 1e-310, 1.7, -0.3)


@compiled_arithmetic
def one_by_one(a, b, out):
    """Fill what a number and another come to, in every operation that lanes know."""
    out[0] = a + 2.0 * b
    out[1] = (1.0 - a) / b - 3
    out[2] = -a * b
    out[3] = larger(a, b)
    out[4] = where(less(a, b), a, 7.0)
    out[5] = at_most(a, b) + less(b, 1)
    out[6] = root(size(a))
    total = 0.0
    for k in range(3):
        total += a * k
    total -= b
    total /= 3.0
    out[7] = total
    out[8] = power(size(a), 0.2)
    out[9] = smaller(a, b)


@compiled_arithmetic
def side_by_side(a, b, out):
    one_by_one(as_lanes(a)[0], as_lanes(b)[0], as_lanes(out))


@compiled_arithmetic
def any_of(flags):
    return some(as_lanes(flags)[0])


@pytest.mark.parametrize("offset", [0, 1])
def test_each_lane_is_a_number_on_its_own(offset):
    """Infinities, nothing and what is no number included; memory need not be aligned."""
    memory = np.empty((OUTCOMES + 2) * LANES + offset)[offset:]
    a, b, out = memory[:LANES], memory[LANES : 2 * LANES], memory[2 * LANES :]
    out = out.reshape(OUTCOMES, LANES)
    for pairs in np.array(list(product(NUMBERS, repeat=2))).reshape(-1, LANES, 2):
        a[:], b[:] = pairs.T
        side_by_side(a[None], b[None], out)
        for lane in range(LANES):
            alone = np.empty(OUTCOMES)
            one_by_one(a[lane], b[lane], alone)
            assert np.array_equal(out[:, lane], alone, equal_nan=True), pairs[lane]
            numbers = ~np.isnan(alone)
            assert out[numbers, lane].tobytes() == alone[numbers].tobytes(), pairs[lane]


def test_larger_and_smaller_are_pythons():
    alone = np.empty(OUTCOMES)
    for a, b in ((1.0, 2.0), (2.0, 1.0), (np.nan, 1.0), (1.0, np.nan), (0.0, -0.0)):
        one_by_one(a, b, alone)
        assert np.array_equal(alone[3], max(a, b), equal_nan=True)
        assert np.array_equal(alone[9], min(a, b), equal_nan=True)


@pytest.mark.parametrize("lane", range(LANES))
def test_a_flag_of_any_lane_is_seen(lane):
    flags = np.zeros((1, LANES))
    assert not any_of(flags)
    flags[0, lane] = 1e-310
    assert any_of(flags)
