"""Thrusters that are on or off: from a commanded velocity change to pulses (Eqs. 2.4 to 2.6)."""

from smallsat.dynamics.compiled import compiled


@compiled
def pulse_on_times(delta_v, mass, force, minimum_on_time, flown_from, on_times):
    """Fill the on-times (3,), s, of the thruster of each axis for a velocity change (3,), m/s.

    A pulse of constant force gives the momentum ``mass * delta_v`` (Eqs. 2.4 and 2.5; the latter
    leaves out the duration that the force is taken over). No pulse is shorter than that
    of the minimum impulse bit (Eq. 2.6): one that would be is left out, or lengthened to it.

    Parameters
    ----------
    delta_v : shape (3,)
        Commanded, m/s, along the axes of the thrusters.
    mass, force, minimum_on_time, flown_from : float
        Mass of the chaser, kg; force of a thruster, N; least time of a pulse, s, and from which
        time on a shorter one is lengthened to it, s: half of it rounds, all of it leaves out.
    on_times : shape (3,)
        Filled.
    """
    for axis in range(3):
        wanted = mass * abs(delta_v[axis]) / force
        on_times[axis] = max(wanted, minimum_on_time) if wanted >= flown_from else 0.0


@compiled
def thrust_acceleration(delta_v, mass, force, acceleration):
    """Fill the acceleration (3,), m/s^2, of burning thrusters, with the signs of ``delta_v``."""
    for axis in range(3):
        acceleration[axis] = force / mass if delta_v[axis] >= 0.0 else -force / mass
