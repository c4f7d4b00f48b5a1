# Rendezvous, chapters 4 and 5 and appendix A: many manoeuvres, group by group, in shards.

STUDIES_FOLDER = "data/results/rendezvous/studies"
STUDIES_SETTINGS = config["rendezvous"]["studies"]
SHARDS = STUDIES_SETTINGS["shards"]
# What the manoeuvres depend on: a change of anything else flies none of them anew.
STUDIES_SECTION = {
    name: config["rendezvous"][name]
    for name in ("spacecraft", "start", "port_m", "phases", "inferred", "truth")
} | {
    "studies": {
        name: value
        for name, value in STUDIES_SETTINGS.items()
        if name not in ("bootstrap", "shards")
    }
}
STUDY_GROUPS = [
    "domain",
    "rendezvous-sweep",
    "approach-sweep",
    "docking-sweep",
    "weights",
    "delay",
    "prediction",
    "robustness",
    "passages",
]
# Phases that begin where the baseline ended the phase before.
STUDY_STARTS = {
    "approach-sweep": "domain.parquet",
    "docking-sweep": "domain.parquet",
    "prediction": "disturbed-states.parquet",
    "robustness": "disturbed-states.parquet",
    "passages": "disturbed-states.parquet",
}
STUDY_TABLES = [f"{STUDIES_FOLDER}/{group}.parquet" for group in STUDY_GROUPS]
STUDY_SOURCES = sources("smallsat.studies.rendezvous.monte_carlo.studies")
STUDY_SUMMARIES = [
    f"{STUDIES_FOLDER}/{name}.csv"
    for name in (
        "variants",
        "bounce",
        "deviations",
        "infeasible",
        "thrust-readings",
        "thrust-errors",
    )
]
# What verdicts, errata and claims read.
STUDY_STATES = f"{STUDIES_FOLDER}/initial-states.parquet"
STUDIES_JUDGED = [*STUDY_TABLES, STUDY_STATES]
# Figures of each phase's sweep by horizon.
SWEEP_FIGURES = {
    "rendezvous": {15: "fig-4-4", 30: "fig-4-5", 45: "fig-4-6"},
    "approach": {5: "fig-4-7", 15: "fig-4-8", 30: "fig-4-9"},
    "docking": {5: "fig-4-10", 12: "fig-4-11", 30: "fig-4-12"},
}
DOMAIN_FIGURES = {
    "baseline": {"positions": "fig-4-1", "quadrants": "fig-4-2", "distances": "fig-4-3"},
    "no set point": {"quadrants": "fig-a-1", "distances": "fig-a-2", "costs": "fig-a-3"},
    "LP": {"quadrants": "fig-a-4", "distances": "fig-a-5", "costs": "fig-a-6"},
}
ROBUSTNESS_FIGURES = ["fig-5-1", "fig-5-2", "bounce"]
VARIANT_FIGURES = ["weights", "delay", "prediction", "disturbances"]
STUDIES_BEYOND = ["sweeps", "bounce", *VARIANT_FIGURES]
STUDY_DRAWING = NOTEBOOK_SOURCES + sources(
    "smallsat.studies.rendezvous.figures.sensitivity",
    "smallsat.studies.rendezvous.figures.robustness",
    "smallsat.studies.rendezvous.evidence.robustness_claims",
    "smallsat.drawing.figure",
    "smallsat.drawing.style",
    "smallsat.results",
)
# A what-if run may have fewer horizons.
LEFT_OUT += [
    f"figures/rendezvous/{figure}.svg"
    for phase, figures in SWEEP_FIGURES.items()
    for horizon, figure in figures.items()
    if horizon not in STUDIES_SETTINGS[phase]["horizons"]
]
SWEEP_FIGURES = {
    phase: {
        str(horizon): figure
        for horizon, figure in figures.items()
        if horizon in STUDIES_SETTINGS[phase]["horizons"]
    }
    for phase, figures in SWEEP_FIGURES.items()
}


rule rendezvous_states:
    input:
        sources=STUDY_SOURCES,
    output:
        f"{STUDIES_FOLDER}/initial-states.parquet",
        f"{STUDIES_FOLDER}/disturbed-states.parquet",
    log:
        "logs/rendezvous/states.log",
    benchmark:
        "logs/rendezvous/states.benchmark.tsv"
    params:
        config=as_json(STUDIES_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: draw the initial states"
    shell:
        "python -m smallsat.studies.rendezvous.monte_carlo.studies states --config {params.config:q}"
        " --folder {params.folder} > {log} 2>&1"


for group in STUDY_GROUPS:

    for shard in range(1, SHARDS + 1):

        rule:
            name:
                f"rendezvous_{group.replace('-', '_')}_{shard}"
            input:
                sources=STUDY_SOURCES,
                starts=f"{STUDIES_FOLDER}/{STUDY_STARTS.get(group, 'initial-states.parquet')}",
            output:
                f"{STUDIES_FOLDER}/shards/{group}-{shard}-of-{SHARDS}.parquet",
            log:
                f"logs/rendezvous/{group}-{shard}.log",
            benchmark:
                f"logs/rendezvous/{group}-{shard}.benchmark.tsv"
            params:
                group=group,
                shard=shard,
                shards=SHARDS,
                config=as_json(STUDIES_SECTION),
                folder=lambda _, input: os.path.dirname(input.starts),
            message:
                f"rendezvous: fly {group}, shard {shard} of {SHARDS}"
            shell:
                "python -m smallsat.studies.rendezvous.monte_carlo.studies shard {params.group}"
                " --shard {params.shard} --shards {params.shards} --config {params.config:q}"
                " --folder {params.folder} --output {output} > {log} 2>&1"

    rule:
        name:
            f"rendezvous_{group.replace('-', '_')}"
        input:
            sources=STUDY_SOURCES,
            shards=[
                f"{STUDIES_FOLDER}/shards/{group}-{shard}-of-{SHARDS}.parquet"
                for shard in range(1, SHARDS + 1)
            ],
        output:
            f"{STUDIES_FOLDER}/{group}.parquet",
        log:
            f"logs/rendezvous/{group}.log",
        benchmark:
            f"logs/rendezvous/{group}.benchmark.tsv"
        params:
            group=group,
        message:
            f"rendezvous: join the shards of {group}"
        shell:
            "python -m smallsat.studies.rendezvous.monte_carlo.studies merge {params.group} {input.shards}"
            " --output {output} > {log} 2>&1"


rule rendezvous_summaries:
    input:
        sources=sources("smallsat.studies.rendezvous.monte_carlo.summaries"),
        tables=STUDY_TABLES,
    output:
        STUDY_SUMMARIES,
    log:
        "logs/rendezvous/summaries.log",
    benchmark:
        "logs/rendezvous/summaries.benchmark.tsv"
    params:
        config=as_json(STUDIES_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: summarise the studies"
    shell:
        "python -m smallsat.studies.rendezvous.monte_carlo.summaries --config {params.config:q}"
        " --folder {params.folder} > {log} 2>&1"


for case, figures in DOMAIN_FIGURES.items():

    rule:
        name:
            f"rendezvous_domain_{case.lower().replace(' ', '_')}_figures"
        input:
            notebook=project("notebooks/rendezvous/domain.ipynb"),
            sources=STUDY_DRAWING,
            tables=[STUDY_STATES, f"{STUDIES_FOLDER}/domain.parquet"],
        output:
            figure_files(*[f"figures/rendezvous/{figure}" for figure in figures.values()]),
            notebook=f"data/results/rendezvous/notebooks/domain-{case.lower().replace(' ', '-')}.ipynb",
        log:
            f"logs/rendezvous/domain-{case.lower().replace(' ', '-')}-figures.log",
        benchmark:
            f"logs/rendezvous/domain-{case.lower().replace(' ', '-')}-figures.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "results": STUDIES_FOLDER,
                    "folder": "figures/rendezvous",
                    "case": case,
                    "figures": figures,
                }
            ),
        message:
            f"rendezvous: draw the domain, {case}"
        shell:
            NOTEBOOK


for phase, figures in SWEEP_FIGURES.items():

    rule:
        name:
            f"rendezvous_{phase}_sweep_figures"
        input:
            notebook=project("notebooks/rendezvous/sweep.ipynb"),
            sources=STUDY_DRAWING,
            table=f"{STUDIES_FOLDER}/{phase}-sweep.parquet",
        output:
            figure_files(*[f"figures/rendezvous/{figure}" for figure in figures.values()]),
            notebook=f"data/results/rendezvous/notebooks/{phase}-sweep.ipynb",
        log:
            f"logs/rendezvous/{phase}-sweep-figures.log",
        benchmark:
            f"logs/rendezvous/{phase}-sweep-figures.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "results": STUDIES_FOLDER,
                    "folder": "figures/rendezvous",
                    "phase": phase,
                    "sample_times": STUDIES_SETTINGS[phase]["sample_times_s"],
                    "figures": figures,
                }
            ),
        message:
            f"rendezvous: draw the sweep of the {phase} phase"
        shell:
            NOTEBOOK


rule rendezvous_sweep_summary:
    input:
        notebook=project("notebooks/rendezvous/sweep-summary.ipynb"),
        sources=STUDY_DRAWING,
        tables=[f"{STUDIES_FOLDER}/{phase}-sweep.parquet" for phase in SWEEP_FIGURES],
    output:
        figure_files("figures/rendezvous/sweeps"),
        notebook="data/results/rendezvous/notebooks/sweep-summary.ipynb",
    log:
        "logs/rendezvous/sweep-summary.log",
    benchmark:
        "logs/rendezvous/sweep-summary.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "results": STUDIES_FOLDER,
                "figure_path": "figures/rendezvous/sweeps",
                "settings": {phase: STUDIES_SETTINGS[phase] for phase in SWEEP_FIGURES},
            }
        ),
    message:
        "rendezvous: draw all sweeps on one page"
    shell:
        NOTEBOOK


rule rendezvous_robustness_figures:
    input:
        notebook=project("notebooks/rendezvous/robustness.ipynb"),
        sources=STUDY_DRAWING,
        tables=[
            f"{STUDIES_FOLDER}/{name}"
            for name in ("robustness.parquet", "bounce.csv", "thrust-errors.csv")
        ],
    output:
        figure_files(*[f"figures/rendezvous/{figure}" for figure in ROBUSTNESS_FIGURES]),
        notebook="data/results/rendezvous/notebooks/robustness.ipynb",
    log:
        "logs/rendezvous/robustness-figures.log",
    benchmark:
        "logs/rendezvous/robustness-figures.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "results": STUDIES_FOLDER,
                "folder": "figures/rendezvous",
                "end_distance": config["rendezvous"]["inferred"]["end_distance_m"],
            }
        ),
    message:
        "rendezvous: draw the disturbed manoeuvres"
    shell:
        NOTEBOOK


rule rendezvous_variant_figures:
    input:
        notebook=project("notebooks/rendezvous/variants.ipynb"),
        sources=STUDY_DRAWING,
        table=f"{STUDIES_FOLDER}/variants.csv",
    output:
        figure_files(*[f"figures/rendezvous/{figure}" for figure in VARIANT_FIGURES]),
        notebook="data/results/rendezvous/notebooks/variants.ipynb",
    log:
        "logs/rendezvous/variant-figures.log",
    benchmark:
        "logs/rendezvous/variant-figures.benchmark.tsv"
    params:
        parameters=as_json(
            {
                "results": STUDIES_FOLDER,
                "folder": "figures/rendezvous",
                "topics": VARIANT_FIGURES,
            }
        ),
    message:
        "rendezvous: draw what goes beyond the document"
    shell:
        NOTEBOOK
