# Evidence: errata proven, claims and values judged, study by study; then all verdicts in one table.


for study in STUDIES:

    rule:
        name:
            f"{study}_verdicts"
        input:
            ledger=project("data/published/values.csv"),
            entries=[
                project(f"data/published/{study}/{name}.yaml")
                for name in ("rules", "bindings", "errata", "claims")
            ],
            # Some proofs compare captions.
            artefacts=project("data/published/artefacts.csv"),
            # The judge loads a study's proofs and predicates by name.
            sources=sources("smallsat.evidence.__main__", *named_modules(study)),
            results=STUDY_RESULTS[study],
        output:
            errata=f"data/results/{study}/errata.csv",
            claims=f"data/results/{study}/claims.csv",
            verdicts=f"data/results/{study}/verdicts.csv",
        log:
            f"logs/{study}/verdicts.log",
        benchmark:
            f"logs/{study}/verdicts.benchmark.tsv"
        params:
            study=study,
            published=lambda w, input: os.path.dirname(input.ledger),
            config=as_json({study: config[study]}),
        message:
            f"{study}: prove the errata, judge values and claims"
        shell:
            "python -m smallsat.evidence study {params.study} --config {params.config:q}"
            " --published {params.published} --results data/results/{params.study} > {log} 2>&1"

    # The printed tables, each cell with what we computed and its verdict.
    rule:
        name:
            f"{study}_tables"
        input:
            notebook=project("notebooks/tables.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources("smallsat.evidence.ledger", "smallsat.results", "smallsat.report.values"),
            artefacts=project("data/published/artefacts.csv"),
            verdicts=f"data/results/{study}/verdicts.csv",
        output:
            targets(study, "table"),
            notebook=f"data/results/{study}/notebooks/tables.ipynb",
        log:
            f"logs/{study}/tables.log",
        benchmark:
            f"logs/{study}/tables.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "document": study,
                    "artefacts_path": project("data/published/artefacts.csv"),
                    "verdicts_path": f"data/results/{study}/verdicts.csv",
                }
            ),
        message:
            f"{study}: write the tables, printed beside computed"
        shell:
            NOTEBOOK


rule merge_verdicts:
    input:
        ledger=project("data/published/values.csv"),
        sources=sources("smallsat.evidence.__main__"),
        verdicts=[f"data/results/{study}/verdicts.csv" for study in STUDIES],
    output:
        "data/results/verdicts.csv",
    log:
        "logs/merge_verdicts.log",
    benchmark:
        "logs/merge_verdicts.benchmark.tsv"
    params:
        published=lambda w, input: os.path.dirname(input.ledger),
    message:
        "Put all verdicts into one table"
    shell:
        "python -m smallsat.evidence merge --published {params.published} --output {output}"
        " {input.verdicts} > {log} 2>&1"


# Fails where a verdict is wrong, so that a build with a mismatch does not pass for one without.
rule accept_verdicts:
    input:
        verdicts="data/results/verdicts.csv",
        ledger=project("data/published/values.csv"),
        not_converged=NOT_CONVERGED,
    output:
        touch("data/results/verdicts.accepted"),
    log:
        "logs/accept_verdicts.log",
    benchmark:
        "logs/accept_verdicts.benchmark.tsv"
    params:
        published=lambda w, input: os.path.dirname(input.ledger),
        what_if="" if RUN_FOLDER == "." else "--what-if",
    message:
        "Check that no verdict is wrong"
    shell:
        "python -m smallsat.evidence summary {input.verdicts} --published {params.published}"
        " {params.what_if} > {log} 2>&1"


rule verdicts:
    input:
        "data/results/verdicts.csv",
    log:
        "logs/verdicts.log",
    message:
        "Verdicts: data/results/verdicts.csv"


# Has no output: it prints the summary every time it is asked for.
rule check:
    input:
        verdicts="data/results/verdicts.csv",
        ledger=project("data/published/values.csv"),
        not_converged=NOT_CONVERGED,
    log:
        "logs/check.log",
    params:
        published=lambda w, input: os.path.dirname(input.ledger),
        what_if="" if RUN_FOLDER == "." else "--what-if",
    message:
        "Count the verdicts"
    shell:
        "python -m smallsat.evidence summary {input.verdicts} --published {params.published}"
        " {params.what_if} | tee {log}; exit ${{PIPESTATUS[0]}}"
