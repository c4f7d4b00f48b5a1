"""The three cases of Section 3.6 flown in the nonlinear model, against the linear one.

The guidance is the same; what it moves are two bodies in the Earth's field with drag, by impulses
or by burns of the printed thruster that begin at each step.
"""

import numpy as np
import pandas as pd

from smallsat.config import Config
from smallsat.dynamics.compiled import compiled
from smallsat.optimal_control.riccati_interior_point import workspace
from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES
from smallsat.studies.rendezvous.guidance.law import PHASES, settings
from smallsat.studies.rendezvous.guidance.phase_programs import BOUNDS, PLANES, program_room
from smallsat.studies.rendezvous.model.environment import environment, target_state
from smallsat.studies.rendezvous.model.thrusters import pulse_on_times, thrust_acceleration
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import manoeuvres, next_control, phase_ended
from smallsat.studies.rendezvous.simulation.delta_v import summed

MODELS = ("impulses", "burns")
# No least on-time is printed.
LEAST_ON_TIME_S = 0.0


def fly_nonlinear(section: Config) -> pd.DataFrame:
    """Steps and delta-v of each phase beside the linear ones: a row a model, flight and phase."""
    craft, reading = section["spacecraft"], section["inferred"]["readings"]["delta_v"]
    laws = [law(section, case) for case in CASE_TABLES]
    start = start_state(section)
    linear = manoeuvres(laws, np.tile(start, (len(laws), 1)), with_steps=True)
    room = program_room(max(max(given.horizons) for given in laws))
    work = workspace(max(max(given.horizons) for given in laws), PLANES, BOUNDS)
    rows = []
    for model in MODELS:
        for number, case in enumerate(CASE_TABLES):
            given = laws[number]
            around = environment(section["truth"], given.mean_motion, craft["mass_kg"])
            pair = pair_from_relative(target_state(section["truth"], given.mean_motion), start)
            most = int(given.time_limit / min(given.sample_times)) + 1
            steps = np.zeros((most, 4))
            used = _fly(
                settings([given])[0], pair, around, craft["mass_kg"], craft["thruster_N"],
                model == "burns", room, work, steps,
            )  # fmt: skip
            steps = steps[:used]
            for phase, name in enumerate(PHASES):
                record = linear.records[number]
                before = record.impulse[record.phase == phase]
                after = steps[steps[:, 0] == phase, 1:]
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


@compiled
def _fly(law, pair, around, mass, force, burns, room, work, steps):
    """One manoeuvre; fills `steps` (phase and velocity change), returns how many there were."""
    plan, place = np.empty(work.controls.shape), np.zeros(2, np.int64)
    command, on_times, acceleration = np.zeros(3), np.zeros(3), np.zeros(3)
    axis, faces = np.empty(3), np.empty((4, 3))
    time, step = 0.0, 0
    for phase in range(3):
        place[:] = 0
        while True:
            duration = law.sample_times[phase]
            if time + duration > law.time_limit:
                return step
            state = relative_state(pair)
            next_control(law, phase, state, time, room, work, plan, place, command)
            on_times[:] = 0.0
            acceleration[:] = 0.0
            if burns:
                pulse_on_times(command, mass, force, LEAST_ON_TIME_S, on_times)
                thrust_acceleration(command, mass, force, acceleration)
            else:
                for k in range(3):
                    state[3 + k] += command[k]
                pair = pair_from_relative(pair[0], state)
            advance(pair, time, duration, acceleration, on_times, around)
            steps[step, 0] = phase
            steps[step, 1:] = command
            time += duration
            step += 1
            if phase_ended(law, phase, relative_state(pair), time, axis, faces):
                break
    return step
