"""Predicates of claims on the race itself, judged on converged solutions."""

import numpy as np

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.evidence.race_tables import (
    MASSIVE,
    NOTHING,
    all_races,
    coarsest_meshes,
    complete,
    printed,
    races,
    solved,
)
from smallsat.studies.racing.methods.races import GREEDY, LISTING, WHOLE
from smallsat.studies.racing.model.course_view import (
    VIEW_AZIMUTH_DEG,
    VIEW_ELEVATION_DEG,
    crossings,
)
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

CENTRED = 1e-6  # m


def _axial(parameters: Parameters) -> CubeSat:
    """Mo of the first race, where its thrusters are axial; else a `LookupError`."""
    mo = next(c for c in parameters.races["scenario-1"].cubesats if c.name == "Mo")
    if not mo.axis_thrust:
        raise LookupError("Mo may thrust in any direction")
    return mo


def faster_with_thrust(grounds: Grounds[Configuration]) -> Judgement:
    """The optimal time must fall as the thrust grows, wherever an optimum was found."""
    sweep = grounds.table("thrust-sweep.csv")
    found = solved(sweep, f"{WHOLE} (s)").sort_values("thrust_m_s2")
    times, thrusts = found[f"{WHOLE} (s)"].to_numpy(), found["thrust_m_s2"].to_numpy()
    products = times * np.sqrt(thrusts)
    parameters = Parameters.from_section(grounds.section)
    tide = tide_at(parameters.races["scenario-1"].course.start, parameters.mean_motion)
    missing = sweep.loc[sweep[f"{WHOLE} (s)"].isna(), "thrust_m_s2"]
    text = f"; with {', '.join(f'{u:g}' for u in missing)} m/s^2 no plan was found" * bool(
        len(missing)
    )
    return judged(
        (np.diff(times) < 0.0).all(),
        f"the optimal time is {times[0]:.0f} s with {thrusts[0]:g} m/s^2 and {times[-1]:.0f} s "
        f"with {thrusts[-1]:g} m/s^2. It falls as one over the root of the thrust (their product "
        f"is {products.min():.0f} at least) until the thrust nears the tide at the start, "
        f"{tide:.2g} m/s^2, where the product is {products.max():.0f}{text}",
    )


def tide_at(place: np.ndarray, mean_motion: float) -> float:
    """Acceleration, m/s^2, of what rests at a place (3,) of the Hill frame."""
    return float(np.linalg.norm(mean_motion**2 * place * np.array([3.0, 0.0, -1.0])))


def no_thrust_is_best_for_accuracy(grounds: Grounds) -> Judgement:
    """The misses of the optimum are compared over the thrusts that the document uses."""
    sweep = solved(grounds.table("thrust-sweep.csv"), f"{WHOLE} (s)").sort_values("thrust_m_s2")
    least, most = (
        grounds.ledger.value(f"section-v/accelerations-used-in-this-project/{bound}").value
        for bound in ("min", "max")
    )
    used = complete(sweep[sweep["thrust_m_s2"].between(least, most)], f"{WHOLE} (s)")
    worst = float(used[f"{WHOLE}, residual"].max())
    multiplier = float(used["largest_ring_multiplier_s_m"].max())
    paying = sweep[sweep["largest_ring_multiplier_s_m"] >= 1.0]["thrust_m_s2"]
    text = (
        f". With {paying.max():g} m/s^2 or less it would save more than it costs: the weaker, the "
        f"less accurate, and no optimum in between"
        if len(paying)
        else ""
    )
    return judged(
        not (worst < CENTRED and multiplier < 1.0),
        f"with thrusts of {least:g} to {most:g} m/s^2 the rings are crossed at their centres, to "
        f"{worst:.0e} m, and a metre of miss would save {multiplier:.2f} s at most while it costs "
        f"1 s: the best accuracy is the same, 0, for all{text}",
    )


def mo_can_pass(grounds: Grounds[Configuration]) -> Judgement:
    """Mo's optimum within the limits of its axes, and a weaker CubeSat's, are looked at."""
    mo = _axial(Parameters.from_section(grounds.section))
    rows = races(grounds, WHOLE, "scenario-1")
    row, weaker = rows.loc["Mo"], rows.loc["Eeny"]
    crafts = Parameters.from_section(grounds.section).races["scenario-1"].cubesats
    ball = next(craft.thrust for craft in crafts if craft.name == "Eeny")
    passed = (rows.loc[["Mo", "Eeny"], ["missed", "off_axis"]] == 0).all(axis=None)
    return judged(
        not (passed and row["residual"] < CENTRED and ball <= min(mo.axis_thrust)),
        f"within the limits of each axis (Table 1) Mo crosses all {row['rings']:.0f} rings at "
        f"their centres along their normals in {row['time_s']:.1f} s. The listing's own law gives "
        f"{min(mo.axis_thrust):g} m/s^2 in every direction at least, as its length is free, "
        f" and Eeny needs {ball:g} m/s^2 to pass them all, in {weaker['time_s']:.1f} s",
    )


def mo_slower_than_meeny(grounds: Grounds[Configuration]) -> Judgement:
    """The optimal times of Mo and Meeny are compared."""
    times = all_races(grounds, WHOLE, "scenario-1")["time_s"]
    parameters = Parameters.from_section(grounds.section)
    mo = next(c for c in parameters.races["scenario-1"].cubesats if c.name == "Mo")
    return judged(
        times["Mo"] > times["Meeny"],
        f"optimally too: {times['Mo']:.1f} against {times['Meeny']:.1f} s. A sphere inside Mo's "
        f"box has {min(mo.axis_thrust or (mo.thrust,)):.4g} m/s^2 and a sphere around it "
        f"{mo.thrust:.4g} m/s^2; Meeny's lies between",
    )


def full_thrust_against_primer(grounds: Grounds) -> Judgement:
    """Thrust and primer of the optimum come from independent parts of the solution."""
    meshes = coarsest_meshes(grounds)
    # A run in which all thrusters are alike has only one of the two.
    free = complete(meshes[meshes["primer_angle_median_deg"].notna()], "time_s")
    share = float(free["full_thrust_share"].min())
    angle, largest = (float(free[f"primer_angle_{w}_deg"].max()) for w in ("median", "largest"))
    axial = complete(meshes[meshes["sign_share"].notna()], "time_s")
    return judged(
        share > 0.98 and largest < 1.0 and (axial["sign_share"] == 1.0).all(),
        f"on the optima {100 * share:.1f} % of the held pieces or more have full thrust, and it "
        f"points against the primer of the multipliers to {angle:.1e} deg in the median, "
        f"{largest:.1e} deg at most; Mo's axes have the sign that the primer asks for in every "
        f"piece. The pieces without full thrust are those in which the primer turns about",
    )


def hamiltonian_is_minus_one(grounds: Grounds) -> Judgement:
    """The Hamiltonian of the optimum must come nearer to -1 as the mesh gets finer."""
    table = complete(grounds.table("meshes.csv"), "time_s")
    found = table.groupby("intervals")["hamiltonian_error"].max()
    median = float(coarsest_meshes(grounds)["hamiltonian_median_error"].max())
    fine = table[table["intervals"] == table["intervals"].max()]
    return judged(
        found.iloc[-1] < found.iloc[0] and fine["hamiltonian_median_error"].max() < 0.01,
        f"its largest error goes from {found.iloc[0]:.1e} with {found.index[0]} held pieces a "
        f"segment to {found.iloc[-1]:.1e} with {found.index[-1]}; the median of the worst CubeSat "
        f"is {median:.1e}. With the listing's costates it is not constant, see the errata",
    )


def adjoints_jump(grounds: Grounds) -> Judgement:
    """The costates of the whole-course optimum are searched for jumps at rings."""
    largest = float(coarsest_meshes(grounds)["largest_ring_multiplier_s_m"].max())
    rows = grounds.rows("optima-scenario-1-segments.csv", solution=WHOLE, cubesat="Meeny")
    rows = complete(rows, "px")
    typical = float(np.linalg.norm(rows[["px", "py", "pz"]].to_numpy(), axis=1).mean())
    return judged(
        largest > 0.0,
        f"on the optimum too: a ring is a constraint inside the problem, and the position adjoints "
        f"jump there by up to {largest:.2f} s/m; Meeny's are {typical:.2f} s/m on average",
    )


def not_smooth(grounds: Grounds[Configuration]) -> Judgement:
    """The problem is looked at where it has a kink or a jump: a miss of zero, and Mo's thrust."""
    mo = _axial(Parameters.from_section(grounds.section))
    jump = mo.thrust - float(np.linalg.norm(mo.axis_thrust[:2]))
    worst = float(all_races(grounds, WHOLE, "scenario-1")["accuracy_m"].max())
    return judged(
        worst > CENTRED,
        f"the miss |r - r_ring| has its kink at zero, and that is where the optimum lies "
        f"({worst:.0e} m summed over a course); Mo's thrust jumps by {jump:.3f} m/s^2 or more "
        f"where a primer component crosses the deadzone",
    )


def minimum_cost_is_no_bound_of_the_race(grounds: Grounds) -> Judgement:
    """The formula is taken along three paths of the same CubeSat on the same course."""
    texts, spread = [], []
    theirs = printed(grounds, "scenario-1")["minimum_cost_s"].to_dict()
    for name in ("Eeny", "Meeny", "Miny"):
        values = [
            float(races(grounds, solution, "scenario-1")["minimum_cost_s"].to_dict()[name])
            for solution in (WHOLE, GREEDY, LISTING)
        ]
        values.append(theirs[name])
        spread.append(max(values) / min(values) - 1.0)
        texts.append(f"{name} {', '.join(f'{value:.0f}' for value in values)}")
    return judged(
        max(spread) < NOTHING,
        f"it depends on the path, as it starts from the speed at which each ring was crossed: "
        f"whole course, segment by segment, our solve of the listing, printed: {'; '.join(texts)} "
        f"s. The better path may have the larger one, so it bounds no race",
    )


def start_positions_hardly_matter(grounds: Grounds) -> Judgement:
    """Optimal times are compared that start at random places of Scenario 2."""
    table = complete(grounds.table("random-positions.csv"), "time_s")
    times = table["time_s"]
    spread = float(times.max() - times.min())
    return judged(
        spread > MASSIVE * float(times.mean()),
        f"from {len(table)} random places the optimal times lie within {spread:.3f} s of each "
        f"other, {100 * spread / times.mean():.1g} % of {times.mean():.1f} s, all with accuracy "
        f"0. The printed differences are those of solves that ended elsewhere",
    )


def potential_is_equal(grounds: Grounds) -> Judgement:
    """The optimal times of the four CubeSats of Scenario 2 say who has the potential."""
    times = all_races(grounds, WHOLE, "scenario-2")["time_s"].sort_values()
    return Judgement(
        "holds" if times.index[0] == "Mo" else "fails",
        f"by the optimum Mo has it, and by next to nothing: "
        f"{', '.join(f'{name} {value:.3f}' for name, value in times.items())} s. The reason "
        f"given, its lowest minimum possible cost, is no measure of that",
    )


def whole_course_remedies(grounds: Grounds) -> Judgement:
    """A course solved as a whole is compared with one solved segment by segment."""
    texts, better = [], []
    for scenario in ("scenario-1", "scenario-2"):
        whole = all_races(grounds, WHOLE, scenario)
        greedy = all_races(grounds, GREEDY, scenario)["time_s"]
        gain = 100.0 * (1.0 - whole["time_s"] / greedy)
        better.append(bool((gain > 0.0).all() and (whole["off_axis"] == 0).all()))
        texts.append(f"{gain.min():.1f} to {gain.max():.1f} %")
    return judged(
        all(better),
        f"with all rings in one problem every ring is crossed along its normal, and the times are "
        f"shorter than segment by segment by {texts[0]} in Scenario 1 and {texts[1]} in Scenario "
        f"2. For the direction alone it is not needed: well posed, single segments keep it too",
    )


def second_course_loops_back(grounds: Grounds[Configuration]) -> Judgement:
    """Seen as the document draws them, the second course must cross itself, and not the first."""
    parameters = Parameters.from_section(grounds.section)
    counts, nearest = {}, {}
    for name, race in parameters.races.items():
        counts[name] = crossings(race.course, VIEW_AZIMUTH_DEG, VIEW_ELEVATION_DEG)
        path = np.vstack([race.course.start, race.course.centres, race.course.end])
        apart = np.linalg.norm(path[:, None] - path[None], axis=2)
        nearest[name] = float(apart[np.triu_indices(len(path), 3)].min())
    return judged(
        counts["scenario-1"] == 0 < counts["scenario-2"],
        f"seen as the document draws them ({VIEW_AZIMUTH_DEG:g}, {VIEW_ELEVATION_DEG:g} deg) the "
        f"second course crosses its own line {counts['scenario-2']} times and the first "
        f"{counts['scenario-1']} times. In space the first comes nearer to itself: within "
        f"{nearest['scenario-1']:.0f} m of a ring three or more before, the second within "
        f"{nearest['scenario-2']:.0f} m",
    )


def racing_is_viable(grounds: Grounds) -> Judgement:
    """Plans must exist that pass every ring, for every CubeSat; and what they cost."""
    whole = grounds.rows("races.csv", solution=WHOLE)
    complete(whole, "time_s")
    table = solved(grounds.table("propellant.csv"), "delta_v_m_s")
    own = table[table["cubesat"] != "any"]
    slow = table[table["cubesat"] == "any"].sort_values("thrust_m_s2").iloc[0]
    passed = (whole["missed"] == 0).all() and (whole["off_axis"] == 0).all()
    return judged(
        passed and whole["residual"].max() < CENTRED,
        f"given thrust as the document assumes it: all {len(whole)} CubeSats can pass every ring "
        f"of their course along its normal. That takes {own['delta_v_m_s'].min():.0f} to "
        f"{own['delta_v_m_s'].max():.0f} m/s, or {own['cold_gas_pct'].min():.0f} to "
        f"{own['cold_gas_pct'].max():.0f} % of the mass as cold gas, "
        f"{own['monopropellant_pct'].min():.0f} to {own['monopropellant_pct'].max():.0f} % as "
        f"monopropellant and {own['field_emission_pct'].min():.1f} to "
        f"{own['field_emission_pct'].max():.1f} % by field emission, whose jet then has "
        f"{own['field_emission_w_kg'].min():.0f} to {own['field_emission_w_kg'].max():.0f} W for "
        f"each kilogram. The least thrust with a plan, {slow['thrust_m_s2']:g} m/s^2, takes "
        f"{slow['time_s'] / 3600:.1f} h, {slow['delta_v_m_s']:.0f} m/s and "
        f"{slow['field_emission_w_kg']:.0f} W/kg. The specific impulses are typical ones of ours",
    )
