"""How fast a machine is at the time: work of libraries, which no commit of this project changes.

What one waits for on a machine with other guests differs by half and more from day to day, and this
differs with it. Most of a build is of its kind: IPOPT, its linear algebra, functions of CasADi.
"""

import statistics
import time

import casadi as ca
import numpy as np

INTERVALS = 400
SOLVES = 25


def oscillator() -> tuple[ca.Function, dict[str, np.ndarray]]:
    """The Van der Pol oscillator, regulated for 10 s, by multiple shooting of order 4.

    The solver, and the bounds that it is called with; the step is 0.025 s, the control within 1.
    """
    states = ca.MX.sym("states", 2, INTERVALS + 1)
    controls = ca.MX.sym("controls", 1, INTERVALS)
    x, u = ca.MX.sym("x", 2), ca.MX.sym("u")
    rate = ca.Function("rate", [x, u], [ca.vertcat(x[1], (1 - x[0] ** 2) * x[1] - x[0] + u)])
    step = ca.simpleRK(rate, 1)
    ends = step.map(INTERVALS)(states[:, :-1], controls, 10 / INTERVALS)
    program = {
        "x": ca.veccat(states, controls),
        "f": ca.sumsqr(states) + ca.sumsqr(controls),
        "g": ca.vec(ends - states[:, 1:]),
    }
    quiet = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes"}}
    solver = ca.nlpsol("yardstick", "ipopt", program, quiet)
    free = np.full((INTERVALS + 1, 2), np.inf)
    start = np.vstack([[0.0, 1.0], free[1:]])
    limits = np.ones(INTERVALS)
    bounds = {
        "lbx": np.concatenate([np.vstack([start[:1], -free[1:]]).ravel(), -limits]),
        "ubx": np.concatenate([start.ravel(), limits]),
        "lbg": np.zeros(2 * INTERVALS),
        "ubg": np.zeros(2 * INTERVALS),
    }
    return solver, bounds


def yardstick() -> float:
    """Wall seconds of a solve, the median of several."""
    solver, bounds = oscillator()
    taken = []
    for _ in range(SOLVES):
        began = time.perf_counter()
        solver(**bounds)
        taken.append(time.perf_counter() - began)
        if not solver.stats()["success"]:
            raise RuntimeError(f"yardstick: IPOPT: {solver.stats()['return_status']}")
    return statistics.median(taken)
