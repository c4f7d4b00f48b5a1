"""Predicates of claims on how the document solves its segments.

Its solves stand in figures only. What is judged is the listing, and our own solves of the problem
that the listing states; they end as unconverged as the author feared of his, and none of their
numbers stands for a printed one.
"""

import numpy as np
import pandas as pd
from scipy.linalg import expm
from scipy.stats import mannwhitneyu

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.evidence.race_tables import MASSIVE, complete, primer_at_rings
from smallsat.studies.racing.methods import listing
from smallsat.studies.racing.methods.flight import COSTATE, THRUST
from smallsat.studies.racing.methods.listing_races import (
    AS_LISTED,
    DIRECT_GUESS,
    MENDED,
    MENDED_DIRECT_GUESS,
    targets,
)
from smallsat.studies.racing.methods.races import ANYWHERE, GREEDY, INDIRECT, LISTING
from smallsat.studies.racing.methods.simple_guesses import DIRECT, PREVIOUS
from smallsat.studies.racing.model.shooting import costate_matrix, law_of
from smallsat.studies.racing.parameters import Parameters

# A path is smooth that follows a linear law of constant coefficients to this share of its size.
SMOOTH = 1e-6
# Primers at a ring count as across its normal, and as not, below and above these shares.
ACROSS, ALONG = 0.05, 0.1
# Adjoints vanish below this share of their largest.
VANISHING = 1e-3
# Singular values below this share of the largest count as zero; steps of the differences.
RANK, STEP, FLIGHT = 1e-5, 1e-4, 1e-13
# How likely a difference in ranks may be by chance that still tells something.
BY_CHANCE = 0.01


def _paths(grounds: Grounds) -> pd.DataFrame:
    """Our solves of the listing in Scenario 1."""
    return grounds.rows("listing-scenario-1-trajectories.parquet", solution=LISTING)


def departure_from_law(paths: pd.DataFrame, mean_motion: float) -> float:
    """Largest difference of costates from ``exp(M t) p_0`` in a segment, as a share of their size.

    The paths are those of the listing, integrated step by step with its matrix.
    """
    matrix, worst = costate_matrix(mean_motion, transposed=False), 0.0
    # In units of the orbit, so that both halves weigh alike.
    scale = np.r_[np.full(3, 1.0 / mean_motion), np.ones(3)]
    for _, rows in paths.groupby(["cubesat", "segment"]):
        costates, times = rows[COSTATE].to_numpy(), rows["time_s"].to_numpy()
        # The points of a segment are equally far apart.
        step, law = expm(matrix * (times[1] - times[0])), np.empty_like(costates)
        law[0] = costates[0]
        for k in range(1, len(law)):
            law[k] = step @ law[k - 1]
        sizes = np.linalg.norm(law * scale, axis=1)
        worst = max(worst, float(np.abs((costates - law) * scale).max() / sizes.max()))
    return worst


def adjoints_are_smooth(grounds: Grounds[Configuration]) -> Judgement:
    """The integrated costates must follow the exponential of a constant matrix in every segment."""
    paths = _paths(grounds)
    worst = departure_from_law(paths, Parameters.from_section(grounds.section).mean_motion)
    return judged(
        worst < SMOOTH,
        f"in all {paths.groupby(['cubesat', 'segment']).ngroups} segments of our solve of the "
        f"listing the integrated adjoints follow the exponential of a constant matrix to "
        f"{worst:.0e}",
    )


def control_varies_wildly(grounds: Grounds[Configuration]) -> Judgement:
    """Each axis of thrust must swing by the limit a segment on average; primers must be smooth.

    The average is over the segments of all CubeSats: that of a single one hangs on where its solves
    happen to end.
    """
    parameters, paths = Parameters.from_section(grounds.section), _paths(grounds)
    limits = {craft.name: craft.thrust for craft in parameters.races["scenario-1"].cubesats}
    moved = np.zeros(len(THRUST))
    for name, rows in paths.groupby("cubesat"):
        moved += (rows[THRUST].diff().abs().sum() / limits[str(name)]).to_numpy()
    axes = moved / len(paths.groupby(["cubesat", "segment"]))
    worst = departure_from_law(paths, parameters.mean_motion)
    return judged(
        axes.min() > 1.0 and worst < SMOOTH,
        f"in our solve of the listing each axis of the thrust moves by {axes.min():.1f} to "
        f"{axes.max():.1f} times the limit in a segment on average, while the primer follows "
        f"its linear law to {worst:.0e}. The document's own paths stand in figures only",
    )


def thrust_is_forced_to_zero(grounds: Grounds[Configuration]) -> Judgement:
    """Mo's thrust must vanish for a while in one of our solves of the listing at least."""
    rows = grounds.rows("without-thrust.csv", cubesat="Mo")
    idle = rows[rows["without_thrust_s"] > 0.0]
    return judged(
        not idle.empty,
        f"in {len(idle)} of {len(rows)} solves of the listing, on flights that differ in rounding "
        f"alone, no component of Mo's primer is above the deadzone for a while: up to "
        f"{rows['without_thrust_s'].max():.0f} s in up to {rows['segments_without_thrust'].max()} "
        f"of {rows['segments'].max()} segments",
    )


def direction_is_the_trouble(grounds: Grounds) -> Judgement:
    """Most crossings of our solve of the listing must be off the normal."""
    rows = complete(grounds.rows("races.csv", solution=LISTING), "off_axis")
    off, rings = rows["off_axis"].sum(), rows["rings"].sum()
    return judged(
        off > rings / 2,
        f"in our solve of the listing {off:.0f} of {rings:.0f} crossings are off the normal by "
        f"more than a degree. The document's own stand in figures only",
    )


def seven_numbers_suffice(grounds: Grounds) -> Judgement:
    """The indirect method finds segments by the initial costates and the duration alone."""
    rows = grounds.rows("races.csv", solution=INDIRECT)
    segments, failed = rows["segments"].sum(), rows["not_converged"].sum()
    return judged(
        listing.UNKNOWNS == 7 and failed == 0,
        f"with these {listing.UNKNOWNS} unknowns, and the conditions of Section II.B, "
        f"{segments - failed:.0f} of {segments:.0f} segments are solved",
    )


def transversality_left_to_the_cost(grounds: Grounds) -> Judgement:
    """Eq. 22 asks for a primer across the ring's normal; the listing leaves that to the cost."""
    ours = primer_at_rings(grounds, "optima", GREEDY)
    theirs = primer_at_rings(grounds, "listing", LISTING)
    return judged(
        ours < ACROSS and theirs > ALONG,
        f"by Eq. 22 the primer has no component along the normal at a ring. Its median share there "
        f"is {ours:.1e} on our converged segments and {theirs:.2f} in our solve of the listing, "
        f"whose constraints do not ask for it: only the least cost would bring it about",
    )


def position_adjoints_vanish_at_rest(grounds: Grounds) -> Judgement:
    """The position adjoints at the end of an optimum that comes to rest anywhere."""
    name = "optima-scenario-1-trajectories.parquet"
    rows = complete(grounds.rows(name, solution=ANYWHERE), "px")
    shares = []
    for _, path in rows.groupby("cubesat"):
        sizes = np.linalg.norm(path[path["segment"] == path["segment"].max()][COSTATE[:3]], axis=1)
        whole = np.linalg.norm(path[COSTATE[:3]], axis=1)
        shares.append(float(sizes[-1] / whole.max()))
    return judged(
        max(shares) < VANISHING,
        f"where the last place is free its adjoints are zero: {max(shares):.0e} of their largest "
        f"on our optima. Section II.B derives final adjoints for the problems with a ring only, "
        f"and the listing leaves this one to the cost as well",
    )


def guess_is_ten_times_that(grounds: Grounds[Configuration]) -> Judgement:
    """Line 66 of Listing C.C guesses a multiple of the time that the text names."""
    multiple = grounds.section.listing.duration_multiple
    return judged(
        multiple == 1.0,
        f"the listing guesses {multiple:g} times that time, judged on its line alone",
    )


def _guess_helps(grounds: Grounds, column: str, without: str, with_guess: str) -> Judgement:
    """Whether the direct method's costates as guess lower a number by more than rounding moves it.

    They do where the solves with them have less than those without, by Mann and Whitney's test of
    their ranks; they do not where the median is no lower.
    """
    before, after = (
        grounds.rows("variants.csv", variant=name)[column] for name in (without, with_guess)
    )
    if len(before) < 2:
        raise LookupError("no other tolerance")
    text = (
        f"{before.min()} to {before.max()} with the listing's guess on {len(before)} flights that "
        f"differ in rounding alone, {after.min()} to {after.max()} with the direct method's "
        f"costates on the same"
    )
    if mannwhitneyu(after, before, alternative="less").pvalue < BY_CHANCE:
        return Judgement("holds", text)
    return Judgement("undecided" if after.median() < before.median() else "fails", text)


def guess_alone_is_a_cause(grounds: Grounds) -> Judgement:
    """Crossings off the normal in our solve of the listing, by the guess and nothing else."""
    found = _guess_helps(grounds, "off_axis", AS_LISTED, DIRECT_GUESS)
    return Judgement(
        found.outcome,
        f"Meeny's crossings off the normal, the slips still being there: {found.evidence}",
    )


def guess_is_a_cause(grounds: Grounds) -> Judgement:
    """The same with the listing's slips mended; and the well-posed system from such costates."""
    found = _guess_helps(grounds, "off_axis", MENDED, MENDED_DIRECT_GUESS)
    indirect = grounds.rows("races.csv", solution=INDIRECT)
    return Judgement(
        found.outcome,
        f"Meeny's crossings off the normal with both slips mended: {found.evidence}. From such "
        f"costates the well-posed indirect method solves "
        f"{(indirect['segments'] - indirect['not_converged']).sum()} of "
        f"{indirect['segments'].sum()} segments",
    )


def guess_explains_run_time(grounds: Grounds) -> Judgement:
    """Evaluations of our solve of the listing, by the guess and nothing else."""
    found = _guess_helps(grounds, "iterations", AS_LISTED, DIRECT_GUESS)
    return Judgement(
        found.outcome,
        f"evaluations of all Meeny's segments: {found.evidence}. Two flights to twelve digits "
        f"in each make the listing slow in any case",
    )


def no_easy_guess(grounds: Grounds) -> Judgement:
    """Neither simple guess may lead the indirect method to most segments."""
    table = grounds.table("simple-guesses.csv")
    share = table.groupby("guess", sort=False)["converged"].agg(["sum", "size"])
    simple = share.drop(index=DIRECT)
    texts = [f"{row['sum']} of {row['size']} from the {name}" for name, row in share.iterrows()]
    return judged(
        (simple["sum"] < simple["size"] / 2).all(),
        f"Meeny's segments that the well-posed indirect method solves: {', '.join(texts)}. The "
        f"directions are those of the listing; the previous segment is the author's own best "
        f"attempt, easy though not analytical, and his listing does not use it",
    )


def previous_adjoints_are_far_off(grounds: Grounds) -> Judgement:
    """Final adjoints of a segment against the initial ones of the next: size and sign."""
    rows = grounds.rows("simple-guesses.csv", guess=PREVIOUS)
    sizes, angles = rows["size_against_right"], rows["angle_to_right_deg"]
    far = np.maximum(sizes, 1.0 / sizes)
    return judged(
        far.max() > 10.0 and (angles > 90.0).any(),
        f"on Meeny's segments the primer at the end of one is {sizes.min():.2g} to "
        f"{sizes.max():.2g} times as large as at the beginning of the next, and more than 90 deg "
        f"away from it in {(angles > 90.0).sum()} of {len(rows)}",
    )


def listing_stays_unconverged(grounds: Grounds) -> Judgement:
    """No variant of our solve may converge, and small changes must change its end."""
    table = grounds.table("variants.csv")
    flights = table[table["variant"] == AS_LISTED]
    text = "; ".join(
        f"flights to {row['tolerance']:g}: time {row['time_s']:.0f} s, misses "
        f"{row['accuracy_m']:.0f} m, {row['not_converged']} of {row['segments']} segments "
        f"unconverged"
        for row in flights.to_dict("records")
    )
    if len(flights) < 2:
        raise LookupError("no other tolerance")
    return judged(
        (table["not_converged"] > 0).all()
        and flights["accuracy_m"].max() > (1.0 + MASSIVE) * flights["accuracy_m"].min(),
        f"Meeny, Scenario 1, {text}. The printed solves are not among these",
    )


def equality_ranks(grounds: Grounds[Configuration], transposed: bool) -> tuple[int, int, int]:
    """Equalities that move at a converged segment, their rank, and that of pointing.

    The segment is Meeny's first by the indirect method, where all conditions hold.
    """
    name = "optima-scenario-1-segments.csv"
    row = grounds.rows(name, solution=INDIRECT, cubesat="Meeny", segment=0).iloc[0]
    if not row["converged"]:
        raise LookupError("no converged segment")
    z = np.r_[row[COSTATE].to_numpy(dtype=float), row["duration_s"]]
    return ranks_at(Parameters.from_section(grounds.section), z, transposed)


def ranks_at(parameters: Parameters, z: np.ndarray, transposed: bool) -> tuple[int, int, int]:
    """Ranks of the equalities' Jacobian on Meeny's first segment, at any of its unknowns (7,)."""
    race, numbers = parameters.races["scenario-1"], parameters.listing
    cubesat = next(c for c in race.cubesats if c.name == "Meeny")
    target = targets(race.course)[0]
    fixed = (
        np.r_[cubesat.position, np.zeros(3)],
        0.0,
        (parameters.mean_motion, transposed, *law_of(cubesat)),
        (target.centre, target.normal, 0.0, numbers.plane, False),
        # The errors of the flight itself must not blur the ranks.
        (numbers.deadzone, numbers.constraint_deadzone, numbers.final_hamiltonian, FLIGHT),
    )
    jacobian = np.empty((listing.EQUALITIES, len(z)))
    for i, value in enumerate(z):
        step = np.zeros(len(z))
        step[i] = STEP * abs(value)
        above, below = listing.functions(np.array([z + step, z - step]), *fixed)
        # Relative to each unknown, so that the rank does not hang on units.
        jacobian[:, i] = (above - below)[1 : 1 + listing.EQUALITIES] / (2.0 * STEP)
    moving = int((np.abs(jacobian).max(axis=1) > 0.0).sum())
    ranks = []
    for rows in (jacobian, jacobian[9:]):
        values = np.linalg.svd(rows, compute_uv=False)
        ranks.append(int((values > RANK * values[0]).sum()))
    return moving, ranks[0], ranks[1]


def equalities_are_redundant(grounds: Grounds) -> Judgement:
    """Ranks of the equalities' Jacobian at a solution, with right costates and the listing's."""
    moving, rank, pointing = equality_ranks(grounds, transposed=True)
    _, slipped, _ = equality_ranks(grounds, transposed=False)
    return judged(
        moving <= 5 and rank == 3 and pointing == 2 and slipped == 4,
        f"at a converged segment {moving} of the {listing.EQUALITIES} rows depend on the unknowns "
        f"at all, the three rows of pointing have rank {pointing}, and all together rank {rank}: "
        f"two of direction, and H = -1, which the length of the costates can always meet. With the "
        f"listing's costates H0 = Hf is no identity but a condition of its own, rank {slipped}. "
        f"Where the rows of pointing contradict one another to first order, a solver such as "
        f"fmincon has to relax them",
    )
