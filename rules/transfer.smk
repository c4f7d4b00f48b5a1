# Transfer: a low-thrust orbit transfer in minimum time, by a grid of methods.

INTERVALS = [1, *CONFIG["transfer"].intervals]
TRANSFER_SHARDS = [f"as-published-k{intervals}" for intervals in INTERVALS]

for experiment in ("indirect", "converged", "unbounded", "continuous", "tighter_bounds"):
    step(
        "transfer",
        experiment,
        runs="experiment",
        part=experiment,
        makes=[f"{experiment}.csv", f"{experiment}.parquet", f"{experiment}-not-converged.csv"],
        clock=[f"{experiment}-seconds.csv"],
    )

step(
    "transfer",
    "multistart",
    makes=[
        "multistart.csv",
        "multistart.parquet",
        "multistart-starts.csv",
        "multistart-not-converged.csv",
    ],
    clock=["multistart-seconds.csv"],
)
step(
    "transfer",
    "collocation",
    makes=["collocation.csv", "collocation-not-converged.csv"],
    clock=["collocation-seconds.csv"],
)

for further, made in {
    "convergence": ["convergence.csv"],
    "basin": ["basin.csv"],
    "coasting": ["coasting.csv", "coasting.parquet"],
}.items():
    step("transfer", further, makes=made)

# As the document did it, one part for each number of intervals.
for intervals, name in zip(INTERVALS, TRANSFER_SHARDS, strict=True):
    step(
        "transfer",
        name,
        runs="as_published",
        part=intervals,
        makes=[f"{name}.csv", f"{name}.parquet", f"{name}-path.csv"],
        clock=[f"{name}-seconds.csv"],
    )

    step(
        "transfer",
        f"long-flights-k{intervals}",
        runs="long_flights",
        part=intervals,
        makes=[f"long-flights-k{intervals}.csv"],
    )

step(
    "transfer",
    "gather",
    reads=[
        *[f"long-flights-k{intervals}.csv" for intervals in INTERVALS],
        *[
            f"{name}{suffix}"
            for name in TRANSFER_SHARDS
            for suffix in (".csv", ".parquet", "-seconds.csv", "-path.csv")
        ],
    ],
    published=["values.csv"],
    makes=[
        "as-published.csv",
        "as-published.parquet",
        "as-published-path.csv",
        "printed-stop.csv",
        "long-flights.csv",
    ],
    clock=["as-published-seconds.csv"],
)
step(
    "transfer",
    "observations",
    reads=[
        *[f"{name}.csv" for name in ("indirect", "as-published", "converged", "unbounded")],
        *[f"{name}.csv" for name in ("continuous", "multistart", "tighter_bounds")],
        "indirect-seconds.csv",
        "as-published-seconds.csv",
        *[
            f"{name}-not-converged.csv"
            for name in (
                "indirect",
                "converged",
                "unbounded",
                "continuous",
                "multistart",
                "collocation",
            )
        ],
    ],
    published=["values.csv"],
    makes=["observations.csv", "not-converged.csv"],
    clock=["timings.csv"],
)

JUDGED["transfer"] = [
    "observations.csv",
    "indirect.csv",
    "indirect.parquet",
    "as-published.csv",
    "as-published.parquet",
    "converged.csv",
    "converged.parquet",
    "unbounded.csv",
    "continuous.csv",
    "tighter_bounds.csv",
    "multistart.csv",
    "printed-stop.csv",
    "long-flights.csv",
]
