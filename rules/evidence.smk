# Evidence: errata proven, claims and values judged, study by study; then all verdicts in one table.


def evidence_modules(study):
    """Modules with a study's proofs and predicates, which the judge loads by name."""
    return [f"smallsat.{study}.errata", f"smallsat.{study}.claims"]


rule judge:
    input:
        ledger=project("data/published/values.csv"),
        entries=lambda w: [
            project(f"data/published/{w.study}/{name}.yaml")
            for name in ("rules", "bindings", "errata", "claims")
        ],
        sources=lambda w: sources("smallsat.evidence.__main__", *evidence_modules(w.study)),
        results=lambda w: STUDY_RESULTS[w.study],
    output:
        errata="data/results/{study}/errata.csv",
        claims="data/results/{study}/claims.csv",
        verdicts="data/results/{study}/verdicts.csv",
    wildcard_constraints:
        study="|".join(STUDIES),
    params:
        published=project("data/published"),
        config=as_json({key: value for key, value in config.items() if key != "run"}),
    log:
        "logs/{study}/judge.log",
    benchmark:
        "logs/{study}/judge.benchmark.tsv"
    shell:
        "python -m smallsat.evidence study {wildcards.study} --config {params.config:q}"
        " --published {params.published} --results data/results/{wildcards.study} > {log} 2>&1"


rule merge_verdicts:
    input:
        ledger=project("data/published/values.csv"),
        sources=sources("smallsat.evidence.__main__"),
        verdicts=[f"data/results/{study}/verdicts.csv" for study in STUDIES],
    output:
        "data/results/verdicts.csv",
    params:
        published=project("data/published"),
    log:
        "logs/merge_verdicts.log",
    benchmark:
        "logs/merge_verdicts.benchmark.tsv"
    shell:
        "python -m smallsat.evidence merge --published {params.published} --output {output}"
        " {input.verdicts} > {log} 2>&1"


# Fails where a verdict is wrong, so that a build with a mismatch does not pass for one without.
rule accept_verdicts:
    input:
        "data/results/verdicts.csv",
    output:
        touch("data/results/verdicts.accepted"),
    params:
        published=project("data/published"),
        what_if="" if RUN_FOLDER == "." else "--what-if",
    log:
        "logs/accept_verdicts.log",
    benchmark:
        "logs/accept_verdicts.benchmark.tsv"
    shell:
        "python -m smallsat.evidence summary {input} --published {params.published}"
        " {params.what_if} > {log} 2>&1"


rule verdicts:
    input:
        "data/results/verdicts.csv",
    log:
        "logs/verdicts.log",


# Has no output: it prints the summary every time it is asked for.
rule check:
    input:
        "data/results/verdicts.csv",
    params:
        published=project("data/published"),
        what_if="" if RUN_FOLDER == "." else "--what-if",
    log:
        "logs/check.log",
    shell:
        "python -m smallsat.evidence summary {input} --published {params.published}"
        " {params.what_if} | tee {log}; exit ${{PIPESTATUS[0]}}"


# The printed tables, each cell with what we computed and its verdict.
rule tables:
    input:
        notebook=project("notebooks/tables.ipynb"),
        sources=NOTEBOOK_SOURCES + sources("smallsat.evidence.ledger", "smallsat.results"),
        ledger=project("data/published/values.csv"),
        artefacts=project("data/published/artefacts.csv"),
        verdicts="data/results/{study}/verdicts.csv",
    output:
        "data/results/{study}/tables/{table}.csv",
        notebook="data/results/{study}/notebooks/{table}.ipynb",
    wildcard_constraints:
        study="|".join(STUDIES),
        table=r"table-\d+",
    params:
        parameters=lambda w, input, output: as_json(
            {
                "document": w.study,
                "target": f"data/results/{w.study}/tables/{w.table}.csv",
                "ledger": input.ledger,
                "artefacts": input.artefacts,
                "verdicts": input.verdicts,
            }
        ),
    log:
        "logs/{study}/{table}.log",
    benchmark:
        "logs/{study}/{table}.benchmark.tsv"
    shell:
        NOTEBOOK
