# Mars: pointing of a nano-satellite on its orbit around Mars.

step(
    "mars",
    "simulation",
    makes=[
        "trajectories.parquet",
        "day.parquet",
        "modes.csv",
        "mode-shares.csv",
        "observations.csv",
        "not-converged.csv",
    ],
)
step("mars", "independent_check", makes=["independent.parquet"])

JUDGED["mars"] = ["observations.csv", "trajectories.parquet", "day.parquet", "independent.parquet"]

SCENES["mars"] = ["trajectories.parquet"]
