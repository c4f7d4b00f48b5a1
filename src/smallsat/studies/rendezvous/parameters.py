"""The configuration as guidance laws, and the checks that no type can make."""

import numpy as np

from smallsat.dynamics.environment import egm96
from smallsat.dynamics.units import MINUTE
from smallsat.errors import InputError
from smallsat.studies.rendezvous.configuration import Configuration, Flight
from smallsat.studies.rendezvous.guidance.law import (
    ALONG_AXIS,
    AT_HORIZON,
    AT_STAGE,
    AT_START,
    DISTANCE,
    PHASES,
    Law,
)
from smallsat.studies.rendezvous.model.geometry import GREAT_CIRCLE, UPRIGHT

# The five manoeuvres of Section 3.6.
CASES = ("v-bar", "r-bar", "rotating", "no-set-point", "lp")
V_BAR = (0.0, 1.0, 0.0)
R_BAR = {"above": (1.0, 0.0, 0.0), "below": (-1.0, 0.0, 0.0)}
PLANES = {"great circle": GREAT_CIRCLE, "upright": UPRIGHT}
SWITCHES = {"distance": DISTANCE, "along axis": ALONG_AXIS}
SET_POINT_TIMES = {"start": AT_START, "horizon": AT_HORIZON, "stage": AT_STAGE}
# Names that the studies of chapter 4 have for the phases.
STUDY_PHASES = ("rendezvous", "approach", "docking")
CONE_SHARES = {"half": 1.0, "full": 0.5}


def start_state(section: Flight) -> np.ndarray:
    """Relative state at the start of every case, (6,), m and m/s (Table 3.2)."""
    start = section.start
    return np.array([*start.position_m, *start.velocity_m_s], dtype=float)


def law(section: Flight, case: str = "v-bar") -> Law:
    """The guidance law of one of `CASES`, with the inferred values for what is not printed."""
    inferred = section.inferred
    readings = inferred.readings
    phases = [section.phases[name] for name in PHASES]
    approach, docking = CONE_SHARES[readings.approach_cone], CONE_SHARES[readings.docking_cone]
    switch = SWITCHES[readings.switches]
    craft = section.spacecraft
    r1, r2 = inferred.keep_out_m, inferred.overshoot_m
    common = Law(
        mean_motion=inferred.mean_motion_rad_s,
        sample_times=tuple(phase.sample_time_s for phase in phases),
        horizons=tuple(phase.horizon for phase in phases),
        state_weights=np.array([phase.state_weights for phase in phases], dtype=float),
        control_weights=np.array([[phase.control_weight] * 3 for phase in phases], dtype=float),
        # The cone of the docking program is no penalty but a constraint (Section 3.3.1).
        penalties=(phases[0].penalty, phases[1].penalty, 0.0),
        cone_angles=tuple(
            share * np.radians(phase.cone_angle_deg)
            for share, phase in zip((approach, approach, docking), phases, strict=True)
        ),
        control_bounds=tuple(phase.control_bound_m_s for phase in phases),
        keep_out=r1,
        overshoot=r2,
        set_points=(inferred.set_point_1 * r1, inferred.set_point_2 * r2),
        switches=(switch, switch, DISTANCE),
        switch_distances=(
            inferred.switch_1 * r1,
            inferred.switch_2 * r2,
            inferred.end_distance_m,
        ),
        speed_bound=inferred.speed_bound_m_s,
        axis=V_BAR,
        port=float(np.linalg.norm(section.port_m)),
        plane_rate=section.plane_rate,
        plane_turn=PLANES[readings.planes],
        terminal_weights=(inferred.terminal_weight,) * 3,
        set_point_time=SET_POINT_TIMES[readings.set_point_time],
        reference_moves=readings.reference_moves,
        burn_time=craft.mass_kg / craft.thruster_N if readings.actuation == "burns" else 0.0,
    )
    if case == "r-bar":
        return common.with_(axis=R_BAR[readings.r_bar])
    if case == "rotating":
        return common.with_(rotation_rate=inferred.rotation_rate_rad_s)
    if case == "no-set-point":
        return common.with_(set_points=(0.0, common.set_points[1]))
    if case == "lp":
        lp, weights = inferred.lp, common.state_weights[0]
        return common.with_(
            set_points=(lp.set_point * common.set_points[0], common.set_points[1]),
            norm_weights=lp.state_weight * weights,
            norm_terminal_weights=lp.terminal_weight * weights,
            norm_control_weights=np.full(3, lp.control_weight),
        )
    return common


def check(section: Configuration) -> None:
    """Refuse what no type can: zones that contradict each other or the start.

    Raises
    ------
    InputError
        Naming the key, its value and what is allowed.
    """
    inferred = section.inferred
    r1, r2 = inferred.keep_out_m, inferred.overshoot_m
    distance = float(np.linalg.norm(section.start.position_m))
    port = float(np.linalg.norm(section.port_m))
    if distance <= r1:
        raise InputError(
            f"config key 'rendezvous.start.position_m': {list(section.start.position_m)} lies "
            f"{distance:g} m from the target, inside the keep-out zone; must be farther than "
            f"{r1:g} m, or lower 'rendezvous.inferred.keep_out_m'"
        )
    if r2 >= r1:
        raise InputError(
            f"config key 'rendezvous.inferred.overshoot_m': {r2:g} is not allowed; must be less "
            f"than 'rendezvous.inferred.keep_out_m', {r1:g}"
        )
    if port >= r2:
        raise InputError(
            f"config key 'rendezvous.port_m': {list(section.port_m)} lies {port:g} m from the "
            f"target; must be less than 'rendezvous.inferred.overshoot_m', {r2:g}"
        )
    _check_orbit(inferred.mean_motion_rad_s)
    _check_times(section)
    truth = section.truth
    if truth.gravity_order > truth.gravity_degree:
        raise InputError(
            f"config key 'rendezvous.truth.gravity_order': {truth.gravity_order} is not "
            f"allowed; must be at most 'gravity_degree', {truth.gravity_degree}"
        )


def _check_orbit(mean_motion: float) -> None:
    """Refuse an orbit below the ground: the truth flies it."""
    highest = float(np.sqrt(egm96.MU / egm96.RADIUS**3))
    if mean_motion >= highest:
        raise InputError(
            f"config key 'rendezvous.inferred.mean_motion_rad_s': {mean_motion:g} is not allowed; "
            f"must be less than {highest:.6f}, that of an orbit at the Earth's surface"
        )


def _check_times(section: Configuration) -> None:
    """Refuse steps that are longer than the manoeuvre, or too short for thrusters and delays."""
    craft, studies = section.spacecraft, section.studies
    sampled = {
        f"studies.{name}.sample_times_s": studies[name].sample_times_s for name in STUDY_PHASES
    }
    for name, phase in section.phases:
        burn = phase.control_bound_m_s * craft.mass_kg / craft.thruster_N
        if burn > phase.sample_time_s:
            raise InputError(
                f"config key 'rendezvous.phases.{name}.control_bound_m_s': "
                f"{phase.control_bound_m_s:g} is not allowed; {craft.thruster_N:g} N on "
                f"{craft.mass_kg:g} kg burn {burn:.3g} s for it, longer than "
                f"'sample_time_s', {phase.sample_time_s:g}"
            )
        sampled[f"phases.{name}.sample_time_s"] = (phase.sample_time_s,)
    for key, times in sampled.items():
        if max(times) > MINUTE * studies.time_limit_min:
            raise InputError(
                f"config key 'rendezvous.{key}': {max(times):g} is not allowed; must be at most "
                f"'rendezvous.studies.time_limit_min', {studies.time_limit_min:g}, in seconds"
            )
    shortest = min(phase.sample_time_s for _, phase in section.phases)
    longest = max(studies.delay.delays_s)
    if longest > shortest:
        raise InputError(
            f"config key 'rendezvous.studies.delay.delays_s': {longest:g} is not allowed; must be "
            f"at most the shortest 'sample_time_s' of 'rendezvous.phases', {shortest:g}"
        )
