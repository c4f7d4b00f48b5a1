"""Measurement errors that fall with the range, as section 5.5 expects of sensors near the target.

The thesis flies one pair of deviations at all distances (Eqs. 5.6 and 5.7) and says that those of
the approach and docking phases would be others. How much smaller is not said. The law here is ours:
the printed deviations where the rendezvous phase flies, in proportion to the distance from where
that phase ends, and never below a share of the printed ones.
"""

from math import sqrt

from smallsat.dynamics.compiled import compiled


@compiled
def error_share(state, full_from, least):
    """Deviation of a measurement at a relative state (6,), m, as a share of that far away.

    Parameters
    ----------
    full_from, least : float
        Distance from which on errors are full, m, zero for full ones everywhere; smallest share.
    """
    distance = sqrt(state[0] ** 2 + state[1] ** 2 + state[2] ** 2)
    if distance >= full_from:
        return 1.0
    return max(distance / full_from, least)
