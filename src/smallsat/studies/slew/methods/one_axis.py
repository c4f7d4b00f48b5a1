"""A turn about one body axis alone, by hand."""

from math import nan

import numpy as np

from smallsat.studies.slew.parameters import Parameters

# An axis is one of the body, and principal, to this.
ROUNDING = 1e-12


def body_axis(parameters: Parameters, case: str) -> tuple[str, float]:
    """The body axis that a turn is about and its moment, kg m^2.

    A LookupError where it is none, or no principal axis: a turn about it alone is then no motion by
    its own wheel.
    """
    place = int(np.argmax(np.abs(parameters.axis(case))))
    others = np.delete(np.r_[parameters.axis(case), parameters.inertia[place]], [place, 3 + place])
    if np.abs(others).max() > ROUNDING:
        raise LookupError("the turn is not about a principal axis along a wheel")
    return "xyz"[place], float(parameters.inertia[place, place])


def eigenaxis_time(angle: float, moment: float, torque: float, momentum: float) -> float:
    """Time, s, of a turn about one axis alone: full torque forth and back, coasting if full.

    Parameters
    ----------
    angle
        rad.
    moment
        Moment of inertia about the axis, kg m^2.
    torque, momentum
        Limits of the wheel, N m and N m s.
    """
    if np.sqrt(angle * moment * torque) <= momentum:
        return float(2.0 * np.sqrt(angle * moment / torque))
    return float(angle * moment / momentum + momentum / torque)


def bang_coast_bang(
    angle: float, moment: float, torque: float, duration: float
) -> tuple[float, float]:
    """Cost and peak momentum, N m s, of the cheapest turn about one axis, by hand."""
    burn = 0.5 * (duration - np.sqrt(duration**2 - 4.0 * angle * moment / torque))
    return 2.0 * torque * burn, torque * burn


def eigenaxis_cost(parameters: Parameters, case: str, duration: float) -> float:
    """Least torque, N m s, of a turn about its axis alone in a time, s, without environment.

    Not a number where the time is too short, or where the axis is none of the body's own.
    """
    try:
        _, moment = body_axis(parameters, case)
    except LookupError:
        return nan
    angle = np.radians(parameters.angle_deg(case))
    if duration < eigenaxis_time(angle, moment, parameters.torque, parameters.momentum):
        return nan
    return bang_coast_bang(angle, moment, parameters.torque, duration)[0]
