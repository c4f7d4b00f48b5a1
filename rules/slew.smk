# Slew: torque-optimal turns of a CubeSat with degraded reaction wheels.

step(
    "slew",
    "flights",
    published=["values.csv"],
    accepted=["density.csv"],
    makes=[
        "flights.parquet",
        "orbit.csv",
        "environment.csv",
        "atmospheres.csv",
        "outer-torques.csv",
    ],
)
step("slew", "search", makes=["controllers.csv"], published=["values.csv"])
step(
    "slew",
    "minimum_times",
    makes=[
        "minimum-times.csv",
        "switches.csv",
        "minimum-time-starts.csv",
        "bound.csv",
        "minimum-times-not-converged.csv",
    ],
    clock=["minimum-times-seconds.csv"],
)
step(
    "slew",
    "plans",
    makes=[
        "plans.csv",
        "infeasible.csv",
        "plan-starts.csv",
        "plan-nodes.parquet",
        "held-plans.parquet",
        "replays.parquet",
        "propagator.csv",
        "attitude-steps.csv",
        "plans-not-converged.csv",
    ],
    clock=["plan-seconds.csv"],
)
step(
    "slew",
    "trade_off",
    makes=["trade-off.csv", "trade-off-plans.parquet", "trade-off-not-converged.csv"],
    clock=["trade-off-seconds.csv"],
)
step("slew", "degradation", makes=["degradation.csv", "degradation-not-converged.csv"])
step(
    "slew",
    "tracking",
    makes=["tracking.csv", "tracking-flights.parquet", "tracking-not-converged.csv"],
)
step(
    "slew",
    "models",
    published=["values.csv"],
    makes=["models.csv", "models-flights.parquet", "models-not-converged.csv"],
)
step("slew", "savings", makes=["savings.csv", "savings-not-converged.csv"])
step("slew", "wheel_states", makes=["wheel-states.csv", "wheel-states-not-converged.csv"])
step("slew", "formulations", makes=["collocation.csv", "gradient-forms.csv", "nodes.csv"])
step(
    "slew",
    "observations",
    reads=[
        "flights.parquet",
        "orbit.csv",
        "environment.csv",
        "minimum-times.csv",
        "replays.parquet",
        "plan-seconds.csv",
        "minimum-times-not-converged.csv",
        "plans-not-converged.csv",
        "trade-off-not-converged.csv",
        "degradation-not-converged.csv",
        "tracking-not-converged.csv",
        "models-not-converged.csv",
        "savings-not-converged.csv",
        "wheel-states-not-converged.csv",
    ],
    published=["values.csv"],
    makes=["observations.csv", "not-converged.csv"],
    clock=["timings.csv"],
)

JUDGED["slew"] = [
    "observations.csv",
    "flights.parquet",
    "orbit.csv",
    "environment.csv",
    "atmospheres.csv",
    "controllers.csv",
    "minimum-times.csv",
    "bound.csv",
    "plans.csv",
    "plan-starts.csv",
    "plan-nodes.parquet",
    "infeasible.csv",
    "replays.parquet",
    "propagator.csv",
    "attitude-steps.csv",
    "collocation.csv",
    "gradient-forms.csv",
    "nodes.csv",
    "trade-off.csv",
    "trade-off-plans.parquet",
    "models.csv",
    "models-flights.parquet",
    "savings.csv",
]

SCENES["slew"] = ["replays.parquet"]
