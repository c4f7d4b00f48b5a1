"""The listing's flight on the steps of MATLAB's ``ode45``, compiled.

Dormand and Prince's pair of orders 5 and 4 with the step control of Shampine and Reichelt, "The
MATLAB ODE Suite" (SIAM J. Sci. Comput. 18, 1997): the error of a step relative to the larger of the
state at its two ends and a threshold, a first step from the first rate, a tenth of the span at
most.
"""

import numpy as np

from smallsat.dynamics.compiled import compiled
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


@compiled
def end_of_flight(y, t, end, n, transposed, law, limits, deadzone, tolerance):
    """State and costate (12,) at ``end``, from ``t``, s, and how many steps were tried.

    ``tolerance`` is both the relative and the absolute one. Where the step falls below the spacing
    of numbers, the flight ends there, as ``ode45`` does with a warning.
    """
    rates = np.empty((7, 12))
    y, new = y.copy(), np.empty(12)
    rate(y, n, transposed, law, limits, deadzone, rates[0])
    most = 0.1 * (end - t)
    h = min(most, end - t)
    steepest = 0.0
    for i in range(12):
        steepest = max(steepest, abs(rates[0, i]) / max(abs(y[i]), 1.0))
    steepest /= 0.8 * tolerance**POWER
    if h * steepest > 1.0:
        h = 1.0 / steepest
    tried, done = 0, False
    while not done:
        least = 16.0 * EPSILON * max(abs(t), 1e-300)
        h = min(most, max(least, h))
        if 1.1 * h >= end - t:
            h, done = end - t, True
        failed = False
        while True:
            tried += 1
            for s in range(1, 7):
                for i in range(12):
                    total = 0.0
                    for j in range(s):
                        total += NODES[s, j] * rates[j, i]
                    new[i] = y[i] + h * total
                rate(new, n, transposed, law, limits, deadzone, rates[s])
            error = 0.0
            for i in range(12):
                total = 0.0
                for j in range(7):
                    total += ERROR[j] * rates[j, i]
                error = max(error, abs(total) / max(abs(y[i]), abs(new[i]), 1.0))
            error *= h
            if error <= tolerance:
                break
            if h <= least or not error < np.inf:
                return y, tried
            if failed:
                h = max(least, 0.5 * h)
            else:
                failed = True
                h = max(least, h * max(0.1, 0.8 * (tolerance / error) ** POWER))
            done = False
        t = end if done else t + h
        y[:] = new
        rates[0] = rates[6]
        if not failed:
            smaller = 1.25 * (error / tolerance) ** POWER
            h = h / smaller if smaller > 0.2 else 5.0 * h
    return y, tried
