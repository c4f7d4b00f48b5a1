"""What is flown in the fuller model: eigenaxis control and the plans in open loop."""

import numpy as np
import pandas as pd

from smallsat.studies.slew.configuration import Configuration, Controller
from smallsat.studies.slew.model.simulation import Command, eigenaxis, open_loop, plant, run
from smallsat.studies.slew.parameters import Parameters

# Long enough for the eigenaxis law to settle: the document speaks of 150 s and 170 s.
SETTLED_S = 240.0


def controller(law: Controller, parameters: Parameters, case: str, hold: int = 0) -> Command:
    """The document's eigenaxis law for a case."""
    return eigenaxis(
        parameters,
        parameters.targets[case],
        law.natural_frequency_rad_s,
        law.damping_ratio,
        hold=hold,
    )


def eigenaxis_flights(section: Configuration, parameters: Parameters) -> pd.DataFrame:
    """Continuous control of both turns, in the printed time and until settled."""
    step = section.numerics.step_s
    tables = []
    for case in ("quarter", "half"):
        for name, duration in (("", parameters.duration), (", no time limit", SETTLED_S)):
            flown = run(
                parameters,
                plant(parameters),
                controller(section.controller, parameters, case),
                duration,
                step,
            )
            tables.append(flown.assign(flight=f"eigenaxis {case}{name}"))
    return pd.concat(tables, ignore_index=True)


def replay(
    parameters: Parameters,
    section: Configuration,
    torques: np.ndarray,
    duration: float,
    *,
    carried: bool = True,
    drag: float = 1.0,
) -> pd.DataFrame:
    """Torques at the resampling rate, flown in open loop.

    ``carried`` and ``drag`` are those of `plant`: wheels' momentum, and a factor of the density.
    """
    command = open_loop(parameters, 1.0 / section.resampling_hz, torques)
    body = plant(parameters, carried=carried, drag=drag)
    return run(parameters, body, command, duration, section.numerics.step_s)
