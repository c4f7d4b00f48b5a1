# Mars: pointing of a nano-satellite on its orbit around Mars.

MARS = "data/results/mars"
MARS_SECTION = config["mars"]

STUDY_RESULTS["mars"] = [
    f"{MARS}/observations.csv",
    f"{MARS}/trajectories.parquet",
    f"{MARS}/day.parquet",
    f"{MARS}/independent.parquet",
]

# Notebook runs: which notebook, its figures, its parameters, and the module that draws.
MARS_RESPONSES = {
    "torque": {"fig-04": "no torque", "fig-05": "fixed torque"},
    "pointing": {"fig-06": "sun", "fig-07": "nadir", "fig-08": "gmo"},
    "mission": {"fig-10": "mission"},
}
MARS_SCENES = {
    "scenes-early": {"fig-11": 0, "fig-12": 1, "fig-13": 2},
    "scenes-late": {"fig-14": 3, "fig-15": 4},
}


rule mars_simulation:
    input:
        sources=sources("smallsat.mars.__main__"),
    output:
        multiext(
            f"{MARS}/",
            "trajectories.parquet",
            "day.parquet",
            "modes.csv",
            "mode-shares.csv",
            "observations.csv",
        ),
    log:
        "logs/mars/simulation.log",
    benchmark:
        "logs/mars/simulation.benchmark.tsv"
    params:
        config=as_json(MARS_SECTION),
        folder=MARS,
    shell:
        "python -m smallsat.mars simulate --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


rule mars_independent_check:
    input:
        sources=sources("smallsat.mars.__main__"),
    output:
        f"{MARS}/independent.parquet",
    log:
        "logs/mars/independent_check.log",
    benchmark:
        "logs/mars/independent_check.benchmark.tsv"
    params:
        config=as_json(MARS_SECTION),
        folder=MARS,
    shell:
        "python -m smallsat.mars check --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


rule mars_schematics:
    input:
        notebook=project("notebooks/mars/schematics.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources("smallsat.mars.schematics", "smallsat.report.figure", "smallsat.report.style"),
    output:
        figure_files(*[f"figures/mars/fig-{number}" for number in ("01", "02", "03", "09")]),
        notebook=f"{MARS}/notebooks/schematics.ipynb",
    log:
        "logs/mars/schematics.log",
    benchmark:
        "logs/mars/schematics.benchmark.tsv"
    params:
        parameters=as_json({"section": MARS_SECTION, "folder": "figures/mars"}),
    shell:
        NOTEBOOK


for name, figures in MARS_RESPONSES.items():

    rule:
        name:
            f"mars_{name}_figures"
        input:
            notebook=project("notebooks/mars/responses.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources(
                "smallsat.mars.response_plot",
                "smallsat.report.figure",
                "smallsat.report.style",
                "smallsat.results",
            ),
            trajectories=f"{MARS}/trajectories.parquet",
        output:
            figure_files(*[f"figures/mars/{figure}" for figure in figures]),
            notebook=f"{MARS}/notebooks/{name}.ipynb",
        log:
            f"logs/mars/{name}_figures.log",
        benchmark:
            f"logs/mars/{name}_figures.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "trajectories_path": f"{MARS}/trajectories.parquet",
                    "folder": "figures/mars",
                    "figures": figures,
                }
            ),
        shell:
            NOTEBOOK


for name, figures in MARS_SCENES.items():

    rule:
        name:
            f"mars_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/mars/scenes.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources(
                "smallsat.mars.scene",
                "smallsat.report.figure",
                "smallsat.report.style",
                "smallsat.results",
            ),
            trajectories=f"{MARS}/trajectories.parquet",
        output:
            figure_files(*[f"figures/mars/{figure}" for figure in figures]),
            notebook=f"{MARS}/notebooks/{name}.ipynb",
        log:
            f"logs/mars/{name}.log",
        benchmark:
            f"logs/mars/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": MARS_SECTION,
                    "trajectories_path": f"{MARS}/trajectories.parquet",
                    "folder": "figures/mars",
                    "figures": figures,
                }
            ),
        shell:
            NOTEBOOK


rule mars_day_modes:
    input:
        notebook=project("notebooks/mars/day-modes.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.mars.mode_plot",
            "smallsat.report.figure",
            "smallsat.report.style",
            "smallsat.results",
        ),
        intervals=f"{MARS}/modes.csv",
        shares=f"{MARS}/mode-shares.csv",
    output:
        figure_files("figures/mars/day-modes"),
        notebook=f"{MARS}/notebooks/day-modes.ipynb",
    log:
        "logs/mars/day_modes.log",
    benchmark:
        "logs/mars/day_modes.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "intervals_path": f"{MARS}/modes.csv",
                "shares_path": f"{MARS}/mode-shares.csv",
                "figure_path": "figures/mars/day-modes",
            }
        ),
    shell:
        NOTEBOOK


# The document's day-long film is an artefact; the mission's is mentioned in its text.
for film, run, step in (("1", "day", "day_step_s"), ("mission", "mission", "mission_step_s")):
    ANIMATIONS.append(f"figures/mars/animation-{film}.mp4")

    rule:
        name:
            f"mars_animation_{run}"
        input:
            sources=sources("smallsat.mars.animation"),
            trajectory=f"{MARS}/day.parquet" if run == "day" else f"{MARS}/trajectories.parquet",
        output:
            f"figures/mars/animation-{film}.mp4",
        log:
            f"logs/mars/animation_{run}.log",
        benchmark:
            f"logs/mars/animation_{run}.benchmark.tsv"
        params:
            config=as_json(MARS_SECTION),
            run=run,
            step=MARS_SECTION["animation"][step],
        shell:
            "python -m smallsat.mars.animation --config {params.config:q} --run {params.run}"
            " --step {params.step} {input.trajectory} {output} > {log} 2>&1"


rule mars:
    input:
        targets("mars", "table", "figure"),
        figure_files("figures/mars/day-modes"),
        f"{MARS}/mode-shares.csv",
        f"{MARS}/verdicts.csv",
        f"{MARS}/errata.csv",
        f"{MARS}/claims.csv",
    log:
        "logs/mars/mars.log",
