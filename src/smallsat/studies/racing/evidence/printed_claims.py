"""Predicates of claims on the document's own solves, judged on its printed numbers.

Printed numbers are compared with each other, and with the rings of the recovered courses; nothing
that was solved here speaks for them.
"""

import numpy as np
from scipy.optimize import brentq

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.evidence.observations import MILLI
from smallsat.studies.racing.evidence.race_tables import MASSIVE, printed
from smallsat.studies.racing.evidence.scores import printed_scores
from smallsat.studies.racing.methods.flight import least_time
from smallsat.studies.racing.parameters import Parameters

ALONE = "printed numbers alone"
# The CubeSats of Scenario 1 that may thrust in any direction, by their thrust.
UNRESTRICTED = ["Eeny", "Meeny", "Miny"]


def _list(numbers, digits: int = 1) -> str:
    return ", ".join(f"{name} {value:.{digits}f}" for name, value in numbers.items())


def faster_with_thrust(grounds: Grounds) -> Judgement:
    """Table 2's times of the unrestricted CubeSats must fall; the text itself excepts Mo."""
    times = printed(grounds, "scenario-1")["time_s"][UNRESTRICTED]
    return judged(times.is_monotonic_decreasing, f"{ALONE}: {_list(times)} s, by rising thrust")


def lower_minimum_cost(grounds: Grounds[Configuration]) -> Judgement:
    """Table 2's minimum costs must fall with the largest thrust, Mo's being that of all axes."""
    crafts = Parameters.from_section(grounds.section).races["scenario-1"].cubesats
    order = [craft.name for craft in sorted(crafts, key=lambda craft: craft.thrust)]
    costs = printed(grounds, "scenario-1")["minimum_cost_s"][order]
    return judged(
        costs.is_monotonic_decreasing,
        f"{ALONE}: {_list(costs)} s, by rising thrust, Mo's being the norm of its axes",
    )


def most_accurate_in_between(grounds: Grounds) -> Judgement:
    """Table 2's least accuracy number must be Meeny's, whose thrust lies in between."""
    misses = printed(grounds, "scenario-1")["accuracy_m"]
    return judged(
        misses.idxmin() == UNRESTRICTED[1],
        f"{ALONE}: {_list(misses)} m. How its solves ended; what thrust does to the race is the "
        f"next claim",
    )


def mo_missed_rings(grounds: Grounds[Configuration]) -> Judgement:
    """Mo's printed misses must exceed what they can add up to with every ring passed."""
    sizes = Parameters.from_section(grounds.section).races["scenario-1"].course.sizes
    miss = float(printed(grounds, "scenario-1")["accuracy_m"]["Mo"])
    return judged(
        miss > sizes.sum(),
        f"its printed misses add up to {miss:.1f} m, the smaller axes of all {len(sizes)} rings to "
        f"{sizes.sum():.1f} m, so that it must have missed some",
    )


def mo_slower_than_meeny(grounds: Grounds) -> Judgement:
    """Table 2's times of Mo and Meeny are compared."""
    times = printed(grounds, "scenario-1")["time_s"][["Mo", "Meeny"]]
    return judged(times["Mo"] > times["Meeny"], f"{ALONE}: {_list(times)} s")


def follows_the_course(grounds: Grounds[Configuration]) -> Judgement:
    """Generally: most printed runs must miss a ring by little against the way to the next."""
    parameters = Parameters.from_section(grounds.section)
    rings = {name: race.course.rings for name, race in parameters.races.items()}
    table = printed_scores(grounds.ledger)
    misses = table["accuracy_m"] / table["scenario"].map(rings)
    spacing = parameters.ranges.distance[0]
    near = misses < MASSIVE * spacing
    worst = table.iloc[int(misses.argmax())]
    return judged(
        near.sum() > len(near) / 2,
        f"in {near.sum()} of {len(near)} printed runs the misses are less than "
        f"{100 * MASSIVE:.0f} % of the least way between two rings, a ring on average; they are "
        f"{misses.min():.1f} to {misses.max():.1f} m, the most by {worst['cubesat']} of Scenario "
        f"{worst['scenario'][-1]}",
    )


def accuracies_vary(grounds: Grounds) -> Judgement:
    """Table 4's largest accuracy number must be another order of magnitude than its least."""
    misses = printed(grounds, "scenario-2")["accuracy_m"]
    return judged(
        misses.max() > misses.min() / MASSIVE,
        f"{ALONE}: {_list(misses)} m, "
        f"{misses.max() / misses.min():.1f} times as much at most as at least",
    )


def eeny_first_meeny_wins(grounds: Grounds) -> Judgement:
    """Table 4's orders by time and by cost."""
    table = printed(grounds, "scenario-2")
    times, costs = table["time_s"].sort_values(), table["cost"].sort_values()
    return judged(
        times.index[0] == "Eeny" and costs.index[0] == "Meeny" == times.index[2],
        f"{ALONE}: times {_list(times)} s; costs {_list(costs)}",
    )


def results_differ_by_start(grounds: Grounds[Configuration]) -> Judgement:
    """Of Scenario 2's CubeSats only the start may differ, and Table 4's costs must."""
    crafts = Parameters.from_section(grounds.section).races["scenario-2"].cubesats
    alike = len({(craft.thrust, craft.axis_thrust) for craft in crafts}) == 1
    costs = printed(grounds, "scenario-2")["cost"]
    spread = float(costs.max() / costs.min() - 1.0)
    return judged(
        alike and spread > MASSIVE,
        f"the four differ in nothing but their start, and their printed costs by "
        f"{100 * spread:.0f} %. What a start does to such a solve any other small change does as "
        f"well, see the claim on solves that hang on rounding",
    )


def mo_moved_fastest(grounds: Grounds[Configuration]) -> Judgement:
    """The one speed at all rings that gives each printed minimum cost; Mo's must be the largest."""
    race = Parameters.from_section(grounds.section).races["scenario-2"]
    course = race.course
    gaps = np.linalg.norm(np.diff(np.vstack([course.centres, course.end]), axis=0), axis=1)
    table = printed(grounds, "scenario-2")
    speeds = {}
    for craft in race.cubesats:
        first = least_time(
            float(np.linalg.norm(course.centres[0] - craft.position)), 0.0, craft.thrust
        )

        def excess(speed, craft=craft, first=first):
            later = sum(least_time(gap, speed, craft.thrust) for gap in gaps)
            return first + later - table["minimum_cost_s"][craft.name]

        speeds[craft.name] = float(brentq(excess, 0.0, 1e3))
    return judged(
        max(speeds, key=speeds.__getitem__) == "Mo",
        f"the minimum cost falls with the speeds at the rings; one speed at all of them that gives "
        f"the printed costs is {_list(speeds, 2)} m/s. By time over the course Eeny was faster: "
        f"{_list(table['time_s'].sort_values())} s",
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
        f"{ALONE}: {ratios[1]:.0f} times for the largest values of both ranges, {ratios[0]:.0f} "
        f"times for the smallest",
    )


def cost_is_time_plus_accuracy(grounds: Grounds) -> Judgement:
    """Time and accuracy of every printed row must add up to its cost."""
    table = printed_scores(grounds.ledger)
    errors = (table["cost"] - table["time_s"] - table["accuracy_m"]).abs()
    # Two printed values are rounded, and so is their sum.
    half_unit = grounds.ledger.value("table-2/final-overall-cost/scenario-1-eeny").half_unit
    return judged(
        errors.max() <= 3.0 * half_unit,
        f"{ALONE}: in all {len(errors)} rows, to {errors.max():.3f} at most, which is rounding",
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
