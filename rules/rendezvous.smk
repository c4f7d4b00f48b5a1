# Rendezvous: three-phase model predictive control, its cases and its undisclosed parameters.

RENDEZVOUS = "data/results/rendezvous"
RENDEZVOUS_SECTION = config["rendezvous"]
# What the cases and the inference depend on; other studies of the section do not rerun them.
RENDEZVOUS_CASES = {
    key: RENDEZVOUS_SECTION[key]
    for key in (
        "spacecraft",
        "start",
        "port_m",
        "cone_faces",
        "target_eccentricity",
        "phases",
        "inferred",
        "inference",
        "truth",
    )
}

RENDEZVOUS_FLIGHTS = [
    "flights.parquet",
    "paths.parquet",
    "phases.csv",
    "truth.csv",
]
RENDEZVOUS_INFERRED = [
    "inference.parquet",
    "residuals.csv",
    "identified.csv",
    "profiles.csv",
    "readings.csv",
    "ensemble.csv",
    "lp-variants.csv",
]

STUDY_RESULTS["rendezvous"] = (
    [
        f"{RENDEZVOUS}/{name}"
        for name in ["observations.csv", *RENDEZVOUS_FLIGHTS, *RENDEZVOUS_INFERRED]
    ]
    + ENGINE_TABLES
    + STUDIES_JUDGED
)

# Figures of each notebook run: few, so that one figure alone is made in seconds.
RENDEZVOUS_SCHEMATICS = ["fig-2-1", "fig-2-2", "fig-3-1", "fig-3-2"]
RENDEZVOUS_FIGURES = {
    "case-1": ("fig-3-3", "v-bar"),
    "case-2": ("fig-3-4", "r-bar"),
    "case-3": ("fig-3-5", "rotating"),
    "comparison": ("fig-3-6", "comparison"),
}
RENDEZVOUS_BEYOND = ["residuals", "profiles", "readings"]
RENDEZVOUS_DRAWING = NOTEBOOK_SOURCES + sources(
    "smallsat.studies.rendezvous.figures.cases",
    "smallsat.studies.rendezvous.figures.schematics",
    "smallsat.drawing.figure",
    "smallsat.drawing.style",
    "smallsat.results",
)


rule rendezvous_flights:
    input:
        sources=sources("smallsat.studies.rendezvous.steps"),
    output:
        [f"{RENDEZVOUS}/{name}" for name in RENDEZVOUS_FLIGHTS],
    log:
        "logs/rendezvous/flights.log",
    benchmark:
        "logs/rendezvous/flights.benchmark.tsv"
    params:
        config=as_json(RENDEZVOUS_CASES),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: fly the cases"
    shell:
        "python -m smallsat.studies.rendezvous.steps fly --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


# One search for each side of the R-bar, so that two cores have one each.
for side in ("above", "below"):

    rule:
        name:
            f"rendezvous_search_{side}"
        input:
            sources=sources("smallsat.studies.rendezvous.steps"),
        output:
            f"{RENDEZVOUS}/search-{side}.parquet",
        log:
            f"logs/rendezvous/search-{side}.log",
        benchmark:
            f"logs/rendezvous/search-{side}.benchmark.tsv"
        params:
            side=side,
            config=as_json(RENDEZVOUS_CASES),
            folder=lambda _, output: os.path.dirname(output[0]),
        message:
            f"rendezvous: search undisclosed parameters, R-bar from {side}"
        shell:
            "python -m smallsat.studies.rendezvous.steps search --side {params.side} --config {params.config:q}"
            " --output-folder {params.folder} > {log} 2>&1"


rule rendezvous_inference:
    input:
        sources=sources("smallsat.studies.rendezvous.steps"),
        searches=[f"{RENDEZVOUS}/search-{side}.parquet" for side in ("above", "below")],
    output:
        [f"{RENDEZVOUS}/{name}" for name in RENDEZVOUS_INFERRED],
    log:
        "logs/rendezvous/inference.log",
    benchmark:
        "logs/rendezvous/inference.benchmark.tsv"
    params:
        config=as_json(RENDEZVOUS_CASES),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: what the tables identify, and what they leave open"
    shell:
        "python -m smallsat.studies.rendezvous.steps infer --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


rule rendezvous_observations:
    input:
        sources=sources("smallsat.studies.rendezvous.steps"),
        phases=f"{RENDEZVOUS}/phases.csv",
        flights=f"{RENDEZVOUS}/flights.parquet",
        studies=STUDIES_JUDGED,
    output:
        f"{RENDEZVOUS}/observations.csv",
        f"{RENDEZVOUS}/not-converged.csv",
    log:
        "logs/rendezvous/observations.log",
    benchmark:
        "logs/rendezvous/observations.benchmark.tsv"
    params:
        config=as_json(RENDEZVOUS_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: observe the published values"
    shell:
        "python -m smallsat.studies.rendezvous.steps observe --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


rule rendezvous_schematics:
    input:
        notebook=project("notebooks/rendezvous/schematics.ipynb"),
        sources=RENDEZVOUS_DRAWING,
        flights=f"{RENDEZVOUS}/flights.parquet",
        paths=f"{RENDEZVOUS}/paths.parquet",
    output:
        figure_files(*[f"figures/rendezvous/{figure}" for figure in RENDEZVOUS_SCHEMATICS]),
        notebook=f"{RENDEZVOUS}/notebooks/schematics.ipynb",
    log:
        "logs/rendezvous/schematics.log",
    benchmark:
        "logs/rendezvous/schematics.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "section": RENDEZVOUS_CASES,
                "results": RENDEZVOUS,
                "folder": "figures/rendezvous",
            }
        ),
    message:
        "rendezvous: draw the schematics"
    shell:
        NOTEBOOK


for name, (figure, case) in RENDEZVOUS_FIGURES.items():

    rule:
        name:
            f"rendezvous_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/rendezvous/case.ipynb"),
            sources=RENDEZVOUS_DRAWING,
            flights=f"{RENDEZVOUS}/flights.parquet",
            paths=f"{RENDEZVOUS}/paths.parquet",
        output:
            figure_files(f"figures/rendezvous/{figure}"),
            notebook=f"{RENDEZVOUS}/notebooks/{name}.ipynb",
        log:
            f"logs/rendezvous/{name}.log",
        benchmark:
            f"logs/rendezvous/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": RENDEZVOUS_CASES,
                    "results": RENDEZVOUS,
                    "case": case,
                    "figure_path": f"figures/rendezvous/{figure}",
                }
            ),
        message:
            f"rendezvous: draw {name}"
        shell:
            NOTEBOOK


rule rendezvous_inference_figures:
    input:
        notebook=project("notebooks/rendezvous/inference.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.studies.rendezvous.figures.inference",
            "smallsat.drawing.figure",
            "smallsat.drawing.style",
            "smallsat.results",
        ),
        tables=[f"{RENDEZVOUS}/{name}" for name in RENDEZVOUS_INFERRED],
    output:
        figure_files(*[f"figures/rendezvous/{figure}" for figure in RENDEZVOUS_BEYOND]),
        notebook=f"{RENDEZVOUS}/notebooks/inference.ipynb",
    log:
        "logs/rendezvous/inference-figures.log",
    benchmark:
        "logs/rendezvous/inference-figures.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "section": RENDEZVOUS_CASES,
                "results": RENDEZVOUS,
                "folder": "figures/rendezvous",
            }
        ),
    message:
        "rendezvous: draw the inference"
    shell:
        NOTEBOOK


ANIMATIONS.append("figures/rendezvous/animation-case-1.mp4")


rule rendezvous_film:
    input:
        notebook=project("notebooks/rendezvous/animation.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.studies.rendezvous.figures.animation",
            "smallsat.drawing.film",
            "smallsat.drawing.style",
            "smallsat.results",
        ),
        flights=f"{RENDEZVOUS}/flights.parquet",
        paths=f"{RENDEZVOUS}/paths.parquet",
    output:
        "figures/rendezvous/animation-case-1.mp4",
        notebook=f"{RENDEZVOUS}/notebooks/animation-case-1.ipynb",
    log:
        "logs/rendezvous/animation-case-1.log",
    benchmark:
        "logs/rendezvous/animation-case-1.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "section": RENDEZVOUS_CASES,
                "results": RENDEZVOUS,
                "film": "figures/rendezvous/animation-case-1.mp4",
            }
        ),
    message:
        "rendezvous: film Case 1"
    shell:
        NOTEBOOK


rule rendezvous:
    input:
        targets("rendezvous", "table", "figure"),
        figure_files(
            *[f"figures/rendezvous/{figure}" for figure in (*RENDEZVOUS_BEYOND, *STUDIES_BEYOND)]
        ),
        STUDY_SUMMARIES,
        STUDY_RESULTS["rendezvous"],
        f"{RENDEZVOUS}/verdicts.csv",
        f"{RENDEZVOUS}/errata.csv",
        f"{RENDEZVOUS}/claims.csv",
    log:
        "logs/rendezvous/rendezvous.log",
    message:
        "rendezvous: all tables, figures and verdicts are there"
