# Mars: pointing of a nano-satellite on its orbit around Mars.

MARS = "data/results/mars"
MARS_SECTION = config["mars"]

STUDY_RESULTS["mars"] = [
    f"{MARS}/observations.csv",
    f"{MARS}/trajectories.parquet",
    f"{MARS}/day.parquet",
    f"{MARS}/independent.parquet",
]

# Figures of each notebook run: few, so that one figure alone is made in seconds.
MARS_SCHEMATICS = {
    "mission-and-body": ["fig-01", "fig-02"],
    "angles-and-modes": ["fig-03", "fig-09"],
}
MARS_RESPONSES = {
    "no-torque": {"fig-04": "no torque"},
    "fixed-torque": {"fig-05": "fixed torque"},
    "sun": {"fig-06": "sun"},
    "nadir": {"fig-07": "nadir"},
    "gmo": {"fig-08": "gmo"},
    "mission": {"fig-10": "mission"},
}
# The number is the place among the mission's answer times.
MARS_SCENES = {
    "scenes-1-2": {"fig-11": 0, "fig-12": 1},
    "scenes-3-4": {"fig-13": 2, "fig-14": 3},
    "scene-5": {"fig-15": 4},
}
# A what-if run may have fewer answer times.
for name, figures in list(MARS_SCENES.items()):
    for figure, place in list(figures.items()):
        if place >= len(MARS_SECTION["answer_times_s"]["mission"]):
            LEFT_OUT.append(f"figures/mars/{figure}.svg")
            del figures[figure]
    if not figures:
        del MARS_SCENES[name]


rule mars_simulation:
    input:
        sources=sources("smallsat.studies.mars.steps"),
    output:
        multiext(
            f"{MARS}/",
            "trajectories.parquet",
            "day.parquet",
            "modes.csv",
            "mode-shares.csv",
            "observations.csv",
            "not-converged.csv",
        ),
    log:
        "logs/mars/simulation.log",
    benchmark:
        "logs/mars/simulation.benchmark.tsv"
    params:
        config=as_json(MARS_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "mars: fly every pointing mode, the mission and the day"
    shell:
        "python -m smallsat.studies.mars.steps simulate --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


rule mars_independent_check:
    input:
        sources=sources("smallsat.studies.mars.steps"),
    output:
        f"{MARS}/independent.parquet",
    log:
        "logs/mars/independent_check.log",
    benchmark:
        "logs/mars/independent_check.benchmark.tsv"
    params:
        config=as_json(MARS_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "mars: integrate everything again with quaternions"
    shell:
        "python -m smallsat.studies.mars.steps check --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


for name, figures in MARS_SCHEMATICS.items():

    rule:
        name:
            f"mars_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/mars/schematics.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources(
                "smallsat.studies.mars.figures.schematics", "smallsat.drawing.figure", "smallsat.drawing.style"
            ),
        output:
            figure_files(*[f"figures/mars/{figure}" for figure in figures]),
            notebook=f"{MARS}/notebooks/{name}.ipynb",
        log:
            f"logs/mars/{name}.log",
        benchmark:
            f"logs/mars/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {"section": MARS_SECTION, "folder": "figures/mars", "figures": figures}
            ),
        message:
            f"mars: draw {name}"
        shell:
            NOTEBOOK


for name, figures in MARS_RESPONSES.items():

    rule:
        name:
            f"mars_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/mars/responses.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources(
                "smallsat.studies.mars.figures.responses",
                "smallsat.drawing.figure",
                "smallsat.drawing.style",
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
                    "trajectories_path": f"{MARS}/trajectories.parquet",
                    "folder": "figures/mars",
                    "figures": figures,
                }
            ),
        message:
            f"mars: draw {name}"
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
                "smallsat.studies.mars.figures.scenes",
                "smallsat.drawing.figure",
                "smallsat.drawing.style",
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
        message:
            f"mars: draw {name}"
        shell:
            NOTEBOOK


rule mars_day_modes:
    input:
        notebook=project("notebooks/mars/day-modes.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.studies.mars.figures.day_modes",
            "smallsat.drawing.figure",
            "smallsat.drawing.style",
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
    message:
        "mars: draw the modes of a day"
    shell:
        NOTEBOOK


# The document's day-long film is an artefact; the mission's is mentioned in its text.
MARS_FILMS = {
    "day": ("animation-1", "day.parquet", "day_step_s"),
    "mission": ("animation-mission", "trajectories.parquet", "mission_step_s"),
}

for run, (film, trajectory, step) in MARS_FILMS.items():
    ANIMATIONS.append(f"figures/mars/{film}.mp4")

    rule:
        name:
            f"mars_film_{run}"
        input:
            notebook=project("notebooks/mars/animation.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources(
                "smallsat.studies.mars.figures.animation",
                "smallsat.drawing.film",
                "smallsat.drawing.style",
                "smallsat.results",
            ),
            trajectory=f"{MARS}/{trajectory}",
        output:
            f"figures/mars/{film}.mp4",
            notebook=f"{MARS}/notebooks/{film}.ipynb",
        log:
            f"logs/mars/{film}.log",
        benchmark:
            f"logs/mars/{film}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": MARS_SECTION,
                    "trajectory_path": f"{MARS}/{trajectory}",
                    "run": run,
                    "step": MARS_SECTION["animation"][step],
                    "film": f"figures/mars/{film}.mp4",
                }
            ),
        message:
            f"mars: film the {run}"
        shell:
            NOTEBOOK


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
    message:
        "mars: all tables, figures and verdicts are there"
