"""The listing's flight on the steps of MATLAB's ``ode45``, compiled.

Dormand and Prince's pair of orders 5 and 4 with the step control of Shampine and Reichelt, "The
MATLAB ODE Suite" (SIAM J. Sci. Comput. 18, 1997): the error of a step relative to the larger of the
state at its two ends and a threshold, a first step from the first rate, a tenth of the span at
most.
"""

from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled, compiled_arithmetic
from smallsat.dynamics.lanes import (
    LANES,
    as_lanes,
    at_most,
    larger,
    less,
    power,
    size,
    smaller,
    some,
    where,
)
from smallsat.studies.racing.model.shooting import rate

NODES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERROR = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
POWER = 1.0 / 5.0
EPSILON = np.finfo(float).eps
STAGES, STATES = 7, 12


class Workspace(NamedTuple):
    """What a flight writes on; of lanes, each has a last axis more.

    Attributes
    ----------
    state
        State and costate, (12,): where a flight begins, and where it ended.
    new
        The same after the step that is tried.
    rates
        Rates at the stages of the step, (7, 12).
    """

    state: np.ndarray
    new: np.ndarray
    rates: np.ndarray


@compiled
def end_of_flight(y, t, end, n, transposed, law, limits, deadzone, tolerance):
    """State and costate (12,) at ``end``, from ``t``, s, and how many steps were tried.

    ``tolerance`` is both the relative and the absolute one. Where the step falls below the spacing
    of numbers, the flight ends there, as ``ode45`` does with a warning.
    """
    work = Workspace(y.copy(), np.empty(STATES), np.empty((STAGES, STATES)))
    tried = _fly(work, t, end, n, transposed, law, limits, deadzone, tolerance)
    return work.state, tried


@compiled
def ends_of_flights(y, t, ends, n, transposed, law, limits, deadzone, tolerance):
    """The same of LANES flights (LANES, 12) that end at times (LANES,), each to the same bits."""
    state, new = np.empty((STATES, LANES)), np.empty((STATES, LANES))
    state[:] = y.T
    rates = np.empty((STAGES, STATES, LANES))
    work = Workspace(as_lanes(state), as_lanes(new), as_lanes(rates))
    end = as_lanes(ends.reshape(1, LANES))[0]
    _fly(work, t, end, n, transposed, law, limits, deadzone, tolerance)
    return state.T.copy()


@compiled_arithmetic
def _fly(work, t, end, n, transposed, law, limits, deadzone, tolerance):
    """Fly from the state of a workspace to its end; return how many steps were tried.

    Of lanes, each tries steps of its own, until all have ended.
    """
    y, new, rates = work
    rate(y, n, transposed, law, limits, deadzone, rates[0])
    most, steepest = 0.1 * (end - t), 0.0
    for i in range(STATES):
        steepest = larger(steepest, size(rates[0, i]) / larger(size(y[i]), 1.0))
    steepest /= 0.8 * tolerance**POWER
    h = smaller(most, end - t)
    h = where(less(1.0, h * steepest), 1.0 / steepest, h)
    flies, failed, tried = 1.0, 0.0, 0.0
    while some(flies):
        tried += flies
        least = 16.0 * EPSILON * larger(size(t), 1e-300)
        # A step that failed is tried with the length that this left it.
        proposed = smaller(most, larger(least, h))
        last = where(failed, 0.0, at_most(end - t, 1.1 * proposed))
        h = where(failed, h, where(last, end - t, proposed))
        for s in range(1, STAGES):
            for i in range(STATES):
                total = 0.0
                for j in range(s):
                    total += NODES[s, j] * rates[j, i]
                new[i] = y[i] + h * total
            rate(new, n, transposed, law, limits, deadzone, rates[s])
        error = 0.0
        for i in range(STATES):
            total = 0.0
            for j in range(STAGES):
                total += ERROR[j] * rates[j, i]
            error = larger(error, size(total) / larger(larger(size(y[i]), size(new[i])), 1.0))
        error *= h
        small = at_most(error, tolerance)
        off = power(where(small, error / tolerance, tolerance / error), POWER)
        taken = flies * small
        ends = where(small, last, where(at_most(h, least), 1.0, 1.0 - less(error, np.inf)))
        for i in range(STATES):
            y[i] = where(taken, new[i], y[i])
            rates[0, i] = where(taken, rates[STAGES - 1, i], rates[0, i])
        t = where(taken, t + h, t)
        after = where(less(0.2, 1.25 * off), h / (1.25 * off), 5.0 * h)
        again = larger(least, where(failed, 0.5 * h, h * larger(0.1, 0.8 * off)))
        h = where(small, where(failed, h, after), again)
        failed = 1.0 - small
        flies *= 1.0 - ends
    return tried
