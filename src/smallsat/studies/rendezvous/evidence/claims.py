"""Predicates of the document's prose claims of chapters 2 and 3.

What rests on undisclosed parameters is judged over the ensemble of acceptable sets, see
`smallsat.studies.rendezvous.evidence.ensemble`.
"""

from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import linprog

from smallsat.dynamics.units import KM, MINUTE
from smallsat.evidence.claims import Judgement, Outcome, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.case_tables import (
    CASE_TABLES,
    TOTAL,
    cell_id,
    phase_cells,
    total_cells,
)
from smallsat.studies.rendezvous.evidence.ensemble import over_ensemble
from smallsat.studies.rendezvous.evidence.observations import FIRST_SECOND
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.inference.misfit import printed_steps
from smallsat.studies.rendezvous.model.columns import CHANGE, STATE
from smallsat.studies.rendezvous.model.geometry import cone_faces, rotated
from smallsat.studies.rendezvous.parameters import law, start_state

MUCH = 1.5  # "much longer": by half at least
LITTLE = 0.1  # "comparable", "no significant amount": within a tenth
SLIGHT_M = 1.0  # of a cone violation
ZONE_SHARE = 0.01  # of r1, that a way between samples may cut off
COAST_SHARE = 0.05  # of the bound: what counts as a control that is off
NEAR_ZONE = 1.25  # of r1: on the way around the zone
BETWEEN_SHARE, BETWEEN_M = 0.02, 0.02  # of a bound, and m, between samples
TRUTH_DV = 0.05  # m/s that the nonlinear truth may change a phase by


def _totals(grounds: Grounds[Configuration]) -> Any:
    """Time, s, and delta-v of whole manoeuvres by case; LookupError where one does not dock."""
    table = grounds.table("phases.csv")
    reading = grounds.section.inferred.readings.delta_v
    sums = table.groupby("flight")[["time_s", reading]].sum()
    done = table.groupby("flight")["ended"].all()
    return sums.rename(columns={reading: "delta_v_m_s"}).where(done)


def _docked(grounds: Grounds[Configuration], *cases: str) -> Any:
    """Totals of these cases; LookupError where one of them does not dock."""
    totals = _totals(grounds).loc[list(cases)]
    if totals.isna().any(axis=None):
        raise LookupError("a case does not dock")
    return totals


def six_thrusters_move_in_six_degrees(grounds: Grounds[Configuration]) -> Judgement:
    """Thrusters only push: for every force and torque they must span six dimensions positively."""
    count = grounds.section.spacecraft.thrusters
    random = np.random.default_rng(0)
    reached = 0
    trials = 200
    for _ in range(trials):
        wrenches = random.standard_normal((6, count))
        # Positive spanning needs a positive combination that cancels.
        found = linprog(np.zeros(count), A_eq=wrenches, b_eq=np.zeros(6), bounds=(1.0, None))
        reached += found.status == 0
    return judged(
        reached > 0 and count > 6,
        f"thrusters that only push need at least one more than the dimensions that they are to "
        f"reach, seven for force and torque; of {trials} random arrangements of {count} none can "
        f"cancel its own pushes ({reached} can). Six along the axes move the chaser in three "
        f"degrees of freedom, which is what the guidance uses",
    )


@over_ensemble
def one_norm_is_sparser(grounds: Grounds[Configuration]) -> Judgement:
    """More of the far range's control components must be off with the LP than with the QP."""
    bound = grounds.section.phases.far.control_bound_m_s
    far = grounds.rows("flights.parquet", phase="far")

    def off(case: str) -> float:
        changes = far[far["flight"] == case][CHANGE].to_numpy()
        return float((np.abs(changes) < COAST_SHARE * bound).mean())

    linear, quadratic, without = off("lp"), off("v-bar"), off("no-set-point")
    sparser = [linear > quadratic, linear > without]
    outcome: Outcome = "holds" if all(sparser) else "undecided" if any(sparser) else "fails"
    return Judgement(
        outcome,
        f"of the far range's control components {100 * linear:.0f} % are off (below "
        f"{100 * COAST_SHARE:.0f} % of the bound) with the LP, {100 * quadratic:.0f} % with the "
        f"QP, {100 * without:.0f} % with the QP without set point",
    )


def _largest(
    grounds: Grounds, constraint: str, motions: str, *places: str, case: str = ""
) -> float:
    """Largest violation of a constraint, over the cases (or one) and the motions of a kind."""
    own = grounds.rows("constraints.csv", constraint=constraint)
    own = own[own["motion"].str.contains(motions) & own["flight"].str.contains(case)]
    if own.empty or own[list(places)].isna().all(axis=None):
        raise LookupError(f"no case comes to where the {constraint} binds")
    return float(own[list(places)].max().max())


@over_ensemble
def keep_out_zone_is_kept(grounds: Grounds[Configuration]) -> Judgement:
    """The cases' far ranges are searched for their deepest passage, between samples too."""
    keep_out = law(grounds.section, "v-bar").keep_out
    linear = _largest(grounds, "keep out", "linear", "sample", "between")
    impulses = _largest(grounds, "keep out", "impulses", "sample", "between")
    burns = _largest(grounds, "keep out", "burns", "sample", "between")
    worst = max(linear, impulses, burns)
    return judged(
        worst <= ZONE_SHARE * keep_out,
        f"deepest inside the zone of {keep_out:.1f} m, looked at every second: {linear:.2f} m in "
        f"the linear motion, {impulses:.2f} m in the nonlinear one, {burns:.2f} m with burns "
        f"(negative: outside); the planes bind at samples only, and {100 * ZONE_SHARE:g} % of r1 "
        f"is allowed",
    )


@over_ensemble
def cone_violated_slightly(grounds: Grounds) -> Judgement:
    """The chaser must never be far outside the cone at samples of the three cases' mid ranges."""
    by_case = {
        case: _largest(grounds, "cone penalty", "linear", "sample", case=case)
        for case in CASE_TABLES
    }
    text = ", ".join(f"{case}: {max(m, 0.0):.2f} m" for case, m in by_case.items())
    worst = max(by_case.values())
    return judged(
        worst <= SLIGHT_M,
        f"at the samples of the three cases' mid ranges the chaser is at most {worst:.2f} m "
        f"outside the cone ({text}); slightly is read as at most {SLIGHT_M:g} m",
    )


@over_ensemble
def r_bar_takes_less(grounds: Grounds) -> Judgement:
    """Time and delta-v of Case 2 must be below those of Case 1.

    A set that misses the printed time of one of the two is no witness against what the printed
    tables show. This came after a run in which most sets were such.
    """
    totals = _docked(grounds, "v-bar", "r-bar")
    time, fuel = totals.loc["v-bar"] - totals.loc["r-bar"]
    evidence = (
        f"it saves {time:.0f} s and {fuel:.2f} m/s; printed are "
        f"{_printed_less(grounds, 'time', 'v-bar', 'r-bar'):.0f} s and "
        f"{_printed_less(grounds, 'total-delta-v', 'v-bar', 'r-bar'):.2f} m/s"
    )
    for case in ("v-bar", "r-bar"):
        ours, printed = float(totals.loc[case, "time_s"]), _printed(grounds, case, "time")
        if abs(ours / printed - 1.0) > LITTLE:
            return Judgement(
                "undecided",
                f"{evidence}; {case} takes {ours:.0f} s where {printed:.0f} s are printed, more "
                f"than a tenth away, which makes this set no witness",
            )
    return judged(time > 0 and fuel > 0, evidence)


@over_ensemble
def r_bar_goes_less_far_around(grounds: Grounds) -> Judgement:
    """The far range of Case 2 must go less far around the target than that of Case 1."""
    far = grounds.rows("flights.parquet", phase="far")
    along, radial = _way_around(far, "v-bar"), _way_around(far, "r-bar")
    table = grounds.table("phases.csv").set_index(["flight", "phase"])["ended"]
    if not (table["v-bar", "far"] and table["r-bar", "far"]):
        raise LookupError("a far range does not end")
    return judged(
        abs(radial) < abs(along),
        f"the far range of Case 1 goes {abs(along):.0f} deg around the target, that of Case 2 "
        f"{abs(radial):.0f} deg",
    )


@over_ensemble
def all_cases_dock(grounds: Grounds) -> Judgement:
    """Chapter 7: the final phases of the three cases must end, in linear motion."""
    table = grounds.rows("phases.csv", phase="final").set_index("flight")["ended"]
    docked = [case for case in CASE_TABLES if table[case]]
    return judged(
        len(docked) == len(CASE_TABLES),
        f"{len(docked)} of {len(CASE_TABLES)} cases dock: {', '.join(docked)}",
    )


def _printed(grounds: Grounds, case: str, quantity: str, phase: str = TOTAL) -> float:
    return grounds.ledger.value(cell_id(quantity, case, phase)).value


def _printed_less(grounds: Grounds, quantity: str, case: str, other: str) -> float:
    return _printed(grounds, case, quantity) - _printed(grounds, other, quantity)


@over_ensemble
def rotating_is_comparable(grounds: Grounds) -> Judgement:
    """Case 3's delta-v must lie within a tenth of the interval between Cases 1 and 2."""
    first, second, third = _docked(grounds, "v-bar", "r-bar", "rotating")["delta_v_m_s"]
    low, high = min(first, second), max(first, second)
    return judged(
        (1 - LITTLE) * low <= third <= (1 + LITTLE) * high,
        f"Case 3 needs {third:.2f} m/s, Cases 1 and 2 {first:.2f} and {second:.2f}; comparable is "
        f"read as within a tenth of their interval",
    )


@over_ensemble
def difference_lies_close(grounds: Grounds[Configuration]) -> Judgement:
    """Case 3's delta-v must differ most close to the target, from both other cases.

    A difference is taken absolutely and as a share of the phase; where the two answers, or the
    comparisons with Cases 1 and 2, are not one, the sentence can be read either way.
    """
    reading = grounds.section.inferred.readings.delta_v
    ours: Any = grounds.table("phases.csv").pivot(index="phase", columns="flight", values=reading)
    cells: Any = phase_cells(grounds.ledger)
    printed = cells.pivot(index="phase", columns="case", values="delta_v_m_s")
    _docked(grounds, "v-bar", "r-bar", "rotating")

    def close(table: Any, other: str, share: bool) -> bool:
        difference = (table["rotating"] - table[other]).abs()
        if share:
            difference = difference / table[other]
        return bool(difference[["mid", "final"]].max() > difference["far"])

    answers = {
        (name, other, share): close(table, other, share)
        for name, table in (("printed", printed), ("ours", ours))
        for other in ("v-bar", "r-bar")
        for share in (False, True)
    }
    own = [answer for (name, _, _), answer in answers.items() if name == "ours"]
    text = "; ".join(
        f"{name}: in m/s against Case 1 {_yes(answers[name, 'v-bar', False])}, against Case 2 "
        f"{_yes(answers[name, 'r-bar', False])}, in shares {_yes(answers[name, 'v-bar', True])} "
        f"and {_yes(answers[name, 'r-bar', True])}"
        for name in ("printed", "ours")
    )
    if len(set(own)) > 1:
        return Judgement("undecided", text)
    return judged(own[0], text)


def _yes(answer: bool) -> str:
    return "yes" if answer else "no"


@over_ensemble
def rotation_adds_little(grounds: Grounds) -> Judgement:
    """Case 3 is compared with Case 1, the same approach to a target at rest."""
    first, third = _docked(grounds, "v-bar", "rotating")["delta_v_m_s"]
    return judged(
        third - first < LITTLE * first,
        f"the rotating target takes {third - first:+.2f} m/s beside Case 1; printed is "
        f"{_printed_less(grounds, 'total-delta-v', 'rotating', 'v-bar'):+.2f} m/s. The "
        f"rotation rate is inferred too, and other rates were not printed",
    )


@over_ensemble
def without_set_point_takes_longer(grounds: Grounds) -> Judgement:
    """The QP without set point must take longer by a factor of `MUCH` at least."""
    time = _docked(grounds, "v-bar", "no-set-point")["time_s"]
    factor = time["no-set-point"] / time["v-bar"]
    cells = total_cells(grounds.ledger).set_index("case")["time_min"]
    return judged(
        factor > MUCH,
        f"it takes {factor:.2f} times as long; printed is "
        f"{cells['no-set-point'] / cells['v-bar']:.2f}",
    )


@over_ensemble
def guided_around_the_zone(grounds: Grounds[Configuration]) -> Judgement:
    """The angle that is flown near the zone is compared with and without set point."""
    paths = grounds.table("paths.parquet")
    keep_out = law(grounds.section, "v-bar").keep_out

    def turned_near(case: str) -> float:
        own = paths[(paths["flight"] == case) & (paths["phase"] == "far")]
        near = own[np.hypot(own["x_m"], own["y_m"]) < NEAR_ZONE * keep_out]
        angle = np.unwrap(np.arctan2(near["y_m"], near["x_m"]))
        return float(np.degrees(np.ptp(angle))) if len(angle) else 0.0

    without, with_point = turned_near("no-set-point"), turned_near("v-bar")
    return judged(
        without > 45.0,
        f"within {NEAR_ZONE:g} r1 the chaser goes around by {without:.0f} deg without set point, "
        f"and by {with_point:.0f} deg with it (inferred set)",
    )


def _way_around(flights: pd.DataFrame, case: str) -> float:
    """Angle flown about the target in the orbit's plane, deg."""
    own = flights[flights["flight"] == case]
    angle = np.unwrap(np.arctan2(own["y_m"], own["x_m"]))
    return float(np.degrees(angle[-1] - angle[0]))


@over_ensemble
def lp_takes_another_way(grounds: Grounds) -> Judgement:
    """The far ranges of QP and LP must go about the target in opposite directions.

    The weights of the LP are not printed, and ours are chosen for its time and delta-v: that it
    goes another way with them shows that the sentence can be true, and that it does not shows
    nothing. This is the reading since a first run, in which it did not.
    """
    flights = grounds.table("flights.parquet")
    quadratic, linear = _way_around(flights, "v-bar"), _way_around(flights, "lp")
    reached = ((flights["flight"] == "lp") & (flights["phase"] == "mid")).any()
    text = f"about the target the QP turns by {quadratic:+.0f} deg, the LP by {linear:+.0f} deg"
    if not reached or quadratic * linear >= 0.0:
        return Judgement("undecided", f"{text}, with the weights at hand, which are not printed")
    return Judgement("holds", text)


@over_ensemble
def lp_saves_fuel(grounds: Grounds) -> Judgement:
    """The LP of the configuration must save delta-v and take longer than the QP.

    As for its way around, weights of ours that do not show it show nothing.
    """
    totals = _docked(grounds, "v-bar", "lp")
    fuel, time = totals["delta_v_m_s"], totals["time_s"]
    cells = total_cells(grounds.ledger).set_index("case")["delta_v_m_s"]
    return Judgement(
        "holds" if fuel["lp"] < fuel["v-bar"] and time["lp"] > time["v-bar"] else "undecided",
        f"the LP needs {fuel['lp']:.2f} m/s, the QP {fuel['v-bar']:.2f}; printed are "
        f"{cells['lp']:g} and {cells['v-bar']:g}, and {cells['no-set-point']:g} for the QP without "
        f"set point. The weights of the LP are not printed",
    )


def totals_add_up(grounds: Grounds) -> Judgement:
    """The printed tables must add up, to half a unit of each rounded term."""
    cells = phase_cells(grounds.ledger)
    worst = {}
    for quantity in ("delta_v_m_s", "time_s"):
        table = cells.pivot(index="case", columns="phase", values=quantity)
        worst[quantity] = float((table[list(PHASES)].sum(axis=1) - table[TOTAL]).abs().max())
    time, delta_v, text = (
        grounds.ledger.value(name)
        for name in (
            "table-3-6/time/qp-with-set-point",
            "table-3-6/total-delta-v/qp-with-set-point",
            "section-3-6-1/total-delta-v/case-1-v-bar",
        )
    )
    minutes = abs(_printed(grounds, "v-bar", "time") / MINUTE - time.value)
    same = delta_v.value == text.value == _printed(grounds, "v-bar", "total-delta-v")
    return judged(
        max(worst.values()) < 1e-9 and same and minutes < time.half_unit,
        f"phases miss their totals by at most {worst['delta_v_m_s']:.0e} m/s and "
        f"{worst['time_s']:.0e} s; Case 1's row of Table 3.6 differs by {minutes:.3f} min",
    )


def times_are_whole_samples(grounds: Grounds[Configuration]) -> Judgement:
    """The printed times must be whole numbers of samples, the far range's less a second."""
    section = grounds.section
    cells = phase_cells(grounds.ledger)
    cells = cells[cells["phase"].isin(PHASES)]
    missing = {
        (row["case"], row["phase"]): -row["time_s"] % section.phases[row["phase"]]["sample_time_s"]
        for row in cells.to_dict("records")
    }
    expected = {key: FIRST_SECOND if key[1] == "far" else 0.0 for key in missing}
    steps = printed_steps(section, grounds.ledger)
    return judged(
        missing == expected,
        "steps of the far, mid and final phases: "
        + "; ".join(
            f"{case} " + ", ".join(str(steps[case, phase]) for phase in PHASES)
            for case in CASE_TABLES
        )
        + ". The second missing in every far range reads as a clock that starts with the first "
        "control, one simulation step late",
    )


def velocity_is_of_a_stable_ellipse(grounds: Grounds[Configuration]) -> Judgement:
    """Vx = n y / 2 and vy = -2 n x: an interval of the mean motion from each rounded component."""
    x, y, _, vx, vy, _ = start_state(grounds.section)
    name = "table-3-2/chaser-velocity-in-cw-frame/all-cases/x"
    half = grounds.ledger.value(name).half_unit
    from_x = sorted(2.0 * (vx + sign * half) / y for sign in (-1, 1))
    from_y = sorted(-(vy + sign * half) / (2.0 * x) for sign in (-1, 1))
    low, high = max(from_x[0], from_y[0]), min(from_x[1], from_y[1])
    ours = grounds.section.inferred.mean_motion_rad_s
    mu, radius = 398600.4418e9, 6378137.0
    heights = [((mu / n**2) ** (1 / 3) - radius) / KM for n in (high, low)]
    return judged(
        low < high and low <= ours <= high,
        f"both components give the same mean motion within their rounding, {low:.6f} to {high:.6f} "
        f"rad/s, a circular orbit {heights[0]:.0f} to {heights[1]:.0f} km high; we use {ours:.6f}",
    )


def delta_v_is_no_sum_of_plane_lengths(grounds: Grounds[Configuration]) -> Judgement:
    """Printed far ranges are compared with what so many steps can give by the length of (x, y)."""
    section = grounds.section
    bound = section.phases.far.control_bound_m_s
    steps = printed_steps(section, grounds.ledger)
    most = {case: steps[case, "far"] * np.sqrt(2.0) * bound for case in CASE_TABLES}
    printed = {case: _printed(grounds, case, "total-delta-v", "far") for case in CASE_TABLES}
    over = [case for case in CASE_TABLES if printed[case] > most[case]]
    sums = grounds.rows("readings.csv", question="delta_v").set_index("reading")["misfit"]
    return judged(
        len(over) > 0,
        "; ".join(
            f"{case}: {printed[case]:.2f} printed, at most {most[case]:.2f} m/s"
            for case in CASE_TABLES
        )
        + ". The way out of the plane adds little, so lengths are not what was summed. Of the sums "
        f"tried, '{sums.idxmin()}' fits all cells best (misfit {sums.min():.1f}, '2-norm' "
        f"{sums['2-norm']:.1f}): an inference",
    )


@over_ensemble
def truth_changes_no_step_count(grounds: Grounds) -> Judgement:
    """The cases are flown anew in the nonlinear model, by impulses as the guidance assumes them."""
    table = grounds.table("truth.csv")
    counts = {}
    for model, own in table.groupby("model"):
        changed = float((own["delta_v_m_s"] - own["delta_v_linear_m_s"]).abs().max())
        counts[model] = (int((own["steps"] == own["steps_linear"]).sum()), len(own), changed)
    same, phases, worst = counts["impulses"]
    burnt, _, most = counts["burns"]
    return judged(
        same == phases and worst <= TRUTH_DV,
        f"with impulses {same} of {phases} phases keep their number of steps, and delta-v changes "
        f"by at most {worst:.1g} m/s in a phase; with burns of the printed thruster {burnt} of "
        f"{phases} do, and delta-v changes by up to {most:.2g} m/s",
    )


@over_ensemble
def constraints_hold_between_samples(grounds: Grounds[Configuration]) -> Judgement:
    """Bounds must hold at every sample, docking speed and cone between them unless softened."""
    section = grounds.section
    flights, paths = grounds.table("flights.parquet"), grounds.table("paths.parquet")
    faces, axis = np.empty((4, 3)), np.empty(3)
    control, speed, cone = 0.0, 0.0, 0.0
    for case in CASE_TABLES:
        given = law(section, case)
        own = flights[flights["flight"] == case]
        for place, phase in enumerate(PHASES):
            changes = own[own["phase"] == phase][CHANGE].abs().to_numpy()
            if not len(changes):
                raise LookupError(f"{case} does not come to its {phase} phase")
            control = max(control, float(changes.max()) / given.control_bounds[place])
        # The first steps brake from the mid range's speed; the bound is softened there.
        late = own[(own["phase"] == "final") & (own["softened"] > 0)]["time_s"]
        start = float(late.max()) + given.sample_times[2] if len(late) else -np.inf
        path = paths[(paths["flight"] == case) & (paths["phase"] == "final")]
        path = path[path["time_s"] > start]
        if path.empty:
            raise LookupError(f"{case} keeps its constraints nowhere in the final phase")
        speed = max(speed, float(path[STATE[3:]].abs().to_numpy().max()) / given.speed_bound)
        for row in path[["time_s", *STATE[:3]]].to_numpy():
            rotated(np.array(given.axis), given.rotation_rate * row[0], axis)
            cone_faces(axis, np.tan(given.cone_angles[2]), faces)
            cone = max(cone, float(np.max(faces @ (row[1:] - given.port * axis))))
    return judged(
        control <= 1.0 + 1e-6 and speed <= 1.0 + BETWEEN_SHARE and cone <= BETWEEN_M,
        f"controls reach {100 * control:.4f} % of their bounds; once no constraint is softened any "
        f"more, docking speeds reach {100 * speed:.1f} % of theirs between samples, and the chaser "
        f"is at most {1000 * cone:.1f} mm outside the docking cone",
    )
