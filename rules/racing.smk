# Racing: CubeSats through rings, as its listings have it and as it should have been run.
from smallsat.studies.racing.configuration import SCENARIOS, course_files

RACING_PARTS = ["races.csv", "rings.csv", "segments.csv", "trajectories.parquet"]
RANDOM_SHARDS = Shard.all(2)
# Courses of the user's own, read by every step with the parameters.
COURSES = {"files": course_files(CONFIG["racing"])}

step(
    "racing",
    "courses",
    makes=[
        *[f"course-{scenario}.csv" for scenario in SCENARIOS],
        "start-positions.csv",
        "days-as-seeds.csv",
    ],
    **COURSES,
)

for scenario in SCENARIOS:
    step(
        "racing",
        f"listing-{scenario}",
        runs="listing",
        part=scenario,
        makes=[f"listing-{scenario}-{table}" for table in RACING_PARTS],
        clock=[f"listing-{scenario}-seconds.csv"],
        **COURSES,
    )
    step(
        "racing",
        f"optima-{scenario}",
        runs="optima",
        part=scenario,
        makes=[f"optima-{scenario}-{table}" for table in (*RACING_PARTS, "not-converged.csv")],
        clock=[f"optima-{scenario}-seconds.csv"],
        **COURSES,
    )

step("racing", "variants", makes=["variants.csv"], **COURSES)
step("racing", "without_thrust", makes=["without-thrust.csv"], **COURSES)
step("racing", "simple_guesses", makes=["simple-guesses.csv"], **COURSES)
step(
    "racing",
    "checks",
    makes=[
        "meshes.csv",
        "other-starts.csv",
        "thrust-sweep.csv",
        "random-positions.csv",
        "checks-not-converged.csv",
    ],
    **COURSES,
)
step(
    "racing",
    "dynamic_programming",
    makes=["dynamic-programming.csv", "dynamic-programming-not-converged.csv"],
    **COURSES,
)
step(
    "racing",
    "weighted_misses",
    makes=["ring-multipliers.csv", "miss-weights.csv", "miss-weights-not-converged.csv"],
    **COURSES,
)
step(
    "racing",
    "drifting_rings",
    reads=[f"optima-{scenario}-races.csv" for scenario in SCENARIOS],
    makes=["drifting-rings.csv", "drifting-rings-not-converged.csv"],
    **COURSES,
)
step("racing", "dispersions", makes=["dispersions.csv", "dispersed-flights.csv"], **COURSES)

for shard in RANDOM_SHARDS:
    step(
        "racing",
        f"random-courses-{shard}",
        runs="random_courses",
        shard=shard,
        makes=[f"random-courses-{shard}.csv", f"random-courses-{shard}-not-converged.csv"],
        clock=[f"random-courses-{shard}-seconds.csv"],
        **COURSES,
    )

step(
    "racing",
    "observations",
    # The number of shards, whose last one stands for all.
    shard=RANDOM_SHARDS[-1],
    reads=[
        *[
            f"{kind}-{scenario}-{table}.csv"
            for scenario in SCENARIOS
            for kind in ("listing", "optima")
            for table in ("races", "rings")
        ],
        *[f"random-courses-{shard}.csv" for shard in RANDOM_SHARDS],
        *[f"{kind}-scenario-2-seconds.csv" for kind in ("listing", "optima")],
        *[f"optima-{scenario}-not-converged.csv" for scenario in SCENARIOS],
        *[f"random-courses-{shard}-not-converged.csv" for shard in RANDOM_SHARDS],
        "checks-not-converged.csv",
        "dynamic-programming-not-converged.csv",
        "miss-weights-not-converged.csv",
        "drifting-rings-not-converged.csv",
    ],
    published=["values.csv"],
    makes=["races.csv", "rings.csv", "random-courses.csv", "observations.csv", "not-converged.csv"],
    clock=["timings.csv"],
)

step(
    "racing",
    "propellant",
    reads=["races.csv", "thrust-sweep.csv"],
    makes=["propellant.csv"],
)

JUDGED["racing"] = [
    "observations.csv",
    "races.csv",
    "random-courses.csv",
    "days-as-seeds.csv",
    "variants.csv",
    "without-thrust.csv",
    "meshes.csv",
    "other-starts.csv",
    "simple-guesses.csv",
    "thrust-sweep.csv",
    "propellant.csv",
    "random-positions.csv",
    "dynamic-programming.csv",
    "course-scenario-1.csv",
    "listing-scenario-1-trajectories.parquet",
    "optima-scenario-1-segments.csv",
    "optima-scenario-1-trajectories.parquet",
]

SCENES["racing"] = [
    name
    for scenario in SCENARIOS
    for name in (
        f"course-{scenario}.csv",
        f"listing-{scenario}-trajectories.parquet",
        f"optima-{scenario}-trajectories.parquet",
    )
]
