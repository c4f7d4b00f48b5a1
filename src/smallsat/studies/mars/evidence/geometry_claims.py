"""Predicates of what the document says of orbits, frames and lines of sight."""

import numpy as np

from smallsat.dynamics.orbits.circular_orbits import position, velocity
from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.evidence.claims import ROUNDING, frame_rate, vector
from smallsat.studies.mars.model import frames
from smallsat.studies.mars.model.light import conditions
from smallsat.studies.mars.model.modes import GMO
from smallsat.studies.mars.parameters import Parameters


def velocity_is_normal_to_position(grounds: Grounds[Configuration]) -> Judgement:
    """Section IV.A: the cosine between position and velocity, over the mission."""
    parameters = Parameters.from_section(grounds.section)
    worst = 0.0
    for orbit in (parameters.lmo, parameters.gmo):
        for time in np.linspace(0.0, grounds.section.durations_s.mission, 200):
            r, v = np.array(position(orbit, time)), np.array(velocity(orbit, time))
            worst = max(worst, abs(float(r @ v)) / float(np.linalg.norm(r) * np.linalg.norm(v)))
    return judged(
        worst < ROUNDING, f"over the mission the cosine is at most {worst:.1e}, on both orbits"
    )


def sun_frame_is_right_handed(grounds: Grounds[Configuration]) -> Judgement:
    """Section V: the printed entries must make a rotation with the axes that the text gives."""
    printed = np.array(
        [
            [grounds.ledger.value(f"equation-19/dcm-rsn/{i}{j}").value for j in (1, 2, 3)]
            for i in (1, 2, 3)
        ]
    )
    defect = float(np.abs(printed @ printed.T - np.eye(3)).max())
    handed = float(np.linalg.det(printed))
    second = np.cross(printed[2], printed[0])
    return judged(
        defect < ROUNDING and handed > 0.0 and np.allclose(second, printed[1], atol=ROUNDING),
        f"printed numbers alone: the rows of Eq. 19 differ from orthonormal ones by {defect:.0e}, "
        f"their determinant is {handed:+.0f}, and r3 x r1 is {vector(second, 0)}",
    )


def analytic_rate(parameters: Parameters, time: float) -> np.ndarray:
    """Inertial rate of the GMO frame in closed form, rad/s, shape (3,).

    With d = r_GMO - r_LMO the first axis is -d/|d| and the second (d_y, -d_x, 0)/|(d_x, d_y)|, so
    that the frame turns about the inertial third axis with the azimuth of d and about its second
    axis with the elevation.
    """
    lmo, gmo = parameters.lmo, parameters.gmo
    d = np.subtract(position(gmo, time), position(lmo, time))
    d_rate = np.subtract(velocity(gmo, time), velocity(lmo, time))
    level = np.hypot(d[0], d[1])
    azimuth_rate = (d[0] * d_rate[1] - d[1] * d_rate[0]) / level**2
    level_rate = (d[0] * d_rate[0] + d[1] * d_rate[1]) / level
    elevation_rate = (level * d_rate[2] - d[2] * level_rate) / (level**2 + d[2] ** 2)
    # The second axis points so that d rises by a turn about it.
    second = np.array([d[1], -d[0], 0.0]) / level
    return np.array([0.0, 0.0, azimuth_rate]) + elevation_rate * second


def analytic_rate_is_difficult(grounds: Grounds[Configuration]) -> Judgement:
    """Section VII.C: a closed form of a few lines against a difference of the frame itself."""
    section = grounds.section
    parameters = Parameters.from_section(section)
    errors = []
    for time in np.linspace(0.0, section.durations_s.mission, 50):
        by_difference = frame_rate(
            lambda t: frames.gmo_frame(parameters.lmo, parameters.gmo, t), float(time)
        )
        errors.append(np.linalg.norm(analytic_rate(parameters, float(time)) - by_difference))
    worst = float(np.max(errors)) / float(parameters.lmo.rate)
    return judged(
        worst > 1e-6,
        f"azimuth and elevation of the line between the spacecraft give the rate in closed form, "
        f"in a few lines; it differs from a difference of the frame by at most {worst:.1e} of the "
        f"orbit's rate. What is difficult is a matter of taste; that it can be had is not",
    )


def transmits_in_line_of_sight(grounds: Grounds[Configuration]) -> Judgement:
    """Section II: transmission over a day against the sight past the planet's edge, at night.

    It holds if the two are one, and is undecided if all transmission is in sight but not all sight
    is used: the sentence can mean either, and Table 1 calls visible what is within an angle.
    """
    parameters = Parameters.from_section(grounds.section)
    day = grounds.table("day.parquet")
    times, mode = day["time_s"].to_numpy(), day["mode"].to_numpy()
    found = conditions(parameters, times)
    sight = (found["night"] & found["sight"]).to_numpy()
    sends = mode == GMO
    blind, unused = float(np.mean(sends & ~sight)), float(np.mean(sight & ~sends))
    evidence = (
        f"over a day the planet leaves the line free for {100 * sight.mean():.1f} % of the time at "
        f"night, and the nano-satellite transmits for {100 * sends.mean():.1f} %; it transmits "
        f"without sight for {100 * blind:.1f} %"
    )
    if blind > 0.0:
        return Judgement("fails", evidence)
    return Judgement("holds" if unused == 0.0 else "undecided", evidence)
