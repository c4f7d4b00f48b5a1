"""The smaller turn in one segment on fewer points than the document's, flown anew."""

import numpy as np
import pandas as pd

from smallsat.dynamics.attitude.quaternions import error_quaternion, turn_angle
from smallsat.optimal_control.gauss_pseudospectral import Mesh
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.flights import replay
from smallsat.studies.slew.methods.guidance_problem import Guidance
from smallsat.studies.slew.methods.plans import guidance_model, node_table, resampled, slew_of
from smallsat.studies.slew.parameters import Parameters

# Of the document's number of points.
HALF, ALL = 0.5, 1.0
SHARES = (0.25, HALF, 0.75, ALL)
OFF_AXIS = (0.2, 0.0)
FEWEST = 3


def node_sweep(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """Status, steps of the solver and cost by the number of points, and the miss when flown.

    From one start off the eigenaxis. The torques at the points, linear between them, are flown in
    open loop in the fuller model; ``miss_deg`` is the angle to the target at the end, and
    ``rate_deg_s`` the rate left.
    """
    model = guidance_model(parameters)
    document = section.manoeuvre.quarter.nodes
    target = tuple(parameters.targets["quarter"])
    rows = []
    for share in SHARES:
        count = max(FEWEST, round(share * document))
        slew = slew_of(model, parameters, "quarter", Mesh(1, count))
        guidance = Guidance(model, slew.stated(), slew.mesh)
        result = guidance.solve(slew.guess(OFF_AXIS), section.numerics.smoothing)
        torques = resampled(node_table(model, result, ""), section.resampling_hz)
        end = replay(parameters, section, torques, parameters.duration).iloc[-1]
        attitude = tuple(end[[f"q_{i}" for i in range(1, 5)]])
        rate = np.linalg.norm(end[[f"omega_{axis}" for axis in "xyz"]].to_numpy(dtype=float))
        rows.append(
            {
                "share": share,
                "nodes": count,
                "converged": result.solution.converged,
                "status": result.solution.status,
                "iterations": result.iterations,
                "cost_N_m_s": result.cost,
                "miss_deg": float(np.degrees(turn_angle(error_quaternion(attitude, target)))),
                "rate_deg_s": float(np.degrees(rate)),
            }
        )
    return pd.DataFrame(rows)
