"""Predicates of the document's prose claims."""

from dataclasses import replace

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.optimal_control.gauss_pseudospectral import legendre_gauss
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.observations import (
    MESHES,
    chosen_plan,
    short_of,
    target_yaw,
)
from smallsat.studies.slew.methods.bound import (
    impossible,
    largest_disturbance,
    needed,
    reach,
)
from smallsat.studies.slew.methods.environment_study import AIR, printed_lever_mm
from smallsat.studies.slew.methods.flights import replay
from smallsat.studies.slew.methods.one_axis import bang_coast_bang, body_axis, eigenaxis_time
from smallsat.studies.slew.methods.plan_names import EULER, WHEELS, plan_names
from smallsat.studies.slew.methods.plans import resampled
from smallsat.studies.slew.model.simulation import angles_deg
from smallsat.studies.slew.parameters import Parameters

# Where the document prints its torque-optimal and its eigenaxis turns.
OPTIMAL, EIGENAXIS = "section-vi-b", "section-vi-a"

INDEPENDENT_MISS = 1e-6
VISIBLE_DEG = 1.0
SMALL_DEG = 0.005
# A wheel is at work from this share of its torque on.
AT_WORK = 0.01
ROUNDING = 1e-12
# Costs are equal to this: what the smoothing and the pieces of a plan leave.
SAME_COST = 1e-3


def _least(grounds: Grounds, case: str) -> float:
    """Least time, s, of a case; a LookupError where none was found."""
    return float(grounds.rows("minimum-times.csv", case=case, converged=True)["duration_s"].iloc[0])


def require_turn_about_z(parameters: Parameters, case: str) -> None:
    """Raise a LookupError unless a turn goes from no angles to a yaw: the claim is about that."""
    along = np.r_[parameters.initial[:2], parameters.targets[case][:2]]
    if np.abs(along).max() > ROUNDING or abs(parameters.initial[2]) > ROUNDING:
        raise LookupError("the turn is not about the body's z axis")


def not_in_the_given_time(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg in 100 s are confronted with a bound without an optimiser and the least time."""
    parameters = Parameters.from_section(grounds.section)
    duration, angle = parameters.duration, np.degrees(needed(parameters, "half"))
    name = parameters.names["half"]
    least = _least(grounds, f"{name}, wheels and gravity gradient")
    answers = grounds.table("infeasible.csv")
    if answers["hard_converged"].any() or least <= duration:
        return Judgement(
            "fails",
            f"the least time found is {least:.3f} s, and the solver answers {duration:g} s with "
            f"{', '.join(answers['hard_status'])}",
        )
    if not impossible(parameters, "half", duration):
        return Judgement(
            "undecided",
            f"the bound leaves {duration:g} s possible, and no plan was found in less than "
            f"{least:.3f} s",
        )
    outer = largest_disturbance(parameters, duration)
    path = np.degrees(reach(parameters.inertia, parameters.torque, duration, disturbance=outer))
    return Judgement(
        "holds",
        f"from rest to rest the wheels can move the body's x axis along at most {path:.1f} deg of "
        f"the sphere in {duration:g} s, whatever the path, and it has to move by {angle:g} deg: no "
        f"plan can exist below {bound_of(grounds, WHEELS):.2f} s where the wheels' "
        f"momentum takes part in the gyroscopic torque. The least time found in this model is "
        f"{least:.3f} s, and the solver refuses {duration:g} s on every mesh. "
        f"{_without_wheels(grounds, name)}",
    )


def bound_of(grounds: Grounds, model: str) -> float:
    """Time, s, below which no plan of the larger turn exists by a model with gravity gradient."""
    rows = grounds.rows("bound.csv", model=model, gravity_gradient=True)
    return float(rows["bound_s"].iloc[0])


def _without_wheels(grounds: Grounds, name: str) -> str:
    """What is known of a turn by Euler's equation alone, of which the bound says less."""
    rows = grounds.table("minimum-times.csv")
    rows = rows[(rows["case"] == f"{name}, no wheel momentum") & rows["converged"]]
    known = (
        f"By Euler's equation alone a weaker bound, of the size of J w, excludes plans below "
        f"{bound_of(grounds, EULER):.2f} s"
    )
    if rows.empty:
        return f"{known}, and no least time was found"
    return f"{known}, and the least time found there is {float(rows['duration_s'].iloc[0]):.3f} s"


def valid_trajectory_at_limits(grounds: Grounds[Configuration]) -> Judgement:
    """There must be a valid trajectory for the 180 deg turn in 100 s."""
    judgement = not_in_the_given_time(grounds)
    if judgement.outcome == "undecided":
        return judgement
    if judgement.outcome == "fails":
        return Judgement("holds", f"a valid one exists: {judgement.evidence}")
    last = grounds.table("infeasible.csv").groupby("model", sort=False)["miss"].last()
    misses = ", ".join(
        f"by {np.degrees(np.sqrt(miss)):.1f} deg ({model})" for model, miss in last.items()
    )
    duration = grounds.section.manoeuvre.duration_s
    return Judgement(
        "fails",
        f"no valid one exists: {judgement.evidence}. The least infeasible plan misses its end "
        f"{misses} in attitude and rate together (rate times {duration:g} s, root of squares). The "
        f"printed run too ends beside its target, moving",
    )


def printed_run_misses(grounds: Grounds[Configuration]) -> Judgement:
    """The printed final momentum is J w of the printed final rates."""
    parameters = Parameters.from_section(grounds.section)
    rates, final = (
        grounds.ledger.values(f"{OPTIMAL}/final-{quantity}/180-deg-torque-optimal")
        for quantity in ("angular-rate", "angular-momentum-usage")
    )
    shares = 100.0 * np.radians(1.0) * np.diag(parameters.inertia) / parameters.momentum
    texts, fits = [], []
    for rate, printed, share in zip(rates, final, shares, strict=True):
        room = share * rate.half_unit + printed.half_unit
        fits.append(abs(share * rate.value - printed.value) <= room)
        texts.append(f"{share * rate.value:.2f} ({printed.value}) %")
    x, y, z = (one.value / 100.0 * parameters.momentum for one in final)
    path = np.degrees(reach(parameters.inertia, parameters.torque, parameters.duration, (x, y, z)))
    return judged(
        all(fits),
        f"J w of the printed rates is {', '.join(texts)}, printed values in brackets: equal within "
        f"the digits. With so much rate left the bound, of the model whose wheels carry momentum, "
        f"allows {path:.0f} deg, so the printed run is possible as a run that ends short of its "
        f"target, not as one that meets it",
    )


def yaw_error_significantly_lower(grounds: Grounds) -> Judgement:
    """180 deg: the yaw error alone and the whole attitude error follow from the printed angles."""
    roll, pitch, yaw = (
        grounds.ledger.value(f"{OPTIMAL}/final-{name}-angle/180-deg-torque-optimal").value
        for name in ("roll", "pitch", "yaw")
    )
    yaw = 180.0 - abs(yaw)
    whole = np.sqrt(yaw**2 + roll**2 + pitch**2)
    reached = grounds.ledger.value(f"{EIGENAXIS}/final-yaw-angle/180-deg-eigenaxis").value
    eigenaxis = 180.0 - reached
    return judged(
        yaw < eigenaxis / 2.0 and whole < eigenaxis,
        f"printed compared with printed: {yaw:.1f} deg in yaw and about {whole:.1f} deg in all, "
        f"against {eigenaxis:.1f} deg of the eigenaxis law; neither reaches its target",
    )


def omega_z_nearly_half(grounds: Grounds) -> Judgement:
    """180 deg: the residual rates are compared as printed."""
    optimal, eigenaxis = (
        grounds.ledger.value(name).value
        for name in (
            f"{OPTIMAL}/final-angular-rate/180-deg-torque-optimal/z",
            f"{EIGENAXIS}/residual-omega-z/180-deg-eigenaxis/z",
        )
    )
    ratio = optimal / eigenaxis
    return judged(abs(ratio - 0.5) < 0.05, f"printed compared with printed: a ratio of {ratio:.2f}")


def eigenaxis_is_not_fastest(grounds: Grounds[Configuration]) -> Judgement:
    """The least times are compared with full torque about the eigenaxis alone."""
    parameters = Parameters.from_section(grounds.section)
    texts, faster = [], []
    for case, name in parameters.names.items():
        _, moment = body_axis(parameters, case)
        least = _least(grounds, f"{name}, wheels")
        angle = np.radians(parameters.angle_deg(case))
        alone = eigenaxis_time(angle, moment, parameters.torque, parameters.momentum)
        faster.append(least < alone - 1.0)
        texts.append(f"{name}: {least:.2f} s against {alone:.2f} s")
    return judged(all(faster), "; ".join(texts))


def nutation_saves_torque(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: it is asked whether motion about x and y lowers the torque used."""
    parameters = Parameters.from_section(grounds.section)
    plans = grounds.table("plans.csv").set_index("plan")
    row = plans.loc[f"{parameters.names['quarter']}, no gravity gradient, segments"]
    axis, moment = body_axis(parameters, "quarter")
    angle = np.radians(parameters.angle_deg("quarter"))
    alone = eigenaxis_time(angle, moment, parameters.torque, parameters.momentum)
    if not row["held_converged"] == True or alone > parameters.duration:  # noqa: E712
        raise LookupError("there is no such plan, or none about the axis alone")
    cost, peak = bang_coast_bang(angle, moment, parameters.torque, parameters.duration)
    share = 100.0 * peak / parameters.momentum
    found = f"{1e4 * row['held_cost_N_m_s']:.3f}e-4 N m s against {1e4 * cost:.3f}e-4 by hand"
    saving = 1.0 - row["held_cost_N_m_s"] / cost
    if saving >= SAME_COST:
        return Judgement("holds", f"a plan off the eigenaxis costs {found} about {axis} alone")
    if saving <= -SAME_COST:
        return Judgement("undecided", f"the plan found costs {found}: more than it need")
    name = f"{OPTIMAL}/maximum-angular-momentum-usage/90-deg-torque-optimal/z"
    printed = grounds.ledger.value(name).value
    below = "below" if share < printed else "not below"
    return Judgement(
        "fails",
        f"the best of {row['starts']} starts, one on the eigenaxis and the others off it, is full "
        f"torque, coast, full torque about {axis} alone: {found}, peak momentum {share:.2f} %, "
        f"{below} the printed {printed} %. The saving over the PD law comes from coasting, not "
        f"from nutation",
    )


def peak_of_another_controller(grounds: Grounds[Configuration]) -> Judgement:
    """Our reading: no controller of the family gives the peak of 90 deg with the other values."""
    fits, alone, together = (
        float(grounds.rows("controllers.csv", fitted=question)["worst_miss_half_units"].min())
        for question in (
            "all but the peak of 90 deg",
            "90 deg, its peak included",
            "all, the peak of 90 deg included",
        )
    )
    return judged(
        fits <= 1.0 < together,
        f"without that peak the nearest of all stiffnesses and dampings, three feedback laws and "
        f"four holding times gives all seven values, to {fits:.1f} half units of their last "
        f"digits; with it some value is missed by {together:.0f} half units. For 90 deg alone "
        f"other gains with a held torque come within {alone:.1f}. Whether the peak is a misprint "
        f"or of another controller, this family cannot say",
    )


def z_wheel_alone(grounds: Grounds[Configuration]) -> Judgement:
    """Eigenaxis turns: the other two wheels must not work."""
    parameters = Parameters.from_section(grounds.section)
    for case in parameters.names:
        require_turn_about_z(parameters, case)
    flights = grounds.rows("flights.parquet")
    share = float(flights[["u_x", "u_y"]].abs().max().max()) / parameters.torque
    return judged(
        share < AT_WORK,
        f"the wheels about x and y give at most {share:.0e} of their torque",
    )


def eigenaxis_not_at_rest(grounds: Grounds[Configuration]) -> Judgement:
    """Eigenaxis turns: at the end the rate must exceed what the document counts as rest."""
    rest = grounds.ledger.value(f"{OPTIMAL}/final-angular-rate/90-deg-torque-optimal/z").value
    names = Parameters.from_section(grounds.section).names
    rates = {}
    for case, name in names.items():
        flown = grounds.rows("flights.parquet", flight=f"eigenaxis {case}")
        rates[name] = float(np.degrees(flown["omega_z"].iloc[-1]))
    left = ", ".join(f"{rate:.2f} deg/s after {name}" for name, rate in rates.items())
    return judged(
        all(abs(rate) > rest for rate in rates.values()),
        f"left are {left}; the document calls less than {rest:g} deg/s rest",
    )


def plan_comes_to_rest(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: our plan, flown in open loop, must end with rates below the printed bound."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "quarter")
    rest = grounds.ledger.value(f"{OPTIMAL}/final-angular-rate/90-deg-torque-optimal/z").value
    name = f"{parameters.names['quarter']}, {MESHES[-1]}"
    end = grounds.rows("replays.parquet", flight=name).iloc[-1]
    rate = float(np.degrees(end[[f"omega_{axis}" for axis in "xyz"]].abs().max()))
    return judged(
        rate < rest,
        f"our plan, which is not the printed one, ends with at most {rate:.0e} deg/s about an axis",
    )


def near_eigenaxis(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: the body's z axis must hardly tilt on our plan."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "quarter")
    name = f"{parameters.names['quarter']}, {MESHES[-1]}"
    tilt = float(_tilts(grounds.rows("plan-nodes.parquet", plan=name)).iloc[0])
    return judged(
        tilt < 10.0 * VISIBLE_DEG,
        f"the z axis tilts by at most {tilt:.1g} deg on our plan, which is not the printed one",
    )


def points_cluster_for_the_motion(grounds: Grounds[Configuration]) -> Judgement:
    """A plan's points must lie elsewhere than where their number alone puts them."""
    parameters = Parameters.from_section(grounds.section)
    nodes = grounds.rows("plan-nodes.parquet", node=1)
    off = []
    for case in parameters.names:
        _, plan = chosen_plan(nodes, "plan", parameters, case, MESHES[-1])
        if len(plan):
            fixed, _ = legendre_gauss(len(plan))
            found = 2.0 * plan["time_s"].to_numpy() / parameters.duration - 1.0
            off.append(float(np.abs(found - fixed).max()))
    if not off:
        raise LookupError("there is no plan in one segment")
    return judged(
        max(off) > INDEPENDENT_MISS,
        f"the points lie at the roots of the Legendre polynomial, to {max(off):.0e} of half the "
        f"time, in both turns: they cluster at the ends for any motion, and not for this one. "
        f"That they are dense where the rates change fast is true",
    )


def better_than_eigenaxis(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: yaw error and peak momentum in the fuller model are compared, open loop with PD."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "quarter")
    found = []
    for table, name in (
        ("replays.parquet", f"{parameters.names['quarter']}, one segment"),
        ("flights.parquet", "eigenaxis quarter"),
    ):
        flown = grounds.rows(table, flight=name)
        yaw = angles_deg(flown.tail(1))[0, 2]
        error = abs(short_of(yaw, target_yaw(parameters, "quarter")))
        found.append((error, 100.0 * flown["h_z"].abs().max() / parameters.momentum))
    (error, peak), (pd_error, pd_peak) = found
    return judged(
        error < pd_error and peak < pd_peak,
        f"yaw error {error:.2f} against {pd_error:.2f} deg, peak momentum {peak:.1f} against "
        f"{pd_peak:.1f} %; part of it is that the plan knows the time it has and the law does not",
    )


def eigenaxis_stays_on_axis(grounds: Grounds[Configuration]) -> Judgement:
    """Roll and pitch of all eigenaxis flights must stay small."""
    parameters = Parameters.from_section(grounds.section)
    for case in parameters.names:
        require_turn_about_z(parameters, case)
    flights = grounds.table("flights.parquet")
    largest = float(np.abs(angles_deg(flights.iloc[::10])[:, :2]).max())
    return judged(
        largest < SMALL_DEG, f"roll and pitch stay below {largest:.1e} deg in all flights"
    )


def open_loop_follows(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: the torque history flown open loop is compared with the plan."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "quarter")
    name = f"{parameters.names['quarter']}, {MESHES[-1]}"
    flown = grounds.rows("replays.parquet", flight=name)
    nodes = grounds.rows("plan-nodes.parquet", plan=name)
    torques = resampled(nodes, grounds.section.resampling_hz)
    round_earth = replace(parameters, gravity=parameters.gravity._replace(j2=0.0))
    calm = replay(round_earth, grounds.section, torques, parameters.duration, drag=0.0)
    error, without = (_end_error_deg(parameters, one) for one in (flown, calm))
    return judged(
        error < VISIBLE_DEG,
        f"the end is missed by {error:.3f} deg, and by {without:.3f} deg without drag and "
        f"oblateness: {100 * without / error:.0f} % of it is left to the linear interpolation "
        f"between nodes",
    )


def _end_error_deg(parameters: Parameters, flown: pd.DataFrame) -> float:
    """Root of the squared roll, pitch and missing yaw, deg, at the end of the smaller turn."""
    roll, pitch, yaw = angles_deg(flown.tail(1))[0]
    return float(
        np.sqrt(roll**2 + pitch**2 + short_of(yaw, target_yaw(parameters, "quarter")) ** 2)
    )


def half_turn_off_eigenaxis(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: the body's z axis must tilt on feasible plans."""
    require_turn_about_z(Parameters.from_section(grounds.section), "half")
    tilts = _tilts(grounds.rows("trade-off-plans.parquet"))
    falling = len(tilts) > 1 and tilts.is_monotonic_decreasing
    order = ", the more the shorter the time" if falling else ""
    return judged(
        (tilts > 10.0 * VISIBLE_DEG).all(),
        f"the z axis tilts by {tilts.min():.0f} to {tilts.max():.0f} deg on our feasible plans"
        f"{order}",
    )


def _tilts(plans: pd.DataFrame) -> pd.Series:
    """Largest tilt of the z axis, deg, of each plan, in the order of their durations."""
    times = plans.groupby("plan")["time_s"].max().sort_values()
    cosine = 1.0 - 2.0 * (plans["q_1"] ** 2 + plans["q_2"] ** 2)
    tilts = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return tilts.groupby(plans["plan"]).max()[times.index]


def path_like_a_cardioid(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: the path of the body's z axis must be nearer to a cardioid than to a circle.

    Both begin and end at the vertical, where the cardioid has its cusp, and are turned, mirrored
    and scaled to fit the path in the inertial x-y plane.
    """
    require_turn_about_z(Parameters.from_section(grounds.section), "half")
    plans = grounds.rows("trade-off-plans.parquet")
    plan = plans[plans["plan"] == plans["plan"].iloc[0]]
    tilt = _tilts(plan).iloc[0]
    if tilt < VISIBLE_DEG:
        return Judgement("fails", f"the z axis stays within {tilt:.1g} deg of the vertical")
    q1, q2, q3, q4 = (plan[f"q_{i}"].to_numpy() for i in range(1, 5))
    path = _evenly(2.0 * (q1 * q3 + q2 * q4) + 2.0j * (q2 * q3 - q1 * q4))
    angle = np.linspace(0.0, 2.0 * np.pi, 1001)
    cardioid = _misfit(path, _evenly((1.0 - np.cos(angle)) * np.exp(1j * angle)))
    circle = _misfit(path, _evenly(1.0 - np.exp(1j * angle)))
    found = (
        f"our fastest feasible plan leaves the vertical by {tilt:.0f} deg; the nearest cardioid is "
        f"off its path by {100 * cardioid:.0f} %, the nearest circle by {100 * circle:.0f} % of "
        f"its spread"
    )
    if cardioid < circle:
        return Judgement("holds", found)
    return Judgement("undecided", f"{found}. The printed run is another one, and is not at hand")


def _evenly(path: np.ndarray) -> np.ndarray:
    """A path in the complex plane at points that are equally far apart along it."""
    way = np.r_[0.0, np.cumsum(np.abs(np.diff(path)))]
    return np.interp(np.linspace(0.0, way[-1], 400), way, path)


def _misfit(path: np.ndarray, shape: np.ndarray) -> float:
    """Root mean square distance to a turned, mirrored and scaled shape, in spreads of the path."""
    path = path - path[0]
    off = [
        np.abs(path - np.vdot(one, path) / np.vdot(one, one) * one)
        for one in (shape, shape.conj(), shape[::-1], shape[::-1].conj())
    ]
    return float(min(np.sqrt(np.mean(one**2)) for one in off) / np.std(path))


def torque_all_the_time(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg in the printed time: there must be torque about each axis nearly all the time."""
    parameters = Parameters.from_section(grounds.section)
    nodes = grounds.rows("plan-nodes.parquet", node=1)
    name, plan = chosen_plan(nodes, "plan", parameters, "half", MESHES[-1])
    if plan.empty:
        raise LookupError("there is no plan of the larger turn")
    used = plan[[f"u_{axis}" for axis in "xyz"]].abs() > AT_WORK * parameters.torque
    share = 100.0 * float(used.mean().min())
    return judged(
        share > 90.0,
        f"the least-used wheel works at {share:.0f} % of the points of our plan '{name}', which "
        f"is not the printed one",
    )


def gradient_dominates(grounds: Grounds[Configuration]) -> Judgement:
    """From 400 km on the gravity gradient is the larger torque, with the lever of Table 5.

    In our exponential air up to its densest, and in MSIS-86 at any solar flux.
    """
    section = grounds.section
    name = "section-v-c/altitude-above-which-gravity-gradient-dominates/environment-torque-study"
    least = grounds.ledger.value(name).value
    table = grounds.table("environment.csv")
    lever = printed_lever_mm(section)
    rows = table[np.isclose(table["offset_mm"], lever) & (table["altitude_km"] >= least)]
    air = grounds.rows("atmospheres.csv", atmosphere=AIR[0])
    air = air[air["altitude_km"] >= least].sort_values("altitude_km")
    if rows.empty or air.empty:
        raise LookupError(f"no altitude from {least:g} km on, or not the printed lever")
    ratio = float((rows["gravity_gradient_N_m"] / rows["drag_N_m"]).min())
    in_msis = float((air["gravity_gradient_N_m"] / air["drag_N_m"]).min())
    lowest = air["altitude_km"].iloc[0]
    equal = air.loc[air["altitude_km"] == lowest, "equal_lever_mm"]
    return judged(
        min(ratio, in_msis) > 1.0,
        f"with the lever of Table 5, {lever:g} mm, the gravity gradient is at least {ratio:.0f} "
        f"times the drag from {least:g} km on in {max(section.environment.density_factors):g} "
        f"times the mean density too, and at least {in_msis:.0f} times in {AIR[0]}, of which the "
        f"document's atmosphere is a fit, at any solar flux from {air['solar_flux'].min():g} to "
        f"{air['solar_flux'].max():g}. For drag to be as large at {lowest:g} km the lever would "
        f"have to be {equal.min():.2g} to {equal.max():.2g} mm",
    )


def transition_matrix_keeps_length(grounds: Grounds[Configuration]) -> Judgement:
    """The closed form is a rotation: only rounding denormalises the quaternion."""
    table = grounds.table("propagator.csv")
    length = float(table["length_error"].max())
    parameters = Parameters.from_section(grounds.section)
    flown = table[table["flight"].str.startswith(parameters.names["half"])]
    rows = flown.set_index("step_s")["error_deg"]
    if not rows[1.0] > 0.0:
        raise LookupError("the turn is too short for steps of a second")
    ratio = float(rows[2.0] / rows[1.0])
    order = "second order, " if abs(ratio - 4.0) < 1.0 else ""
    return judged(
        length < 1e-12,
        f"the length is off by at most {length:.0e} after {parameters.duration:g} s; the attitude "
        f"error is {rows[1.0]:g} deg with the printed step and falls by {ratio:.1f} when the step "
        f"is halved, {order}so the step matters and rounding does not",
    )


def not_the_global_minimum(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: the least torque that the printed peak takes is compared with a plan of ours."""
    parameters = Parameters.from_section(grounds.section)
    require_turn_about_z(parameters, "quarter")
    peak, left = (
        grounds.ledger.value(f"{OPTIMAL}/{name}/90-deg-torque-optimal/z")
        for name in ("maximum-angular-momentum-usage", "final-angular-momentum-usage")
    )
    # The wheel takes up the peak and gives back all but what is left.
    used = 2.0 * (peak.value - peak.half_unit) - left.value
    printed = used / 100.0 * parameters.momentum
    name = f"{parameters.names['quarter']}, segments"
    ours = float(
        grounds.rows("plans.csv", plan=name, held_converged=True)["held_cost_N_m_s"].iloc[0]
    )
    return judged(
        printed > (1.0 + SAME_COST) * ours,
        f"to reach the printed peak about z and come back takes {1e3 * printed:.3f} mN m s at the "
        f"least, and a plan of ours does the whole turn with {1e3 * ours:.3f}",
    )


def local_minima(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: solves for least torque from several starts must end at several costs."""
    parameters = Parameters.from_section(grounds.section)
    names = plan_names(parameters, "quarter", MESHES[-1])
    starts = grounds.rows("plan-starts.csv", plan=names[0], converged=True)
    if len(starts) < 2:
        raise LookupError("one start tells nothing of other minima")
    costs = np.sort(starts["cost_N_m_s"])
    minima = 1 + int((np.diff(costs) > SAME_COST * costs[0]).sum())
    return judged(
        minima > 1,
        f"{len(starts)} starts on and off the eigenaxis end at {minima} cost"
        f"{'s' if minima > 1 else ''}, apart by {(costs[-1] - costs[0]) / costs[0]:.0e} of it at "
        f"most; what starts do not find they do not exclude. Of the turn of "
        f"{parameters.names['half']} in the printed time there is no plan to be a minimum",
    )


def plans_are_feasible(grounds: Grounds) -> Judgement:
    """Our own claim: held plans and least times converged, keep limits and meet their ends anew."""
    held = pd.concat([grounds.table(f"{name}.csv") for name in ("plans", "trade-off")])
    held = held[held["held_converged"] == True]  # noqa: E712
    times = grounds.rows("minimum-times.csv", converged=True)
    if held.empty:
        raise LookupError("there is no plan with a held control")
    miss = float(max(held["attitude_miss_rad"].max(), times["attitude_miss_rad"].max()))
    torque = float(held["largest_torque_share"].max())
    return judged(
        miss < INDEPENDENT_MISS and torque <= 1.0,
        f"{len(held)} plans with a held control and {len(times)} least times, flown anew by "
        f"another integrator, miss their end by at most {miss:.0e} rad; torque never exceeds "
        f"{100 * torque:.1f} % of the limit at or between points",
    )


def hamiltonian_is_constant(grounds: Grounds) -> Judgement:
    """Our own claim: the Hamiltonian of every collocated plan varies by less than a twentieth."""
    tables = {
        name: grounds.table(f"{name}.csv") for name in ("plans", "trade-off", "minimum-times")
    }
    spreads = pd.concat(
        [
            table[table["converged"]].set_index(table.columns[0])["hamiltonian_spread"]
            for table in tables.values()
        ]
    )
    wide = spreads[spreads >= 0.05].sort_values(ascending=False)
    which = "".join(f"; {100 * spread:.0f} % on '{name}'" for name, spread in wide.items())
    return judged(
        wide.empty,
        f"over {len(spreads)} plans it varies by {100 * spreads.max():.0f} % at most, most of it "
        f"at the jumps of the control, which few points smear{which}",
    )
