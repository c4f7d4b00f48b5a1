"""Tubes of the docking phase from chapter 5's noise levels, and the one that is flown."""

import numpy as np
import pandas as pd

from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.guidance.law import DOCKING, Law
from smallsat.studies.rendezvous.guidance.tube import (
    Disturbances,
    Margins,
    deviation,
    invariant_margins,
    room,
    stationary_margins,
    tip_distance,
    tube_law,
)
from smallsat.studies.rendezvous.model.actuation_noise import steady_state
from smallsat.studies.rendezvous.simulation.disturbances import thrust_noise

TUBES = {"invariant": invariant_margins, "stationary": stationary_margins}


def disturbances(section: MonteCarlo, law: Law, near_error_share: float) -> Disturbances:
    """Bounds of what disturbs a step of docking: the configured number of standard deviations.

    The thrust's error is that of the largest control, for it is in proportion to the control.
    Measurement errors are ``near_error_share`` of the printed ones.
    """
    table = section.studies.robustness
    amplitude = steady_state(thrust_noise(table.thrust_error), table.thrust_error.reading)[0, 0]
    return Disturbances(
        near_error_share * table.position_deviation_m,
        near_error_share * table.velocity_deviation_m_s,
        float(np.sqrt(amplitude)) * law.control_bounds[DOCKING],
    ).times(table.tube.deviations)


def flown_margins(section: MonteCarlo, law: Law, near_error_share: float) -> Margins:
    """The stationary tube of all disturbances, cut to what room each constraint has for it."""
    whole = stationary_margins(law, disturbances(section, law, near_error_share))
    return whole.within(room(law, section.studies.robustness.tube.share))


def flown_tube(section: MonteCarlo, law: Law, near_error_share: float) -> Law:
    """The law with that tube."""
    bounds = disturbances(section, law, near_error_share)
    return tube_law(law, deviation(law, bounds).gain, flown_margins(section, law, near_error_share))


def path_law(section: MonteCarlo, law: Law) -> Law:
    """The law with a nominal path and the feedback to it, and no constraint tightened."""
    gain = deviation(law, disturbances(section, law, 1.0)).gain
    return tube_law(law, gain, Margins(0.0, 0.0, 0.0))


def sizes(section: MonteCarlo, law: Law) -> pd.DataFrame:
    """How much of the docking phase's constraints a tube takes, by sensor, source and tube.

    Returns
    -------
    pandas.DataFrame
        ``error_share``, ``source``, ``tube``; margins ``cone_m``, ``speed_m_s``, ``control_m_s``;
        how far from the port the tightened cone begins, ``tip_m``; and ``scale``, how many times
        the tube there is room for.
    """
    robustness = section.studies.robustness
    rows = []
    for share in (1.0, *robustness.near_error_shares):
        every = disturbances(section, law, share)
        sources = {
            "measurement": every._replace(thrust=0.0),
            "thrust": Disturbances(0.0, 0.0, every.thrust),
            "both": every,
        }
        for source, bounds in sources.items():
            for tube, margins_of in TUBES.items():
                margins = margins_of(law, bounds)
                rows.append(
                    {
                        "error_share": share,
                        "source": source,
                        "tube": tube,
                        "cone_m": margins.cone,
                        "speed_m_s": margins.speed,
                        "control_m_s": margins.control,
                        "tip_m": tip_distance(law, margins),
                        "scale": margins.scale(room(law, robustness.tube.share)),
                    }
                )
    return pd.DataFrame(rows)
