# Rendezvous: three-phase model predictive control, its undisclosed parameters and its manoeuvres.
from smallsat.studies.rendezvous.configuration import Cases, MonteCarlo
from smallsat.studies.rendezvous.flight_computer.provenance import counted_sources
from smallsat.studies.rendezvous.inference.parameter_set import SEARCHES

MANOEUVRE_SHARDS = Shard.all(CONFIG["rendezvous"].studies.shards)
# Groups of manoeuvres, and where each begins: at an initial state, or where the baseline ended the
# phase before.
INITIAL, DISTURBED = "studies/initial-states.parquet", "studies/disturbed-states.parquet"
DOMAIN = "studies/domain.parquet"
GROUPS = {
    "domain": [INITIAL],
    "rendezvous-sweep": [INITIAL],
    "approach-sweep": [DOMAIN],
    "docking-sweep": [DOMAIN],
    "weights": [INITIAL],
    "delay": [INITIAL],
    "prediction": [DISTURBED],
    "robustness": [DISTURBED],
    "passages": [DISTURBED],
    "ablations": [INITIAL, DISTURBED, DOMAIN],
    "impulse-bits": [DISTURBED],
    "rotation": [INITIAL, DOMAIN],
    "orbits": [DISTURBED],
}
# Groups that no claim rests on are flown with the configured set alone.
NO_MEMBER_HAS = ("passages", "impulse-bits", "rotation", "orbits")
# What the summaries compare; ablations are for the claims alone.
SUMMARISED = [f"studies/{group}.parquet" for group in GROUPS if group != "ablations"]
FLIGHTS = ["flights.parquet", "paths.parquet", "phases.csv", "truth.csv"]
INFERRED = [
    "inference.parquet",
    "text.csv",
    "residuals.csv",
    "identified.csv",
    "profiles.csv",
    "readings.csv",
    "trade-offs.csv",
    "sets.csv",
    "lp-variants.csv",
]

ENSEMBLE = [
    f"{number:02d}" for number in range(1, CONFIG["rendezvous"].inference.ensemble.sets + 1)
]
# What the claims read of each set of the ensemble.
MEMBER_TABLES = [
    "set.csv",
    *FLIGHTS,
    "constraints.csv",
    "studies/initial-states.parquet",
    "studies/disturbed-states.parquet",
    *[f"studies/{group}.parquet" for group in GROUPS if group not in NO_MEMBER_HAS],
]

step("rendezvous", "flights", makes=FLIGHTS, takes=Cases)

# One search for each option of each reading.
for search in SEARCHES:
    step(
        "rendezvous",
        f"search-{search}",
        runs="search",
        part=search,
        reads=[INITIAL],
        makes=[f"search-{search}.parquet"],
        published=["values.csv"],
        accepted=["sets.csv"],
        takes=Cases,
    )

# A second method walks on from where the project's long walk ended.
step(
    "rendezvous",
    "posterior",
    reads=[INITIAL],
    makes=["posterior.csv"],
    published=["values.csv"],
    accepted=["posterior.csv"],
    takes=Cases,
)
# Whether any set holds the printed axes was searched once; builds take what is tracked of it.
step(
    "rendezvous",
    "axes_search",
    reads=[INITIAL],
    makes=["searched-axes.csv"],
    published=["values.csv"],
    accepted=["sets.csv"],
    takes=Cases,
    aside=True,
)
step(
    "rendezvous",
    "axes",
    reads=[INITIAL],
    makes=["axes-search.csv", "axes-ends.csv", "axes-sets.csv"],
    published=["values.csv"],
    accepted=["axes-search.csv"],
    takes=Cases,
)
step(
    "rendezvous",
    "inference",
    reads=[INITIAL, "posterior.csv"] + [f"search-{search}.parquet" for search in SEARCHES],
    makes=INFERRED,
    published=["values.csv", "constraints.yaml"],
    takes=Cases,
)
for number in ENSEMBLE:
    step(
        "rendezvous",
        f"ensemble-{number}",
        runs="ensemble",
        part=number,
        makes=[f"ensemble/{number}/{table}" for table in MEMBER_TABLES],
        accepted=["sets.csv"],
        # The first one starts the build: in a fresh checkout it compiles what every other job that
        # flies then loads, and two that start together would both compile all of it.
        priority=1000 if number == ENSEMBLE[0] else None,
    )
step(
    "rendezvous",
    "not_fitted",
    reads=[
        f"ensemble/{number}/{table}"
        for number in ENSEMBLE
        for table in ("set.csv", "truth.csv", "studies/rendezvous-sweep.parquet")
    ],
    published=["values.csv"],
    makes=["not-fitted.csv", "failures.csv"],
)

step("rendezvous", "solvers", makes=["solvers.csv"], clock=["solver-seconds.csv"])
step("rendezvous", "constraints", makes=["constraints.csv"])
step("rendezvous", "elliptic", makes=["elliptic.csv", "elliptic-horizons.csv"])
step(
    "rendezvous",
    "initial_states",
    makes=[INITIAL, DISTURBED],
    takes=MonteCarlo,
)

for group, starts in GROUPS.items():
    for shard in MANOEUVRE_SHARDS:
        step(
            "rendezvous",
            f"{group}-{shard}",
            runs="manoeuvres",
            part=group,
            shard=shard,
            reads=starts,
            makes=[f"studies/shards/{group}-{shard}.parquet"],
            takes=MonteCarlo,
        )
    step(
        "rendezvous",
        group,
        runs="joined",
        part=group,
        # The number of shards, whose last one stands for all.
        shard=MANOEUVRE_SHARDS[-1],
        reads=[f"studies/shards/{group}-{shard}.parquet" for shard in MANOEUVRE_SHARDS],
        makes=[f"studies/{group}.parquet"],
        takes=MonteCarlo,
    )

step(
    "rendezvous",
    "tube",
    reads=["studies/disturbed-states.parquet"],
    makes=[f"studies/tube-{name}" for name in ("sizes.csv", "constraints.csv", "ways.parquet")],
    takes=MonteCarlo,
)
step(
    "rendezvous",
    "summaries",
    reads=SUMMARISED,
    makes=[
        f"studies/{name}.csv"
        for name in (
            "variants",
            "bounce",
            "deviations",
            "infeasible",
            "impulse-bits",
            "rotation",
            "orbits",
            "thrust-readings",
            "thrust-errors",
        )
    ],
    takes=MonteCarlo,
)
# Chapter 6. What an emulator has counted is tracked, and a build takes it from there; `make flight`
# counts anew and exchanges it.
COUNTED = [f"{name}.csv" for name in ("runs", "classes", "memory", "answers", "link", "provenance")]
FLIGHT_SOURCES = [os.path.relpath(path) for path in counted_sources()]
step(
    "rendezvous",
    "flight_measurement",
    makes=[f"flight/measured/{table}" for table in COUNTED],
    files=FLIGHT_SOURCES + [project("flight/client/client.c")],
    aside=True,
)
step(
    "rendezvous",
    "flight_computer",
    accepted=[f"flight/{table}" for table in COUNTED],
    files=FLIGHT_SOURCES,
    makes=[f"flight/{table}" for table in [*COUNTED, "cycles.csv"]],
)
step(
    "rendezvous",
    "observations",
    reads=[
        "phases.csv",
        "flights.parquet",
        "studies/rendezvous-sweep.parquet",
        "studies/approach-sweep.parquet",
        "studies/docking-sweep.parquet",
        "studies/robustness.parquet",
        "flight/cycles.csv",
    ],
    published=["values.csv"],
    makes=["observations.csv", "not-converged.csv"],
)

JUDGED["rendezvous"] = [
    "observations.csv",
    "flights.parquet",
    "paths.parquet",
    "phases.csv",
    "truth.csv",
    "readings.csv",
    "constraints.csv",
    "studies/initial-states.parquet",
    *[f"flight/{name}.csv" for name in ("runs", "cycles", "link")],
    *[
        f"ensemble/{number}/{table}"
        for number in ENSEMBLE
        for table in MEMBER_TABLES
        if table != "studies/disturbed-states.parquet"
    ],
    *[f"studies/{group}.parquet" for group in GROUPS if group not in NO_MEMBER_HAS],
]

SCENES["rendezvous"] = ["paths.parquet"]
