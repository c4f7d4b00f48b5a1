"""The gravity gradient from the quaternion, and by Euler angles, which Section V.D gave up."""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import pandas as pd

from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import half_mesh
from smallsat.studies.slew.methods.guidance_problem import Guidance, Model, tilts
from smallsat.studies.slew.methods.plan_names import ONE_SEGMENT
from smallsat.studies.slew.methods.plans import SWEEP_STARTS, guidance_model, slew_of
from smallsat.studies.slew.methods.turns import meshes
from smallsat.studies.slew.parameters import Parameters


@dataclass(frozen=True)
class AngleModel(Model):
    """The same spacecraft, with the position turned into the body by roll, pitch and yaw."""

    def in_body(self, q: Any, r: Any) -> Any:
        """Body components of an inertial vector by the trigonometric functions of the angles."""
        x, y, z, w = q[0], q[1], q[2], q[3]
        roll = ca.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
        pitch = ca.asin(2.0 * (w * y - z * x))
        yaw = ca.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        c, s = ca.cos, ca.sin
        rows = (
            (c(pitch) * c(yaw), c(pitch) * s(yaw), -s(pitch)),
            (
                s(roll) * s(pitch) * c(yaw) - c(roll) * s(yaw),
                s(roll) * s(pitch) * s(yaw) + c(roll) * c(yaw),
                s(roll) * c(pitch),
            ),
            (
                c(roll) * s(pitch) * c(yaw) + s(roll) * s(yaw),
                c(roll) * s(pitch) * s(yaw) - s(roll) * c(yaw),
                c(roll) * c(pitch),
            ),
        )
        return ca.vertcat(*(ca.horzcat(*row) for row in rows)) @ r


FORMS = {"quaternion": Model, "Euler angles": AngleModel}


def compared_forms(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """Whether solves from the same starts converge, and in how many steps, by form and turn.

    The smaller turn on the document's points in its time, the larger one on ours in the longest
    time that is planned for it; the cost is smoothed as in the first of all stages.
    """
    turns = (
        ("quarter", meshes(section, "quarter")[ONE_SEGMENT], parameters.duration),
        ("half", half_mesh(section), max(section.beyond.trade_off_s)),
    )
    known = vars(guidance_model(parameters))
    rows = []
    for form, kind in FORMS.items():
        for case, mesh, duration in turns:
            slew = slew_of(kind(**known), parameters, case, mesh, duration)
            guidance = Guidance(slew.model, slew.stated(), mesh)
            for start, tilt in enumerate(tilts(SWEEP_STARTS, section.numerics.seed)):
                result = guidance.solve(slew.guess(tilt), section.numerics.smoothing[:1])
                rows.append(
                    {
                        "form": form,
                        "turn": parameters.names[case],
                        "duration_s": duration,
                        "start": start,
                        "converged": result.solution.converged,
                        "status": result.solution.status,
                        "iterations": result.iterations,
                        "cost_N_m_s": result.cost,
                    }
                )
    return pd.DataFrame(rows)
