# Rendezvous, chapters 4 and 5 and appendix A: many manoeuvres, group by group, in shards.

STUDIES_FOLDER = "data/results/rendezvous/studies"
STUDIES_SECTION = config["rendezvous"]
SHARDS = STUDIES_SECTION["studies"]["shards"]
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
STUDY_SOURCES = sources("smallsat.rendezvous.studies")


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
        folder=STUDIES_FOLDER,
    message:
        "rendezvous: draw the initial states"
    shell:
        "python -m smallsat.rendezvous.studies states --config {params.config:q}"
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
                folder=STUDIES_FOLDER,
            message:
                f"rendezvous: fly {group}, shard {shard} of {SHARDS}"
            shell:
                "python -m smallsat.rendezvous.studies shard {params.group}"
                " --shard {params.shard} --shards {params.shards} --config {params.config:q}"
                " --folder {params.folder} --output {output} > {log} 2>&1"

    rule:
        name:
            f"rendezvous_{group.replace('-', '_')}"
        input:
            sources=sources("smallsat.rendezvous.shards"),
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
            "python -m smallsat.rendezvous.studies merge {params.group} {input.shards}"
            " --output {output} > {log} 2>&1"
