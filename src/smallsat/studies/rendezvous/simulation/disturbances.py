"""Nonlinear motion from the configuration: as it is, and with the disturbances of chapter 5."""

import numpy as np

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.configuration import Flight, MonteCarlo, ThrustError
from smallsat.studies.rendezvous.guidance.law import Law
from smallsat.studies.rendezvous.model.actuation_noise import (
    Noise,
    interval,
    stationary_factor,
    steady_state,
)
from smallsat.studies.rendezvous.model.environment import environment, target_state
from smallsat.studies.rendezvous.model.navigation_filter import FilterModel
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.simulation.motion import BURNS, IMPULSES, NonlinearMotion


def thrust_noise(error: ThrustError) -> Noise:
    """Noise of the thrust's amplitude (Table 5.1)."""
    return Noise(error.tau_s, error.omega_n_rad_s, error.xi, error.eta_w, error.eta_v)


def nonlinear_motion(section: Flight, law: Law, actuation: int) -> NonlinearMotion:
    """Two bodies in the Earth's field with drag, a known state and faultless thrusters.

    Parameters
    ----------
    section
        For its spacecraft and truth.
    law
        For the target's mean motion.
    actuation
        One of `motion.COMMANDED`, `IMPULSES` and `BURNS`. No least on-time is printed: none here.
    """
    craft = section.spacecraft
    return NonlinearMotion(
        environment=environment(section.truth, law.mean_motion, craft.mass_kg),
        target=target_state(section.truth, law.mean_motion),
        mass=craft.mass_kg,
        force=craft.thruster_N,
        minimum_on_time=0.0,
        flown_from=0.0,
        actuation=actuation,
        error_start=np.zeros((2, 2)),
        error_transitions=np.zeros((3, 2, 2)),
        error_factors=np.zeros((3, 2, 2)),
        measured=False,
        position_deviation=0.0,
        velocity_deviation=0.0,
        full_error_from=0.0,
        least_error_share=1.0,
        filtered=False,
        filter_model=FilterModel(*(0.0 for _ in FilterModel._fields)),
        filter_transitions=np.zeros((3, 6, 6)),
    )


def disturbed_motion(
    section: MonteCarlo,
    law: Law,
    thrust_error: bool = True,
    measurement_error: bool = True,
    filtered: bool = False,
    burns: bool = False,
    near_error_share: float = 1.0,
) -> NonlinearMotion:
    """Nonlinear motion with all disturbances of chapter 5, or some; gravity and drag always.

    Measurement errors fall to ``near_error_share`` of the printed ones from where the law's far
    range ends, see `smallsat.studies.rendezvous.model.measurement_noise`.
    """
    table = section.studies.robustness
    noise, reading = thrust_noise(table.thrust_error), table.thrust_error.reading
    steps = [interval(noise, reading, duration) for duration in law.sample_times]
    scale = 1.0 if thrust_error else 0.0
    matrix = rate_matrix(law.mean_motion) if law.prediction is None else law.prediction
    return nonlinear_motion(section, law, BURNS if burns else IMPULSES)._replace(
        minimum_on_time=table.minimum_on_time_s,
        flown_from=table.minimum_on_time_s,
        error_start=scale * stationary_factor(noise, reading),
        error_transitions=np.stack([one.transition for one in steps]),
        error_factors=scale * np.stack([one.factor for one in steps]),
        measured=True,
        position_deviation=table.position_deviation_m if measurement_error else 0.0,
        velocity_deviation=table.velocity_deviation_m_s if measurement_error else 0.0,
        full_error_from=law.switch_distances[0] if near_error_share < 1.0 else 0.0,
        least_error_share=near_error_share,
        filtered=filtered,
        filter_model=FilterModel(
            position_error=table.position_deviation_m,
            velocity_error=table.velocity_deviation_m_s,
            amplitude_error=float(np.sqrt(steady_state(noise, reading)[0, 0])),
            gradient_error=table.filter.gradient_error,
            other_acceleration=table.filter.other_acceleration_m_s2,
            mean_motion=law.mean_motion,
        ),
        filter_transitions=np.stack([transition(matrix, ts) for ts in law.sample_times]),
    )
