"""Reference frames of the three pointing modes and their rates.

A frame is the direction cosine matrix [RN], shape (3, 3), that maps inertial to frame components;
its rows are the frame's axes. Rates are angular velocities in inertial components, rad/s. Both are
tuples (see `smallsat.dynamics.vectors`).
"""

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.circular_orbits import hill_frame, orbit_frame, position, velocity
from smallsat.dynamics.vectors import axpy, cross, dot, scaled, unit

# The Sun stands still in the direction of the inertial second axis (mars, Eq. 19).
SUN_FRAME = ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
SUN_FRAME_RATE = (0.0, 0.0, 0.0)


@compiled
def nadir_frame(orbit, time):
    """[RnN]: first axis to the planet's centre, second along the velocity (mars, Eq. 24)."""
    radial, along, normal = hill_frame(position(orbit, time), velocity(orbit, time))
    return scaled(-1.0, radial), along, scaled(-1.0, normal)


@compiled
def nadir_frame_rate(orbit, time):
    """Rate of the nadir frame: the orbit rate about the orbit normal (mars, Eq. 26)."""
    return scaled(orbit.rate, orbit_frame(orbit, time)[2])


@compiled
def gmo_frame(lmo, gmo, time):
    """[RcN]: first axis away from the mothercraft, second normal to the inertial third one.

    mars, Eq. 28.
    """
    sight = axpy(-1.0, position(lmo, time), position(gmo, time))
    first, second = unit(scaled(-1.0, sight)), unit((sight[1], -sight[0], 0.0))
    return first, second, cross(first, second)


@compiled
def gmo_frame_rate(lmo, gmo, time, difference):
    """Rate of the GMO frame by a forward difference over ``difference`` s (mars, Eqs. 32-34)."""
    now, later = gmo_frame(lmo, gmo, time), gmo_frame(lmo, gmo, time + difference)
    # The difference times [RN] transposed is -[~w] in frame components. It is skew only in the
    # limit; like the document, take the three entries above its diagonal.
    change_1 = scaled(1.0 / difference, axpy(-1.0, now[0], later[0]))
    change_2 = scaled(1.0 / difference, axpy(-1.0, now[1], later[1]))
    about_1, about_2, about_3 = dot(change_2, now[2]), -dot(change_1, now[2]), dot(change_1, now[1])
    return axpy(about_3, now[2], axpy(about_2, now[1], scaled(about_1, now[0])))
