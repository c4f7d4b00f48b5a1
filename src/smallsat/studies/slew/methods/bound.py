"""A time below which no plan makes a turn: a bound that needs no optimiser.

It holds where the wheels' momentum takes part in the gyroscopic torque: by Euler's equation alone
J w is not what the wheels and the environment gave.
"""

import numpy as np

from smallsat.dynamics.attitude.quaternions import quaternion_to_dcm
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.parameters import Parameters


def reach(
    inertia: np.ndarray,
    torque: float,
    duration: float,
    final_momentum: tuple[float, float, float] = (0.0, 0.0, 0.0),
    disturbance: float = 0.0,
) -> float:
    """Longest path of the body's x axis on the unit sphere, rad, that the wheels allow in a time.

    From rest, with the wheels at rest, J w = h + H: what the wheels gave and what the environment
    did. A wheel gives at most torque times time, and must come back, so that |h_i| is at most
    u min(t, tf - t) plus what remains at the end and |H|. The x axis moves with the speed
    sqrt(w_y^2 + w_z^2), whatever the order of the turns.

    Parameters
    ----------
    inertia
        Tensor, shape (3, 3), kg m^2.
    torque, duration
        N m and s.
    final_momentum
        Momentum about each axis that is left at the end, N m s.
    disturbance
        Largest angular momentum, N m s, that the environment can give in the time.
    """
    time = np.linspace(0.0, duration, 20001)
    momentum = np.array(
        [
            np.minimum(torque * time, torque * (duration - time) + left) + 2.0 * disturbance
            for left in final_momentum
        ]
    )
    rates = np.abs(np.linalg.inv(inertia)) @ momentum
    speed = np.hypot(rates[1], rates[2])
    # The trapezoidal rule bends kinks inwards; one step of the largest slope covers that.
    return float(np.sum(np.maximum(speed[1:], speed[:-1]) * np.diff(time)))


def largest_disturbance(parameters: Parameters, duration: float) -> float:
    """Angular momentum, N m s, that the gravity gradient can give at most in a time, any attitude.

    The torque is 3 mu / r^3 times e x J e, which is at most half the difference of the extreme
    moments for any unit vector e, taken at perigee.
    """
    moments = np.linalg.eigvalsh(parameters.inertia)
    perigee = parameters.orbit.semi_major_axis * (1.0 - parameters.orbit.eccentricity)
    return float(1.5 * parameters.gravity.mu / perigee**3 * (moments[2] - moments[0]) * duration)


def needed(parameters: Parameters, case: str) -> float:
    """Angle, rad, between the body's x axis at the start and at the end of a turn."""
    before, after = (
        np.array(quaternion_to_dcm(tuple(q)))[0]
        for q in (parameters.initial, parameters.targets[case])
    )
    return float(np.arctan2(np.linalg.norm(np.cross(before, after)), before @ after))


def impossible(parameters: Parameters, case: str, duration: float, gradient: bool = True) -> bool:
    """Whether no plan makes a turn from rest to rest in a time, s, with or without the gradient."""
    disturbance = largest_disturbance(parameters, duration) if gradient else 0.0
    path = reach(parameters.inertia, parameters.torque, duration, disturbance=disturbance)
    return path < needed(parameters, case)


def bound_time(parameters: Parameters, gradient: bool, case: str = "half") -> float:
    """Time, s, below which no plan makes a turn from rest to rest; 0 where the bound says nothing.

    Parameters
    ----------
    parameters
        The study's parameters.
    gradient
        Whether the gravity gradient acts.
    case
        The turn.
    """
    low, high = 1.0, 1000.0
    if not impossible(parameters, case, low, gradient):
        return 0.0
    while impossible(parameters, case, high, gradient):
        low, high = high, 2.0 * high
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        if impossible(parameters, case, middle, gradient):
            low = middle
        else:
            high = middle
    return low


def plan_names(parameters: Parameters, case: str, kind: str) -> tuple[str, str]:
    """What the plan of a turn is called on a mesh: of least torque, and the least infeasible."""
    name = parameters.names[case]
    return f"{name}, {kind}", f"{name}, least infeasible, {kind}"


def plan_titles(section: Configuration, case: str) -> dict[str, str]:
    """Titles of the figures of a turn's plan on the document's mesh, by the plan's name."""
    parameters = Parameters.from_section(section)
    why = (
        "the target cannot be reached"
        if impossible(parameters, case, parameters.duration)
        else "no plan was found that reaches the target"
    )
    feasible, least = plan_names(parameters, case, "one segment")
    return {
        feasible: "",
        least: "least infeasible plan, with the wheels' momentum in the gyroscopic torque:\n"
        f"{why} from rest to rest in {parameters.duration:g} s",
    }
