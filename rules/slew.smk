# Slew: torque-optimal turns of a CubeSat with degraded reaction wheels.

from smallsat.studies.slew.methods.bound import plan_titles

SLEW = "data/results/slew"
SLEW_SECTION = config["slew"]

# What each command of the study makes.
SLEW_RUNS = {
    "flights": ["flights.parquet", "orbit.csv", "environment.csv"],
    "search": ["controllers.csv"],
    "minimum-times": [
        "minimum-times.csv",
        "switches.csv",
        "minimum-time-starts.csv",
        "minimum-times-seconds.csv",
        "bound.csv",
        "minimum-times-unsolved.csv",
    ],
    "plans": [
        "plans.csv",
        "infeasible.csv",
        "plan-starts.csv",
        "plan-nodes.parquet",
        "held-plans.parquet",
        "replays.parquet",
        "propagator.csv",
        "plan-seconds.csv",
        "plans-unsolved.csv",
    ],
    "trade-off": [
        "trade-off.csv",
        "trade-off-plans.parquet",
        "trade-off-seconds.csv",
        "trade-off-unsolved.csv",
    ],
    "degradation": ["degradation.csv", "degradation-unsolved.csv"],
    "tracking": ["tracking.csv", "tracking-flights.parquet", "tracking-unsolved.csv"],
}
# Seconds differ from run to run, so nothing that is judged depends on them.
SLEW_TABLES = [
    f"{SLEW}/{name}" for names in SLEW_RUNS.values() for name in names if "seconds" not in name
]

STUDY_RESULTS["slew"] = [f"{SLEW}/observations.csv", *SLEW_TABLES]

# Figures of each notebook run: few, so that one figure alone is made in seconds.
SLEW_MOTIONS = {
    "eigenaxis-quarter": ("flights", {"eigenaxis quarter": ""}, ["fig-03", "fig-04", "fig-05"]),
    "eigenaxis-half": ("flights", {"eigenaxis half": ""}, ["fig-06", "fig-07", "fig-08"]),
    "optimal-quarter": (
        "replays",
        plan_titles(SLEW_SECTION, "quarter"),
        ["fig-10", "fig-11", "fig-12"],
    ),
    "optimal-half": (
        "replays",
        plan_titles(SLEW_SECTION, "half"),
        ["fig-14", "fig-15", "fig-16"],
    ),
}
SLEW_PLANS = {"plan-quarter": ("fig-09", "quarter"), "plan-half": ("fig-13", "half")}
SLEW_SCHEMATICS = ["fig-01", "fig-17", "fig-18", "fig-19"]
SLEW_BEYOND = ["trade-off", "degradation", "tracking"]
SLEW_DRAWING = NOTEBOOK_SOURCES + sources(
    "smallsat.studies.slew.figures.motions",
    "smallsat.studies.slew.figures.schematics",
    "smallsat.drawing.figure",
    "smallsat.drawing.style",
    "smallsat.results",
)


for name, files in SLEW_RUNS.items():

    rule:
        name:
            f"slew_{name.replace('-', '_')}"
        input:
            sources=sources("smallsat.studies.slew.steps"),
        output:
            [f"{SLEW}/{file}" for file in files],
        log:
            f"logs/slew/{name}.log",
        benchmark:
            f"logs/slew/{name}.benchmark.tsv"
        params:
            command=name,
            config=as_json(SLEW_SECTION),
            folder=lambda _, output: os.path.dirname(output[0]),
        message:
            f"slew: {name}"
        shell:
            "python -m smallsat.studies.slew.steps {params.command} --config {params.config:q}"
            " --output-folder {params.folder} > {log} 2>&1"


rule slew_observations:
    input:
        sources=sources("smallsat.studies.slew.steps"),
        tables=SLEW_TABLES,
        seconds=f"{SLEW}/plan-seconds.csv",
    output:
        f"{SLEW}/observations.csv",
        f"{SLEW}/not-converged.csv",
        f"{SLEW}/timings.csv",
    log:
        "logs/slew/observations.log",
    benchmark:
        "logs/slew/observations.benchmark.tsv"
    params:
        config=as_json(SLEW_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "slew: observe the published values"
    shell:
        "python -m smallsat.studies.slew.steps observe --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


for name, (table, flights, figures) in SLEW_MOTIONS.items():

    rule:
        name:
            f"slew_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/slew/motion.ipynb"),
            sources=SLEW_DRAWING,
            flights=f"{SLEW}/{table}.parquet",
        output:
            figure_files(*[f"figures/slew/{figure}" for figure in figures]),
            notebook=f"{SLEW}/notebooks/{name}.ipynb",
        log:
            f"logs/slew/{name}.log",
        benchmark:
            f"logs/slew/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": SLEW_SECTION,
                    "flights_path": f"{SLEW}/{table}.parquet",
                    "flights": flights,
                    "folder": "figures/slew",
                    "figures": dict(zip(["attitude", "usage", "traces"], figures, strict=True)),
                }
            ),
        message:
            f"slew: {name}"
        shell:
            NOTEBOOK


for name, (figure, case) in SLEW_PLANS.items():

    rule:
        name:
            f"slew_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/slew/plan.ipynb"),
            sources=SLEW_DRAWING,
            nodes=f"{SLEW}/plan-nodes.parquet",
        output:
            figure_files(f"figures/slew/{figure}"),
            notebook=f"{SLEW}/notebooks/{name}.ipynb",
        log:
            f"logs/slew/{name}.log",
        benchmark:
            f"logs/slew/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": SLEW_SECTION,
                    "nodes_path": f"{SLEW}/plan-nodes.parquet",
                    "plans": plan_titles(SLEW_SECTION, case),
                    "figure_path": f"figures/slew/{figure}",
                }
            ),
        message:
            f"slew: {name}"
        shell:
            NOTEBOOK


rule slew_schematics:
    input:
        notebook=project("notebooks/slew/schematics.ipynb"),
        sources=SLEW_DRAWING,
    output:
        figure_files(*[f"figures/slew/{figure}" for figure in SLEW_SCHEMATICS]),
        notebook=f"{SLEW}/notebooks/schematics.ipynb",
    log:
        "logs/slew/schematics.log",
    benchmark:
        "logs/slew/schematics.benchmark.tsv"
    params:
        parameters=as_json({"section": SLEW_SECTION, "folder": "figures/slew"}),
    message:
        "slew: draw the schematics"
    shell:
        NOTEBOOK


rule slew_environment:
    input:
        notebook=project("notebooks/slew/environment.ipynb"),
        sources=SLEW_DRAWING,
        table=f"{SLEW}/environment.csv",
    output:
        figure_files("figures/slew/fig-02"),
        notebook=f"{SLEW}/notebooks/environment.ipynb",
    log:
        "logs/slew/environment.log",
    benchmark:
        "logs/slew/environment.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "section": SLEW_SECTION,
                "table_path": f"{SLEW}/environment.csv",
                "figure_path": "figures/slew/fig-02",
            }
        ),
    message:
        "slew: draw the environment torques"
    shell:
        NOTEBOOK


rule slew_beyond:
    input:
        notebook=project("notebooks/slew/beyond.ipynb"),
        sources=SLEW_DRAWING,
        tables=[
            f"{SLEW}/{name}"
            for name in (
                "trade-off.csv",
                "degradation.csv",
                "tracking-flights.parquet",
                "minimum-times.csv",
                "bound.csv",
            )
        ],
    output:
        figure_files(*[f"figures/slew/{figure}" for figure in SLEW_BEYOND]),
        notebook=f"{SLEW}/notebooks/beyond.ipynb",
    log:
        "logs/slew/beyond.log",
    benchmark:
        "logs/slew/beyond.benchmark.tsv"
    params:
        parameters=as_json({"section": SLEW_SECTION, "results": SLEW, "folder": "figures/slew"}),
    message:
        "slew: draw what goes beyond the document"
    shell:
        NOTEBOOK


rule slew:
    input:
        targets("slew", "table", "figure"),
        figure_files(*[f"figures/slew/{figure}" for figure in SLEW_BEYOND]),
        SLEW_TABLES,
        f"{SLEW}/verdicts.csv",
        f"{SLEW}/errata.csv",
        f"{SLEW}/claims.csv",
    log:
        "logs/slew/slew.log",
    message:
        "slew: all tables, figures and verdicts are there"
