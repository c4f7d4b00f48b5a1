"""Predicates of the document's prose claims."""

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.observations import short_of, target_yaw
from smallsat.studies.slew.methods.bound import impossible, largest_disturbance, needed, reach
from smallsat.studies.slew.methods.environment_study import crossover_km
from smallsat.studies.slew.methods.minimum_time import eigenaxis_time
from smallsat.studies.slew.model.simulation import angles_deg
from smallsat.studies.slew.parameters import Parameters, panels

# Where the document prints its torque-optimal and its eigenaxis turns.
OPTIMAL, EIGENAXIS = "section-vi-b", "section-vi-a"

INDEPENDENT_MISS = 1e-6
VISIBLE_DEG = 1.0
SMALL_DEG = 0.005
SAME_MINIMUM_S = 0.1
ROUNDING = 1e-12
# Costs are equal to this: what the smoothing and the pieces of a plan leave.
SAME_COST = 1e-3


def _least(grounds: Grounds, case: str) -> float:
    """Least time, s, of a case; a LookupError where none was found."""
    return float(grounds.rows("minimum-times.csv", case=case, converged=True)["duration_s"].iloc[0])


def _turn_about_z(parameters: Parameters, case: str) -> None:
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
    bound = grounds.table("bound.csv").set_index("model")["bound_s"]
    return Judgement(
        "holds",
        f"from rest to rest the wheels can move the body's x axis along at most {path:.1f} deg of "
        f"the sphere in {duration:g} s, whatever the path, and it has to move by {angle:g} deg: no "
        f"plan can exist below {bound['wheels, gravity gradient']:.2f} s. The least time found is "
        f"{least:.3f} s, and the solver refuses {duration:g} s on every mesh",
    )


def valid_trajectory_at_limits(grounds: Grounds[Configuration]) -> Judgement:
    """There must be a valid trajectory for the 180 deg turn in 100 s."""
    judgement = not_in_the_given_time(grounds)
    row = grounds.table("infeasible.csv").iloc[-1]
    if judgement.outcome == "undecided":
        return judgement
    if judgement.outcome == "fails":
        return Judgement("holds", f"a valid one exists: {judgement.evidence}")
    miss = np.degrees(np.sqrt(row["miss"]))
    duration = grounds.section.manoeuvre.duration_s
    return Judgement(
        "fails",
        f"no valid one exists: {judgement.evidence}. The least infeasible plan misses its end by "
        f"{miss:.1f} deg in attitude and rate together (rate times {duration:g} s, root of "
        f"squares)",
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
        f"the digits. With so much rate left the bound allows {path:.0f} deg, so the printed run "
        f"is possible as a run that ends short of its target, not as one that meets it",
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
        f"from the printed angles: {yaw:.1f} deg in yaw and about {whole:.1f} deg in all, against "
        f"{eigenaxis:.1f} deg of the eigenaxis law; neither reaches its target",
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
    return judged(abs(ratio - 0.5) < 0.05, f"the printed rates have the ratio {ratio:.2f}")


def eigenaxis_is_not_fastest(grounds: Grounds[Configuration]) -> Judgement:
    """The least times are compared with full torque about the eigenaxis alone."""
    parameters = Parameters.from_section(grounds.section)
    texts, faster = [], []
    for case, name in parameters.names.items():
        _, moment = _body_axis(parameters, case)
        least = _least(grounds, f"{name}, wheels")
        angle = np.radians(parameters.angle_deg(case))
        alone = eigenaxis_time(angle, moment, parameters.torque, parameters.momentum)
        faster.append(least < alone - 1.0)
        texts.append(f"{name}: {least:.2f} s against {alone:.2f} s")
    return judged(all(faster), "; ".join(texts))


def _body_axis(parameters: Parameters, case: str) -> tuple[str, float]:
    """The body axis that a turn is about and its moment, kg m^2.

    A LookupError where it is none, or no principal axis: a turn about it alone is then no motion by
    its own wheel.
    """
    place = int(np.argmax(np.abs(parameters.axis(case))))
    others = np.delete(np.r_[parameters.axis(case), parameters.inertia[place]], [place, 3 + place])
    if np.abs(others).max() > ROUNDING:
        raise LookupError("the turn is not about a principal axis along a wheel")
    return "xyz"[place], float(parameters.inertia[place, place])


def nutation_saves_torque(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: it is asked whether motion about x and y lowers the torque used."""
    parameters = Parameters.from_section(grounds.section)
    plans = grounds.table("plans.csv").set_index("plan")
    row = plans.loc[f"{parameters.names['quarter']}, no gravity gradient, segments"]
    axis, moment = _body_axis(parameters, "quarter")
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
        f"of {row['starts']} starts off the eigenaxis every one ends in full torque, coast, full "
        f"torque about {axis} alone: {found}, peak momentum {share:.2f} %, {below} the printed "
        f"{printed} %. The saving over the PD law comes from coasting, not from nutation",
    )


def bang_coast_bang(
    angle: float, moment: float, torque: float, duration: float
) -> tuple[float, float]:
    """Cost and peak momentum, N m s, of the cheapest turn about one axis, by hand."""
    burn = 0.5 * (duration - np.sqrt(duration**2 - 4.0 * angle * moment / torque))
    return 2.0 * torque * burn, torque * burn


def better_than_eigenaxis(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: yaw error and peak momentum in the fuller model are compared, open loop with PD."""
    parameters = Parameters.from_section(grounds.section)
    _turn_about_z(parameters, "quarter")
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
        _turn_about_z(parameters, case)
    flights = grounds.table("flights.parquet")
    largest = float(np.abs(angles_deg(flights.iloc[::10])[:, :2]).max())
    return judged(
        largest < SMALL_DEG, f"roll and pitch stay below {largest:.1e} deg in all flights"
    )


def open_loop_follows(grounds: Grounds[Configuration]) -> Judgement:
    """90 deg: the torque history flown open loop is compared with the plan."""
    parameters = Parameters.from_section(grounds.section)
    _turn_about_z(parameters, "quarter")
    name = f"{parameters.names['quarter']}, one segment"
    flown = grounds.rows("replays.parquet", flight=name).tail(1)
    roll, pitch, yaw = angles_deg(flown)[0]
    aside = short_of(yaw, target_yaw(parameters, "quarter"))
    error = float(np.sqrt(roll**2 + pitch**2 + aside**2))
    return judged(
        error < VISIBLE_DEG,
        f"the end is missed by {error:.2f} deg; what is missed comes from the linear interpolation "
        f"between nodes, not from drag or the oblateness",
    )


def half_turn_off_eigenaxis(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: the body's z axis must tilt on feasible plans."""
    _turn_about_z(Parameters.from_section(grounds.section), "half")
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


def closed_loop_of_the_axis(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: the path of the body's z axis in the inertial x-y plane closes on itself."""
    _turn_about_z(Parameters.from_section(grounds.section), "half")
    plans = grounds.rows("trade-off-plans.parquet")
    path = plans[plans["plan"] == plans["plan"].iloc[0]]
    q1, q2, q3, q4 = (path[f"q_{i}"].to_numpy() for i in range(1, 5))
    x, y = 2.0 * (q1 * q3 + q2 * q4), 2.0 * (q2 * q3 - q1 * q4)
    gap = float(np.hypot(x[-1] - x[0], y[-1] - y[0]))
    area = 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    return judged(
        gap < INDEPENDENT_MISS and abs(area) > 0.01,
        f"on our fastest feasible plan the path leaves the vertical and comes back "
        f"(gap {gap:.0e}), a drop-shaped loop around an area of {abs(area):.2f}; "
        f"a cardioid in that sense",
    )


def torque_all_the_time(grounds: Grounds[Configuration]) -> Judgement:
    """180 deg: there must be torque about each axis nearly all the time."""
    plans = grounds.rows("trade-off-plans.parquet")
    parameters = Parameters.from_section(grounds.section)
    limit = 0.01 * parameters.torque
    shares = [
        (
            str(name),
            100.0 * min(float((table[f"u_{axis}"].abs() > limit).mean()) for axis in "xyz"),
        )
        for name, table in plans.groupby("plan", sort=False)
    ]
    first, last = shares[0], shares[-1]
    near = ": true next to the least time, where there is no torque to spare, and not in general"
    return judged(
        first[1] > 90.0 and last[1] > 90.0,
        f"the least-used wheel works {first[1]:.0f} % of the time on the plan '{first[0]}' and "
        f"{last[1]:.0f} % on '{last[0]}'{near if first[1] > 90.0 >= last[1] else ''}",
    )


def gradient_dominates(grounds: Grounds[Configuration]) -> Judgement:
    """From 400 km on the gravity gradient is the larger torque, over the band of assumptions."""
    section = grounds.section
    name = "section-v-c/altitude-above-which-gravity-gradient-dominates/environment-torque-study"
    least = grounds.ledger.value(name).value
    table = grounds.table("environment.csv")
    larger = table["gravity_gradient_N_m"] > table["drag_N_m"]
    above = larger[table["altitude_km"] >= least]
    lever = np.isclose(table["offset_mm"], 1e3 * abs(panels(section.spacecraft)[0, 5]))
    if not len(above) or not lever.any():
        raise LookupError(f"no altitude from {least:g} km on, or not the printed lever")
    everywhere = larger[lever & np.isclose(table["density_factor"], 1.0)].all()
    share = float(above.mean())
    largest = max(section.environment.offsets_mm)
    crossing = crossover_km(table, largest)
    worst = crossover_km(table, largest, max(section.environment.density_factors))
    return Judgement(
        "holds" if share == 1.0 else "undecided",
        f"with the printed lever it {'dominates' if everywhere else 'does not dominate'} at every "
        f"altitude studied; with {largest:g} mm the crossover is at {_km(crossing)}, at "
        f"{_km(worst)} in the densest air assumed; {100 * share:.0f} % of the cases from "
        f"{least:g} km on",
    )


def _km(altitude: float) -> str:
    return "no altitude studied" if np.isnan(altitude) else f"{altitude:.0f} km"


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


def local_minima(grounds: Grounds[Configuration]) -> Judgement:
    """Several starts must end in different least times."""
    name = Parameters.from_section(grounds.section).names["half"]
    case = f"{name}, wheels"
    found = grounds.rows("minimum-time-starts.csv", converged=True, case=case)
    durations = np.sort(found["duration_s"])
    # What two starts reach apart by less than this is one minimum, whatever its last digit.
    new = np.diff(durations, prepend=-np.inf) > SAME_MINIMUM_S
    values = [round(float(value), 2) for value in durations[new]]
    return judged(
        len(values) > 1,
        f"the least-time turn of {name} has local minima at {', '.join(map(str, values))} s; the "
        f"torque-optimal plans come in mirror pairs of the same cost",
    )


def plans_are_optimal(grounds: Grounds) -> Judgement:
    """Our own claim: every reported plan has converged, keeps its limits and meets its end anew."""
    table, times = (
        grounds.rows(f"{name}.csv", converged=True) for name in ("trade-off", "minimum-times")
    )
    miss = float(max(table["attitude_miss_rad"].max(), times["attitude_miss_rad"].max()))
    spread = float(max(table["hamiltonian_spread"].max(), times["hamiltonian_spread"].max()))
    torque = float(table["largest_torque_share"].max())
    return judged(
        table["held_converged"].all()
        and miss < INDEPENDENT_MISS
        and torque <= 1.0
        and spread < 0.05,
        f"every reported optimum has converged; flown anew by another integrator they miss their "
        f"end by at most {miss:.0e} rad; torque never exceeds {100 * torque:.1f} % of the limit at "
        f"or between points; the Hamiltonian varies by at most {100 * spread:.1f} % over a plan, "
        f"most of it at the jumps of the control",
    )
