"""What a race costs in propellant, and what power its jet has."""

import numpy as np
import pandas as pd

from smallsat.studies.racing.configuration import SpecificImpulses
from smallsat.studies.racing.methods.races import WHOLE

STANDARD_GRAVITY = 9.80665


def propellant_table(
    races: pd.DataFrame, sweep: pd.DataFrame, impulses: SpecificImpulses
) -> pd.DataFrame:
    """Propellant of the whole-course optima, by the rocket equation at constant acceleration.

    Parameters
    ----------
    races
        Table of the races; those of the document's CubeSats are taken.
    sweep
        Table of the optima over thrust.
    impulses
        Specific impulses, s, by kind of propulsion.

    Returns
    -------
    pandas.DataFrame
        By race or thrust: delta-v, m/s, and by kind of propulsion the percent of the mass at the
        start that are spent, and the power of the jet by mass, W/kg, without losses.
    """
    own = races[races["solution"] == WHOLE]
    flown = pd.concat(
        [
            pd.DataFrame(
                {
                    "race": own["scenario"],
                    "cubesat": own["cubesat"],
                    "thrust_m_s2": own["delta_v_m_s"] / own["time_s"],
                    "time_s": own["time_s"],
                    "delta_v_m_s": own["delta_v_m_s"],
                }
            ),
            pd.DataFrame(
                {
                    "race": sweep["scenario"],
                    "cubesat": "any",
                    "thrust_m_s2": sweep["thrust_m_s2"],
                    "time_s": sweep[f"{WHOLE} (s)"],
                    "delta_v_m_s": sweep[f"{WHOLE}, delta-v (m/s)"],
                }
            ),
        ],
        ignore_index=True,
    )
    for name, impulse in impulses:
        speed = STANDARD_GRAVITY * impulse
        flown[f"{name}_pct"] = -100.0 * np.expm1(-flown["delta_v_m_s"] / speed)
        flown[f"{name}_w_kg"] = 0.5 * flown["thrust_m_s2"] * speed
    return flown
