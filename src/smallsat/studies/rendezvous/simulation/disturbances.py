"""The disturbances of chapter 5 from the configuration."""

import numpy as np

from smallsat.config import Config
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.guidance.law import Law
from smallsat.studies.rendezvous.model.actuation_noise import (
    Noise,
    interval,
    stationary_factor,
    steady_state,
)
from smallsat.studies.rendezvous.model.environment import environment, orbit_radius, target_state
from smallsat.studies.rendezvous.model.navigation_filter import FilterModel
from smallsat.studies.rendezvous.model.prediction import transition
from smallsat.studies.rendezvous.simulation.disturbed_loop import Disturbances


def thrust_noise(section: Config) -> Noise:
    """Table 5.1."""
    table = section["studies"]["robustness"]["thrust_error"]
    return Noise(
        table["tau_s"], table["omega_n_rad_s"], table["xi"], table["eta_w"], table["eta_v"]
    )


def thrust_reading(section: Config) -> str:
    """Which of `actuation_noise.READINGS` is run."""
    return section["studies"]["robustness"]["thrust_error"]["reading"]


def truth_radius(law: Law) -> float:
    """Radius of the target's orbit, m."""
    return orbit_radius(law.mean_motion)


def disturbances(
    section: Config,
    law: Law,
    thrust_error: bool = True,
    measurement_error: bool = True,
    filtered: bool = False,
    burns: bool = False,
) -> Disturbances:
    """All disturbances of chapter 5, or some of them; gravity and drag always."""
    settings, craft = section["studies"]["robustness"], section["spacecraft"]
    noise, reading = thrust_noise(section), thrust_reading(section)
    steps = [interval(noise, reading, duration) for duration in law.sample_times]
    scale = 1.0 if thrust_error else 0.0
    position = settings["position_deviation_m"] if measurement_error else 0.0
    velocity = settings["velocity_deviation_m_s"] if measurement_error else 0.0
    matrix = rate_matrix(law.mean_motion) if law.prediction is None else law.prediction
    model = FilterModel(
        position_error=settings["position_deviation_m"],
        velocity_error=settings["velocity_deviation_m_s"],
        amplitude_error=float(np.sqrt(steady_state(noise, reading)[0, 0])),
        gradient_error=settings["filter"]["gradient_error"],
        other_acceleration=settings["filter"]["other_acceleration_m_s2"],
        mean_motion=law.mean_motion,
    )
    return Disturbances(
        environment=environment(section["truth"], law.mean_motion, craft["mass_kg"]),
        target=target_state(section["truth"], law.mean_motion),
        mass=craft["mass_kg"],
        force=craft["thruster_N"],
        minimum_on_time=settings["minimum_on_time_s"],
        burns=burns,
        error_start=scale * stationary_factor(noise, reading),
        error_transitions=np.stack([one.transition for one in steps]),
        error_factors=scale * np.stack([one.factor for one in steps]),
        position_deviation=position,
        velocity_deviation=velocity,
        filtered=filtered,
        filter_model=model,
        filter_transitions=np.stack([transition(matrix, ts) for ts in law.sample_times]),
    )
