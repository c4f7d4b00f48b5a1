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
        "simulation-not-converged.csv",
    ],
)
step("mars", "independent_check", makes=["independent.parquet"])
step(
    "mars",
    "laws",
    makes=[
        "laws.csv",
        "laws-missions.parquet",
        "laws-runs.parquet",
        "laws-robustness.csv",
        "laws-not-converged.csv",
    ],
)
step("mars", "light", makes=["light.csv", "light-intervals.csv"])
step(
    "mars",
    "not_converged",
    reads=["simulation-not-converged.csv", "laws-not-converged.csv"],
    makes=["not-converged.csv"],
)

JUDGED["mars"] = ["observations.csv", "trajectories.parquet", "day.parquet", "independent.parquet"]

SCENES["mars"] = ["trajectories.parquet"]
