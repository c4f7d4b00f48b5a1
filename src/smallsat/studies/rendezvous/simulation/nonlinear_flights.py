"""The three cases of Section 3.6 in the nonlinear model, against the linear one.

The guidance is the same; what it moves are two bodies in the Earth's field with drag, by impulses
or by burns of the printed thruster that begin at each step.
"""

import pandas as pd

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.configuration import Flight
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.parameters import CASES, law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import Steps, simulate
from smallsat.studies.rendezvous.simulation.delta_v import summed
from smallsat.studies.rendezvous.simulation.disturbances import nonlinear_motion
from smallsat.studies.rendezvous.simulation.motion import BURNS, COMMANDED, NonlinearMotion

THREE = CASES[:3]  # along V-bar, along R-bar, rotating target
MODELS = {"impulses": COMMANDED, "burns": BURNS}


def simulate_nonlinear(section: Flight) -> pd.DataFrame:
    """Steps and delta-v of each phase beside the linear ones: a row a model, flight and phase."""
    reading, start = section.inferred.readings.delta_v, start_state(section)

    def steps(case: str, motion: NonlinearMotion | None) -> Steps:
        # The motion asks for random numbers, none of which act.
        numbers = None if motion is None else [stream(0, 0)]
        return simulate(
            [law(section, case)], start, motion=motion, generators=numbers, with_steps=True
        ).record(0)

    linear = {case: steps(case, None) for case in THREE}
    rows = []
    for model, actuation in MODELS.items():
        for case in THREE:
            nonlinear = steps(case, nonlinear_motion(section, law(section, case), actuation))
            for phase, name in enumerate(PHASES):
                before, after = (
                    record.impulse[record.phase == phase] for record in (linear[case], nonlinear)
                )
                rows.append(
                    {
                        "model": model,
                        "flight": case,
                        "phase": name,
                        "steps_linear": len(before),
                        "steps": len(after),
                        "delta_v_linear_m_s": summed(before, reading),
                        "delta_v_m_s": summed(after, reading),
                    }
                )
    return pd.DataFrame(rows)
