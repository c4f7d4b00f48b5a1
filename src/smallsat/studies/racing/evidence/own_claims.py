"""Predicates of our own claims: that the course is found again and the optimum is one."""

import numpy as np

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.racing.configuration import Configuration
from smallsat.studies.racing.evidence.race_claims import CENTRED
from smallsat.studies.racing.evidence.race_tables import (
    all_races,
    coarsest_meshes,
    complete,
    printed,
    races,
)
from smallsat.studies.racing.methods.races import ANYWHERE, GREEDY, INDIRECT, WHOLE
from smallsat.studies.racing.methods.recovery import start_positions
from smallsat.studies.racing.parameters import Parameters

AGREES = 0.05  # s


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


def penalty_is_exact(grounds: Grounds) -> Judgement:
    """The largest multiplier of a ring's centre is compared with the weight of a miss."""
    table = coarsest_meshes(grounds)
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
    every = grounds.table("races.csv")
    ours = every[every["solution"].isin((WHOLE, ANYWHERE, GREEDY))]
    complete(ours, "time_s")
    starts = grounds.table("other-starts.csv")
    complete(starts[starts["converged"]], "time_s")
    spread = starts[starts["converged"]].groupby(["scenario", "cubesat"])["time_s"]
    apart = float((spread.max() - spread.min()).max())
    meshes = complete(grounds.table("meshes.csv"), "time_s")
    change = meshes.groupby(["scenario", "cubesat"])["time_s"].agg(
        lambda t: (t.iloc[0] - t.iloc[-1]) / t.iloc[0]
    )
    dp = complete(grounds.table("dynamic-programming.csv"), "time_s").iloc[-1]
    name, scenario = dp["cubesat"], dp["scenario"]
    whole = float(races(grounds, WHOLE, scenario).loc[name, "time_s"])
    indirect = complete(grounds.rows("races.csv", solution=INDIRECT), "rings")
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
    times = complete(own[own["time_s"].notna()], "time_s")["time_s"]
    ours = float(all_races(grounds, WHOLE, "scenario-2")["time_s"].mean())
    ranks = {
        name: 100.0 * float((times < value).mean())
        for name, value in printed(grounds, "scenario-2")["time_s"].items()
    }
    place = 100.0 * float((times < ours).mean())
    return judged(
        sum(rank > 50.0 for rank in ranks.values()) == len(ranks),
        f"{len(times)} of {len(own)} random courses solved: {times.mean():.1f} s on average, "
        f"standard deviation {times.std():.1f} s. The printed times, misses not counted, are "
        f"longer than {', '.join(f'{rank:.1f} % ({name})' for name, rank in ranks.items())} of "
        f"them; the optimum of the course itself, {ours:.1f} s, is longer than {place:.0f} %",
    )
