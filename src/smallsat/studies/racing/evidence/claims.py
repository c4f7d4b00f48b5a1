"""Predicates of the document's prose claims."""

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.evidence.observations import MILLI
from smallsat.studies.racing.evidence.scores import CUBESATS, printed_scores
from smallsat.studies.racing.methods.races import ANYWHERE, AS_PUBLISHED, GREEDY, INDIRECT, WHOLE
from smallsat.studies.racing.methods.recovery import start_positions
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.parameters import Parameters

CENTRED = 1e-6  # m
AGREES = 0.05  # s
# Changes of a result that a reader would call massive, and none, as shares.
MASSIVE, NOTHING = 0.1, 0.001


def _races(grounds: Grounds, solution: str, scenario: str) -> pd.DataFrame:
    """Races of one kind by CubeSat; those without a solution are not among them."""
    rows = grounds.rows("races.csv", solution=solution, scenario=scenario)
    return rows[rows["time_s"].notna()].set_index("cubesat")


def _all_races(grounds: Grounds, solution: str, scenario: str) -> pd.DataFrame:
    """`_races` for a claim that speaks of all CubeSats; a `LookupError` where one is missing."""
    return _races(grounds, solution, scenario).loc[list(CUBESATS)]


def _printed(grounds: Grounds, scenario: str) -> pd.DataFrame:
    """The printed scores of a race by CubeSat."""
    table = printed_scores(grounds.ledger)
    return table[table["scenario"] == scenario].set_index("cubesat")


def _complete(table: pd.DataFrame, *columns: str) -> pd.DataFrame:
    """The table itself; a `LookupError` where a number in these columns is missing."""
    if table.empty or table[list(columns)].isna().any(axis=None):
        raise LookupError("a case without a solution")
    return table


def _meshes(grounds: Grounds) -> pd.DataFrame:
    table = _complete(grounds.table("meshes.csv"), "time_s")
    return table[table["intervals"] == table["intervals"].min()]


def _axial(parameters: Parameters) -> CubeSat:
    """Mo of the first race, where its thrusters are axial; else a `LookupError`."""
    mo = next(c for c in parameters.races["scenario-1"].cubesats if c.name == "Mo")
    if not mo.axis_thrust:
        raise LookupError("Mo may thrust in any direction")
    return mo


def faster_with_thrust(grounds: Grounds) -> Judgement:
    """The optimal time must fall as the thrust grows."""
    sweep = _complete(grounds.table("thrust-sweep.csv"), f"{WHOLE} (s)")
    sweep = sweep.sort_values("thrust_m_s2")
    times = sweep[f"{WHOLE} (s)"].to_numpy()
    products = times * np.sqrt(sweep["thrust_m_s2"].to_numpy())
    return judged(
        (np.diff(times) < 0.0).all(),
        f"the optimal time falls as one over the root of the thrust: their product is "
        f"{products.min():.0f} to {products.max():.0f} over thrusts from "
        f"{sweep['thrust_m_s2'].min():g} to {sweep['thrust_m_s2'].max():g} m/s^2",
    )


def no_thrust_is_best_for_accuracy(grounds: Grounds) -> Judgement:
    """The misses of the optimum are compared over thrusts."""
    sweep = _complete(grounds.table("thrust-sweep.csv"), f"{WHOLE} (s)")
    worst = float(sweep[f"{WHOLE}, residual"].max())
    multiplier = float(sweep["largest_ring_multiplier_s_m"].max())
    return judged(
        not (worst < CENTRED and multiplier < 1.0),
        f"with every thrust tried the rings are crossed at their centres, to {worst:.0e} m, and a "
        f"metre of miss would save {multiplier:.2f} s at most while it costs 1 s: the best "
        f"accuracy is the same, 0, for all. What the document compares is how its solves ended",
    )


def mo_can_pass(grounds: Grounds) -> Judgement:
    """Mo's optimum, each axis within its own limit, is looked at for missed rings."""
    row = _races(grounds, WHOLE, "scenario-1").loc["Mo"]
    passed = row["missed"] == 0 and row["off_axis"] == 0 and row["residual"] < CENTRED
    return judged(
        not passed,
        f"with each axis limited by itself Mo crosses all {row['rings']:.0f} rings at their "
        f"centres along their normals in {row['time_s']:.1f} s",
    )


def mo_slower_than_meeny(grounds: Grounds[Configuration]) -> Judgement:
    """The optimal times of Mo and Meeny are compared."""
    races = _all_races(grounds, WHOLE, "scenario-1")["time_s"]
    parameters = Parameters.from_section(grounds.section)
    mo = next(c for c in parameters.races["scenario-1"].cubesats if c.name == "Mo")
    return judged(
        races["Mo"] > races["Meeny"],
        f"optimally too: {races['Mo']:.1f} against {races['Meeny']:.1f} s. A sphere inside Mo's "
        f"box has {min(mo.axis_thrust or (mo.thrust,)):.4g} m/s^2 and a sphere around it "
        f"{mo.thrust:.4g} m/s^2; Meeny's lies between",
    )


def direction_is_the_trouble(grounds: Grounds) -> Judgement:
    """Rings are counted that our solve of the listings misses or crosses off their normals."""
    rows = grounds.rows("races.csv", solution=AS_PUBLISHED)
    rings = rows["rings"].sum()
    return judged(
        rows["off_axis"].sum() > rows["missed"].sum(),
        f"in our solve of the listings {rows['off_axis'].sum()} of {rings} crossings are off the "
        f"normal by more than a degree, and {rows['missed'].sum()} rings are missed. The document "
        f"prints only sums; by them its solves came closer to the rings than ours",
    )


def full_thrust_against_primer(grounds: Grounds) -> Judgement:
    """Thrust and primer of the optimum come from independent parts of the solution."""
    meshes = _meshes(grounds)
    # A run in which all thrusters are alike has only one of the two.
    free = _complete(meshes[meshes["primer_angle_median_deg"].notna()], "time_s")
    share = float(free["full_thrust_share"].min())
    angle, largest = (float(free[f"primer_angle_{w}_deg"].max()) for w in ("median", "largest"))
    axial = _complete(meshes[meshes["sign_share"].notna()], "time_s")
    return judged(
        share > 0.98 and largest < 1.0 and (axial["sign_share"] == 1.0).all(),
        f"on the optima {100 * share:.1f} % of the held pieces or more have full thrust, and it "
        f"points against the primer of the multipliers to {angle:.1e} deg in the median, "
        f"{largest:.1e} deg at most; Mo's axes have the sign that the primer asks for in every "
        f"piece. The pieces without full thrust are those in which the primer turns about",
    )


def hamiltonian_is_minus_one(grounds: Grounds) -> Judgement:
    """The Hamiltonian of the optimum must come nearer to -1 as the mesh gets finer."""
    table = _complete(grounds.table("meshes.csv"), "time_s")
    found = table.groupby("intervals")["hamiltonian_error"].max()
    median = float(_meshes(grounds)["hamiltonian_median_error"].max())
    fine = table[table["intervals"] == table["intervals"].max()]
    return judged(
        found.iloc[-1] < found.iloc[0] and fine["hamiltonian_median_error"].max() < 0.01,
        f"its largest error goes from {found.iloc[0]:.1e} with {found.index[0]} held pieces a "
        f"segment to {found.iloc[-1]:.1e} with {found.index[-1]}; the median of the worst CubeSat "
        f"is {median:.1e}. With the listing's costates it is not constant, see the errata",
    )


def adjoints_jump(grounds: Grounds) -> Judgement:
    """The costates of the whole-course optimum are searched for jumps at rings."""
    largest = float(_meshes(grounds)["largest_ring_multiplier_s_m"].max())
    rows = grounds.rows("optima-scenario-1-segments.csv", solution=WHOLE, cubesat="Meeny")
    rows = _complete(rows, "px")
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
    worst = float(_all_races(grounds, WHOLE, "scenario-1")["accuracy_m"].max())
    return judged(
        worst > CENTRED,
        f"the miss |r - r_ring| has its kink at zero, and that is where the optimum lies "
        f"({worst:.0e} m summed over a course); Mo's thrust jumps by {jump:.3f} m/s^2 or more "
        f"where a primer component crosses the deadzone",
    )


def transversality_left_out(grounds: Grounds) -> Judgement:
    """Eq. 22 asks for a primer across the ring's normal; the listing does not."""
    ours = _primer_at_rings(grounds, "optima", GREEDY)
    theirs = _primer_at_rings(grounds, "as-published", AS_PUBLISHED)
    return judged(
        not (ours < 0.05 and theirs > 0.1),
        f"Eq. 22 makes the primer vanish along the normal at a ring. Its component there has a "
        f"median share of {ours:.1e} on our segments, and {theirs:.2f} in the solve of the "
        f"listing, which never asks for it; without it seven unknowns stay undetermined",
    )


def _primer_at_rings(grounds: Grounds, stem: str, solution: str) -> float:
    """Median share of the primer along the normal at the end of Meeny's segments in Scenario 1."""
    name = f"{stem}-scenario-1-trajectories.parquet"
    rows = _complete(grounds.rows(name, solution=solution, cubesat="Meeny"), "pvx")
    course = grounds.table("course-scenario-1.csv")
    normals = course[["nx", "ny", "nz"]].to_numpy(dtype=float)[1:-1]
    last = rows.groupby("segment").last()[["pvx", "pvy", "pvz"]].to_numpy()[: len(normals)]
    largest = (
        rows.groupby("segment")[["pvx", "pvy", "pvz"]]
        .apply(lambda p: float(np.linalg.norm(p.to_numpy(), axis=1).max()))
        .to_numpy()[: len(normals)]
    )
    return float(np.median(np.abs(np.sum(last * normals, axis=1)) / largest))


def guess_is_ten_times_that(grounds: Grounds[Configuration]) -> Judgement:
    """Line 66 of Listing C.C guesses a multiple of the time that the text names."""
    multiple = grounds.section.as_published.duration_multiple
    return judged(
        multiple == 1.0,
        f"the listing guesses {multiple:g} times that time; and the adjoints, which the text "
        f"carries over from the segment before, it makes anew from directions",
    )


def minimum_cost_is_no_bound_of_the_race(grounds: Grounds) -> Judgement:
    """The formula is taken along three paths of the same CubeSat on the same course."""
    texts, spread = [], []
    printed = _printed(grounds, "scenario-1")["minimum_cost_s"].to_dict()
    for name in ("Eeny", "Meeny", "Miny"):
        values = [
            float(_races(grounds, solution, "scenario-1")["minimum_cost_s"].to_dict()[name])
            for solution in (WHOLE, GREEDY, AS_PUBLISHED)
        ]
        values.append(printed[name])
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
    table = _complete(grounds.table("random-positions.csv"), "time_s")
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
    times = _all_races(grounds, WHOLE, "scenario-2")["time_s"].sort_values()
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
        whole = _all_races(grounds, WHOLE, scenario)
        greedy = _all_races(grounds, GREEDY, scenario)["time_s"]
        gain = 100.0 * (1.0 - whole["time_s"] / greedy)
        better.append(bool((gain > 0.0).all() and (whole["off_axis"] == 0).all()))
        texts.append(f"{gain.min():.1f} to {gain.max():.1f} %")
    return judged(
        all(better),
        f"with all rings in one problem every ring is crossed along its normal, and the times are "
        f"shorter than segment by segment by {texts[0]} in Scenario 1 and {texts[1]} in Scenario "
        f"2. For the direction alone it is not needed: well posed, single segments keep it too",
    )


def thousand_times(grounds: Grounds) -> Judgement:
    """The printed accelerations are divided by those of commercial thrusters."""
    used, commercial = (
        np.array(grounds.ledger.values(f"section-v/{place}"), dtype=float)
        for place in (
            "accelerations-used-in-this-project",
            "equivalent-acceleration-of-commercial-thrusters/1-kg-1u",
        )
    )
    ratios = used / (MILLI * commercial)
    factor = "section-v/factor-by-which-commercial-thrust-is-below-this-project"
    return judged(
        grounds.ledger.value(factor).matches(ratios[1]),
        f"{ratios[1]:.0f} times for the largest values of both ranges, {ratios[0]:.0f} times for "
        f"the smallest",
    )


def cost_is_time_plus_accuracy(grounds: Grounds) -> Judgement:
    """Time and accuracy of every printed row must add up to its cost."""
    table = printed_scores(grounds.ledger)
    errors = (table["cost"] - table["time_s"] - table["accuracy_m"]).abs()
    # Two printed values are rounded, and so is their sum.
    half_unit = grounds.ledger.value("table-2/final-overall-cost/scenario-1-eeny").half_unit
    return judged(
        errors.max() <= 3.0 * half_unit,
        f"in all {len(errors)} rows, to {errors.max():.3f} at most, which is rounding",
    )


def printed_runs_missed(grounds: Grounds[Configuration]) -> Judgement:
    """The sum of the smaller axes is the most that misses can add up to without a ring missed."""
    parameters = Parameters.from_section(grounds.section)
    limits = {name: float(race.course.sizes.sum()) for name, race in parameters.races.items()}
    missed = [
        f"{row['cubesat']} {row['accuracy_m']:.1f} m (Scenario {row['scenario'][-1]})"
        for row in printed_scores(grounds.ledger).to_dict("records")
        if row["accuracy_m"] > limits[row["scenario"]]
    ]
    return judged(
        len(missed) == 5,
        f"the smaller axes add up to {limits['scenario-1']:.2f} m and {limits['scenario-2']:.2f} "
        f"m; "
        f"the printed accuracies above that: {', '.join(missed)}. Of the others nothing is proven",
    )


def scenario_2_recovered(grounds: Grounds[Configuration]) -> Judgement:
    """The start positions of the seed, and of every other day, are compared with Table 3."""
    parameters = Parameters.from_section(grounds.section)
    seed = grounds.section.scenarios.scenario_2.seed
    race = parameters.races["scenario-2"]
    rings, places = start_positions(parameters, seed, len(race.cubesats))
    printed = np.array([cubesat.position for cubesat in race.cubesats])
    error = np.abs(places - printed)[:, [0, 2]]
    days = grounds.table("days-as-seeds.csv")
    day = days[days["seed"] == seed]
    if day.empty:
        raise LookupError("the seed is the number of no day of these years")
    others = days.loc[days["seed"] != seed, "largest_difference_m"].replace(np.inf, np.nan)
    along = abs(float(places[0, 1] - printed[0, 1]))
    half_unit = grounds.ledger.value("table-3/initial-position/scenario-2-eeny/x").half_unit
    to_digit = int((error <= half_unit).sum())
    return judged(
        to_digit >= 7 and along <= 0.5 and len(day) == 1 and others.min() > 100.0,
        f"seed {seed}, the serial number of {day['day'].iloc[0]}, gives {rings} rings, the printed "
        f"start along the track, and {to_digit} of 8 printed x and z to the digit, the last one "
        f"within "
        f"{error.max():.3f} m; the next of {len(days)} days is {others.min():.0f} m off. That the "
        f"shuffle took the day is an inference; that the course is this one rests on the digits",
    )


def published_solve_is_erratic(grounds: Grounds) -> Judgement:
    """The document's solve is repeated with one thing changed, which ought not to matter."""
    table = grounds.table("variants.csv")
    costs = table["cost"]
    text = "; ".join(
        f"{row['variant']}: cost {row['cost']:.0f}, {row['missed']} missed, "
        f"{row['not_converged']} of {row['segments']} segments unconverged"
        for row in table.to_dict("records")
    )
    return judged(
        # By how much is up to the last bits of every step, so that no ratio can be asked for.
        costs.max() > (1.0 + MASSIVE) * costs.min() and (table["not_converged"] > 0).all(),
        f"Meeny, Scenario 1: {text}",
    )


def penalty_is_exact(grounds: Grounds) -> Judgement:
    """The largest multiplier of a ring's centre is compared with the weight of a miss."""
    table = _meshes(grounds)
    meshes = table["largest_ring_multiplier_s_m"]
    first = zip(table["cubesat"][:4], meshes[:4], strict=True)
    text = ", ".join(f"{name} {value:.3f}" for name, value in first)
    return judged(
        (meshes < 1.0).all(),
        f"what a metre off a ring's centre could save is its multiplier, at most "
        f"{meshes.max():.3f} s "
        f"over both scenarios ({text} in Scenario 1), and it costs 1 s: locally no miss pays",
    )


def optimum_is_confirmed(grounds: Grounds) -> Judgement:
    """The optimum must stand up to other flights, starts and meshes, and to dynamic programming."""
    races = grounds.table("races.csv")
    ours = races[races["solution"].isin((WHOLE, ANYWHERE, GREEDY))]
    _complete(ours, "time_s")
    starts = grounds.table("other-starts.csv")
    _complete(starts[starts["converged"]], "time_s")
    spread = starts[starts["converged"]].groupby(["scenario", "cubesat"])["time_s"]
    apart = float((spread.max() - spread.min()).max())
    meshes = _complete(grounds.table("meshes.csv"), "time_s")
    change = meshes.groupby(["scenario", "cubesat"])["time_s"].agg(
        lambda t: (t.iloc[0] - t.iloc[-1]) / t.iloc[0]
    )
    dp = _complete(grounds.table("dynamic-programming.csv"), "time_s").iloc[-1]
    name, scenario = dp["cubesat"], dp["scenario"]
    whole = float(_races(grounds, WHOLE, scenario).loc[name, "time_s"])
    indirect = _complete(grounds.rows("races.csv", solution=INDIRECT), "rings")
    return judged(
        (ours["not_converged"] == 0).all()
        and ours["residual"].max() < CENTRED
        and apart < AGREES
        and meshes["converged"].all()
        and change.between(0.0, 0.01).all()
        and -1e-6 < dp["time_s"] - whole < AGREES,
        f"all {len(ours)} direct races converged, and flown anew they miss by "
        f"{ours['residual'].max():.0e} at most; {int(starts['converged'].sum())} of {len(starts)} "
        f"random guesses converge, to times within {max(apart, 1e-12):.0e} s; "
        f"{int(meshes['converged'].sum())} of {len(meshes)} solves on meshes of up to "
        f"{meshes['intervals'].max()} pieces converge, the finer ones shorten the times by "
        f"{100 * change.max():.2f} % at most; dynamic programming over {name}'s ring speeds gives "
        f"{dp['time_s']:.3f} s against {whole:.3f} s; of the {int(indirect['segments'].sum())} "
        f"segments of the indirect method {int(indirect['not_converged'].sum())} do not converge",
    )


def published_among_random(grounds: Grounds) -> Judgement:
    """Printed times of Scenario 2 among optimal times of random courses with as many rings."""
    own = grounds.rows("random-courses.csv", rule="generator")
    times = _complete(own[own["time_s"].notna()], "time_s")["time_s"]
    ours = float(_all_races(grounds, WHOLE, "scenario-2")["time_s"].mean())
    ranks = {
        name: 100.0 * float((times < printed).mean())
        for name, printed in _printed(grounds, "scenario-2")["time_s"].items()
    }
    place = 100.0 * float((times < ours).mean())
    return judged(
        sum(rank > 50.0 for rank in ranks.values()) == len(ranks),
        f"{len(times)} of {len(own)} random courses solved: {times.mean():.1f} s on average, "
        f"standard deviation {times.std():.1f} s. The printed times, misses not counted, are "
        f"longer than {', '.join(f'{rank:.1f} % ({name})' for name, rank in ranks.items())} of "
        f"them; the optimum of the course itself, {ours:.1f} s, is longer than {place:.0f} %",
    )
