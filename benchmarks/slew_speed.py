"""The slew study's optimisations, and the same problem through yapss where that is installed.

``make benchmark-baseline`` installs yapss beside the project; it is no dependency of it. Both solve
the 90 deg turn at N = 20 with the same smoothing stages, from the same kind of guess, in this run.
"""

import importlib.util
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from smallsat.config import default_config
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.methods.guidance_problem import Guidance, Result, problem, turning_guess
from smallsat.studies.slew.methods.plans import guidance_model
from smallsat.studies.slew.parameters import Parameters

ROOT = Path(__file__).parents[1]
REPETITIONS = 3
HALF_TURN_S = 110.0


def measure() -> dict[str, float]:
    """Seconds of solving and costs; those of yapss too, where it is installed."""
    section = default_config(ROOT).slew
    parameters = Parameters.from_section(section)
    smoothing = section.numerics.smoothing
    nodes = section.manoeuvre.quarter.nodes
    half = section.manoeuvre.half
    quarter = _solved(parameters, "quarter", parameters.duration, Mesh(1, nodes), smoothing)
    turn = _solved(
        parameters, "half", HALF_TURN_S, Mesh(half.segments, half.segment_nodes), smoothing
    )
    found = {
        "quarter_turn_s": quarter.seconds,
        "quarter_turn_cost_mN_m_s": 1e3 * quarter.cost,
        "quarter_turn_converged": float(quarter.solution.converged),
        "half_turn_s": turn.seconds,
        "half_turn_cost_mN_m_s": 1e3 * turn.cost,
        "half_turn_converged": float(turn.solution.converged),
    }
    if importlib.util.find_spec("yapss") is None:
        print("  yapss is not installed: no baseline; `make benchmark-baseline` installs it")
        return found
    seconds, cost, stages = _yapss(parameters, nodes, smoothing)
    # Compared over the stages that yapss converges in; ours goes on to less smoothing.
    same = _solved(
        parameters, "quarter", parameters.duration, Mesh(1, nodes), smoothing[: max(stages, 1)]
    )
    return found | {
        "yapss_quarter_turn_s": seconds,
        "yapss_quarter_turn_cost_mN_m_s": 1e3 * cost,
        "stages_compared": float(stages),
        "quarter_turn_same_stages_s": same.seconds,
        "quarter_turn_same_stages_cost_mN_m_s": 1e3 * same.cost,
        "ratio": seconds / same.seconds,
    }


def _solved(
    parameters: Parameters, case: str, duration: float, mesh: Mesh, smoothing: Sequence[float]
) -> Result:
    model, target = guidance_model(parameters), parameters.targets[case]
    guidance = Guidance(
        model, problem(model, parameters.initial, target, (duration, duration)), mesh
    )
    guess = turning_guess(model, parameters.initial, target, duration, (0.2, 0.0))
    results = [guidance.solve(guess, smoothing) for _ in range(REPETITIONS)]
    return min(results, key=lambda result: result.seconds)


def _yapss(
    parameters: Parameters, nodes: int, smoothing: Sequence[float]
) -> tuple[float, float, int]:
    """The quarter turn without the gravity gradient, scaled alike.

    Seconds and cost over the stages that converged, and their number.
    """
    from yapss import Problem
    from yapss.math import sqrt

    unit, scale = (
        parameters.duration,
        np.diag(parameters.inertia) / (parameters.torque * parameters.duration**2),
    )
    ocp = Problem(name="slew", nx=[7], nu=[3], nq=[1])
    stage = [smoothing[0]]

    def objective(arg):
        arg.objective = arg.phase[0].integral[0]

    def continuous(arg):
        x1, x2, x3, x4, a, b, c = arg.phase[0].state
        u = arg.phase[0].control
        arg.phase[0].dynamics[:] = (
            0.5 * (c * x2 - b * x3 + a * x4),
            0.5 * (a * x3 - c * x1 + b * x4),
            0.5 * (b * x1 - a * x2 + c * x4),
            -0.5 * (a * x1 + b * x2 + c * x3),
            # From rest, J w equals what the wheels gave: no gyroscopic torque is left.
            u[0] / scale[0],
            u[1] / scale[1],
            u[2] / scale[2],
        )
        s = stage[0]
        arg.phase[0].integrand[0] = sqrt(u[0] ** 2 + u[1] ** 2 + u[2] ** 2 + s**2) - s

    ocp.functions.objective, ocp.functions.continuous = objective, continuous
    bounds, target = ocp.bounds.phase[0], parameters.targets["quarter"]
    bounds.initial_time.lower = bounds.initial_time.upper = 0.0
    bounds.final_time.lower = bounds.final_time.upper = 1.0
    bounds.initial_state.lower[:] = bounds.initial_state.upper[:] = np.r_[
        parameters.initial, 0, 0, 0
    ]
    # The scalar part follows from the other three.
    bounds.final_state.lower[:3] = bounds.final_state.upper[:3] = target[:3]
    bounds.final_state.lower[4:] = bounds.final_state.upper[4:] = 0.0
    bounds.control.lower[:], bounds.control.upper[:] = -1.0, 1.0
    guess = ocp.guess.phase[0]
    model = guidance_model(parameters)
    _, state, control = turning_guess(model, parameters.initial, target, unit, (0.2, 0.0))
    guess.time = np.linspace(0.0, 1.0, 4 * nodes)
    guess.state = np.column_stack([state(t)[:7] for t in guess.time])
    guess.control = np.column_stack([control(t) for t in guess.time])
    ocp.mesh.phase[0].collocation_points = [nodes]
    ocp.mesh.phase[0].fraction = [1.0]
    ocp.spectral_method = "lg"
    ocp.derivatives.method, ocp.derivatives.order = "auto", "second"
    ocp.ipopt_options.print_level = 0
    ocp.ipopt_options.tol = 1e-9
    ocp.ipopt_options.max_iter = 400
    ocp.ipopt_options.mu_strategy = "adaptive"
    _, weights = np.polynomial.legendre.leggauss(nodes)
    seconds, cost, stages = 0.0, np.nan, 0
    for value in smoothing:
        stage[0] = value
        began = time.perf_counter()
        solution = ocp.solve()
        if solution.nlp_info.ipopt_status != 0:
            break
        seconds += time.perf_counter() - began
        stages += 1
        phase = solution.phase[0]
        size = np.linalg.norm(phase.control, axis=0)
        cost = float(size @ weights / 2.0) * parameters.torque * unit
        guess.time, guess.state = phase.time, phase.state
        guess.control = np.array(
            [np.interp(phase.time, phase.time_c, row) for row in phase.control]
        )
    return seconds, cost, stages


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name:34} {value:.4g}")
