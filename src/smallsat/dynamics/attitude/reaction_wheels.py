"""A rigid body turned by reaction wheels along its axes.

The wheels' momentum is -h, where h, N m s, is the momentum that they have given to the body: the
integral of the torque u on the body. ``carried`` is 1 where the wheels' momentum takes part in the
gyroscopic torque, as it does, and 0 for the simpler model of a body under outer torques.
"""

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.vectors import axpy, cross, times


@compiled
def angular_acceleration(inertia, inverse, rate, given, torque, outer, carried):
    """Angular acceleration, rad/s^2, in body components.

    Parameters
    ----------
    inertia, inverse : shape (3, 3)
        Inertia tensor, kg m^2, and its inverse.
    rate : shape (3,)
        Body rate, rad/s.
    given : shape (3,)
        Momentum that the wheels have given, N m s.
    torque, outer : shape (3,)
        Torque of the wheels on the body, and of the environment, N m.
    carried : float
        1 or 0, see above.
    """
    momentum = axpy(-carried, given, times(inertia, rate))
    net = axpy(1.0, cross(momentum, rate), axpy(1.0, outer, torque))
    return times(inverse, net)
