# Evidence: errata proven, claims and values judged, study by study; then all verdicts in one table.

LEDGERS = [file for study in STUDIES for file in published_files(study, "study.yaml", "values.csv")]
WHAT_IF = "" if RUN_FOLDER == "." else "--what-if"
FINDINGS = ("verdicts.csv", "errata.csv", "claims.csv")


for study in STUDIES:

    rule:
        name:
            f"{study}_verdicts"
        input:
            published=published_files(
                study,
                "values.csv",
                "rules.yaml",
                "bindings.yaml",
                "errata.yaml",
                "claims.yaml",
                # Some proofs compare captions.
                "artefacts.csv",
            ),
            # The judge loads a study's configuration, bindings, proofs and predicates by name.
            sources=sources(
                "smallsat.evidence.judge",
                f"smallsat.studies.{study}.configuration",
                *named_modules(PUBLISHED / study),
            ),
            results=results(study, *JUDGED[study]),
        output:
            results(study, *FINDINGS),
        log:
            f"logs/{study}/verdicts.log",
        benchmark:
            f"logs/{study}/verdicts.benchmark.tsv"
        priority: urgency(f"{study}_verdicts")
        params:
            study=study,
            published=lambda w, input: os.path.dirname(input.published[0]),
            config=as_json(CONFIG[study]),
        message:
            f"{study}: prove the errata, judge values and claims"
        shell:
            "python -m smallsat judge --config {params.config:q} --published {params.published}"
            " --results data/results/{params.study} > {log} 2>&1"

    # The printed tables, each cell with what we computed and its verdict.
    rule:
        name:
            f"{study}_tables"
        input:
            notebook=project("notebooks/tables.ipynb"),
            sources=sources(
                "smallsat.workflow.notebook", *notebook_modules(ROOT / "notebooks/tables.ipynb")
            ),
            artefacts=published_files(study, "artefacts.csv"),
            verdicts=results(study, "verdicts.csv"),
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
                    "artefacts": project(f"data/published/{study}/artefacts.csv"),
                    "verdicts": f"data/results/{study}/verdicts.csv",
                    "folder": ".",
                }
            ),
        message:
            f"{study}: write the tables, printed beside computed"
        shell:
            NOTEBOOK

    rule:
        name:
            study
        input:
            targets(study, "table", "figure"),
            [path for path in MADE[study] if path.startswith("data/results")],
            [f"{stem}.svg" for run in RUNS[study] for stem in run.stems],
            results(study, *FINDINGS),
            # A what-if ends with a report of its own, and what differs.
            [f"report/build/{study}-site"] * bool(WHAT_IF),
        log:
            f"logs/{study}/all.log",
        message:
            f"{study}: all tables, figures and verdicts are there"
            + f"; {RUN_FOLDER}/report/build/{study}-site/index.html" * bool(WHAT_IF)


rule merge_verdicts:
    input:
        sources=sources("smallsat.evidence.merge"),
        verdicts=[f"data/results/{study}/verdicts.csv" for study in STUDIES],
    output:
        "data/results/verdicts.csv",
    log:
        "logs/merge_verdicts.log",
    benchmark:
        "logs/merge_verdicts.benchmark.tsv"
    message:
        "Put all verdicts into one table"
    shell:
        "python -m smallsat merge {input.verdicts} --output {output} > {log} 2>&1"


# Fails where a verdict is wrong, so that a build with a mismatch does not pass for one without. What
# it says ends a `make`, without Python being started for it once more.
rule accept_verdicts:
    input:
        sources=sources("smallsat.evidence.summary"),
        verdicts="data/results/verdicts.csv",
        ledgers=LEDGERS,
        not_converged=NOT_CONVERGED,
    output:
        "data/results/verdicts.accepted",
    log:
        "logs/accept_verdicts.log",
    benchmark:
        "logs/accept_verdicts.benchmark.tsv"
    params:
        published=lambda w, input: Path(input.ledgers[0]).parents[1],
        what_if=WHAT_IF,
    message:
        "Check that no verdict is wrong"
    shell:
        "python -m smallsat summary {input.verdicts} --published {params.published}"
        " {params.what_if} > {log} 2>&1 && cp {log} {output}"


# What `make test` looks at: every result of every study, without its figures and report.
rule results:
    input:
        "data/results/verdicts.csv",
        [path for made in MADE.values() for path in made if path.startswith("data/results")],
    log:
        "logs/results.log",
    message:
        "All results are there"


rule verdicts:
    input:
        "data/results/verdicts.csv",
    log:
        "logs/verdicts.log",
    message:
        "Verdicts: data/results/verdicts.csv"


# Has no output: it counts every time it is asked for, and of the reproduction says what has moved
# since the accepted results.
rule check:
    input:
        verdicts="data/results/verdicts.csv",
        ledgers=LEDGERS,
        not_converged=NOT_CONVERGED,
        findings=[path for study in STUDIES for path in results(study, *FINDINGS)],
    log:
        "logs/check.log",
    params:
        published=lambda w, input: Path(input.ledgers[0]).parents[1],
        what_if=WHAT_IF,
        command="summary" if WHAT_IF else "check",
    message:
        "Count the verdicts"
    shell:
        "python -m smallsat {params.command} {input.verdicts} --published {params.published}"
        " {params.what_if} | tee {log}; exit ${{PIPESTATUS[0]}}"
