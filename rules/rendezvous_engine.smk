# Rendezvous: the solvers compared on sampled programs, and the constraints between samples.

ENGINE_TABLES = ["data/results/rendezvous/solvers.csv", "data/results/rendezvous/constraints.csv"]
ENGINE_SECONDS = "data/results/rendezvous/solver-seconds.csv"


rule rendezvous_engine:
    input:
        sources=sources("smallsat.studies.rendezvous.methods.engine_checks"),
    output:
        ENGINE_TABLES,
        ENGINE_SECONDS,
    log:
        "logs/rendezvous/engine.log",
    benchmark:
        "logs/rendezvous/engine.benchmark.tsv"
    params:
        config=as_json(config["rendezvous"]),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "rendezvous: compare the solvers, look at the constraints between samples"
    shell:
        "python -m smallsat.studies.rendezvous.methods.engine_checks --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"
