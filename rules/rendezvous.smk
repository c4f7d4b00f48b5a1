# Rendezvous: three-phase model predictive control, its undisclosed parameters and its manoeuvres.
from smallsat.studies.rendezvous.configuration import Cases, MonteCarlo
from smallsat.studies.rendezvous.inference.parameter_set import SEARCHES

MANOEUVRE_SHARDS = Shard.all(CONFIG["rendezvous"].studies.shards)
# Groups of manoeuvres, and where each begins: at an initial state, or where the baseline ended the
# phase before.
GROUPS = {
    "domain": "studies/initial-states.parquet",
    "rendezvous-sweep": "studies/initial-states.parquet",
    "approach-sweep": "studies/domain.parquet",
    "docking-sweep": "studies/domain.parquet",
    "weights": "studies/initial-states.parquet",
    "delay": "studies/initial-states.parquet",
    "prediction": "studies/disturbed-states.parquet",
    "robustness": "studies/disturbed-states.parquet",
    "passages": "studies/disturbed-states.parquet",
}
GROUP_TABLES = [f"studies/{group}.parquet" for group in GROUPS]
FLIGHTS = ["flights.parquet", "paths.parquet", "phases.csv", "truth.csv"]
INFERRED = [
    "inference.parquet",
    "text.csv",
    "residuals.csv",
    "identified.csv",
    "profiles.csv",
    "readings.csv",
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
    *[
        f"studies/{group}.parquet"
        for group in GROUPS
        if group not in ("weights", "delay", "passages")
    ],
]

step("rendezvous", "flights", makes=FLIGHTS, takes=Cases)

# One search for each option of each reading.
for search in SEARCHES:
    step(
        "rendezvous",
        f"search-{search}",
        runs="search",
        part=search,
        reads=["studies/initial-states.parquet"],
        makes=[f"search-{search}.parquet"],
        published=["values.csv"],
        accepted=["sets.csv"],
        takes=Cases,
    )

step(
    "rendezvous",
    "inference",
    reads=["studies/initial-states.parquet"] + [f"search-{search}.parquet" for search in SEARCHES],
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
    )

step("rendezvous", "solvers", makes=["solvers.csv"], clock=["solver-seconds.csv"])
step("rendezvous", "constraints", makes=["constraints.csv"])
step(
    "rendezvous",
    "initial_states",
    makes=["studies/initial-states.parquet", "studies/disturbed-states.parquet"],
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
            reads=[starts],
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
    "summaries",
    reads=GROUP_TABLES,
    makes=[
        f"studies/{name}.csv"
        for name in (
            "variants",
            "bounce",
            "deviations",
            "infeasible",
            "thrust-readings",
            "thrust-errors",
        )
    ],
    takes=MonteCarlo,
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
    *[
        f"ensemble/{number}/{table}"
        for number in ENSEMBLE
        for table in MEMBER_TABLES
        if table != "studies/disturbed-states.parquet"
    ],
    *[
        f"studies/{group}.parquet"
        for group in GROUPS
        if group not in ("weights", "delay", "passages")
    ],
]
