"""Times below which no plan makes a turn, by either model: bounds that need no optimiser."""

import numpy as np

from smallsat.dynamics.attitude.quaternions import quaternion_to_dcm
from smallsat.studies.slew.parameters import Parameters


def reach(
    inertia: np.ndarray,
    torque: float,
    duration: float,
    final_momentum: tuple[float, float, float] = (0.0, 0.0, 0.0),
    disturbance: float = 0.0,
) -> float:
    """Longest path of the body's x axis on the unit sphere, rad, that the wheels allow in a time.

    Where the wheels' momentum takes part in the gyroscopic torque, from rest with the wheels at
    rest, J w = h + H: what the wheels gave and what the environment did. A wheel gives at most
    torque times time, and must come back, so that |h_i| is at most u min(t, tf - t) plus what
    remains at the end and |H|. The x axis moves with the speed sqrt(w_y^2 + w_z^2), whatever the
    order of the turns.

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


def reach_by_euler(
    inertia: np.ndarray, torque: float, duration: float, disturbance: float = 0.0
) -> float:
    """The same by Euler's equation alone, where J w is not what the wheels gave.

    The gyroscopic torque w x J w is normal to J w, so that |J w| changes by no more than the other
    torques: sqrt(3) u of three wheels, and the environment's. From rest to rest it is at most their
    sum times min(t, tf - t), and the speed of the x axis at most |J w| times the norm of the rows
    of the inverse tensor that give w_y and w_z. Weaker than `reach`, since the momentum may point
    any way.

    Parameters
    ----------
    inertia
        Tensor, shape (3, 3), kg m^2.
    torque, duration
        N m and s.
    disturbance
        Largest angular momentum, N m s, that the environment can give in the time.
    """
    rate = np.sqrt(3.0) * torque + disturbance / duration
    return float(np.linalg.norm(np.linalg.inv(inertia)[1:], 2) * rate * duration**2 / 4.0)


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


def impossible(
    parameters: Parameters,
    case: str,
    duration: float,
    gradient: bool = True,
    *,
    carried: bool = True,
) -> bool:
    """Whether no plan makes a turn from rest to rest in a time, s, by the bound of a model.

    ``gradient`` and ``carried`` say whether the gravity gradient acts, and whether the wheels'
    momentum takes part in the gyroscopic torque.
    """
    disturbance = largest_disturbance(parameters, duration) if gradient else 0.0
    longest = reach if carried else reach_by_euler
    path = longest(parameters.inertia, parameters.torque, duration, disturbance=disturbance)
    return path < needed(parameters, case)


def bound_time(
    parameters: Parameters, gradient: bool, case: str = "half", *, carried: bool = True
) -> float:
    """Time, s, below which no plan makes a turn from rest to rest; 0 where the bound says nothing.

    The arguments are those of `impossible`.
    """

    def refused(duration: float) -> bool:
        return impossible(parameters, case, duration, gradient, carried=carried)

    low, high = 1.0, 1000.0
    if not refused(low):
        return 0.0
    while refused(high):
        low, high = high, 2.0 * high
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        if refused(middle):
            low = middle
        else:
            high = middle
    return low
