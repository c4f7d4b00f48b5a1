# The report: its content collected from the results of a run, typeset as a PDF and written as a web site.
# It is built whatever the verdicts are, so that a wrong one can be read about. Each study has a report
# of its own, for a what-if that leaves the others as they are.
TEMPLATES = [
    project(path)
    for path in (
        *(
            path.relative_to(ROOT)
            for folder in ("parts", "chapters", "summaries", "pipeline")
            for path in sorted((ROOT / "report" / folder).glob("*.typ"))
        ),
        "report/style.css",
        "report/references.yaml",
        "CITATION.cff",
        "requirements.lock",
        # What the last chapter shows.
        "data/accepted/seconds.csv",
        *(
            path.relative_to(ROOT)
            for path in sorted((ROOT / "data/accepted/pipeline").glob("*.csv"))
        ),
    )
]
TIMINGS = [path for study in STUDIES for path in MADE[study] if Path(path).name == "timings.csv"]
REPORTS = {"report": STUDIES} | {study: [study] for study in STUDIES}

for report, shown in REPORTS.items():
    prefix, logs = ("", "logs") if report == "report" else (f"{report}_", f"logs/{report}")

    rule:
        name:
            f"{prefix}report_content"
        input:
            sources=sources("smallsat.report.content"),
            # The catalogue and the kinds of all values; what is shown beside them.
            published=LEDGERS
            + [
                project(path.relative_to(ROOT))
                for study in shown
                for path in sorted((PUBLISHED / study).glob("*"))
                if path.name in ("artefacts.csv", "extras.yaml")
            ],
            # Whether a study has a chapter and a summary stands in the content.
            chapters=[
                project(path.relative_to(ROOT))
                for folder in ("chapters", "summaries")
                for path in sorted((ROOT / "report" / folder).glob("*.typ"))
                if path.stem in shown
            ],
            verdicts=[] if prefix else "data/results/verdicts.csv",
            findings=[
                path
                for study in shown
                for path in results(
                    study,
                    *["verdicts.csv"] * bool(prefix),
                    "errata.csv",
                    "claims.csv",
                    "not-converged.csv",
                )
            ],
            timings=[path for path in TIMINGS if path.split("/")[2] in shown],
            tables=[report_tables(study) for study in shown],
            # The notebooks that draw them are listed in the report.
            figures=[report_figures(study) for study in shown],
        output:
            f"report/build/{report}.json",
        log:
            f"{logs}/report_content.log",
        benchmark:
            f"{logs}/report_content.benchmark.tsv"
        params:
            project=project("."),
            config=as_json(CONFIG),
            default=as_json(DEFAULT),
            left_out=as_json(LEFT_OUT),
            studies=f"--studies {report}" if prefix else "",
        message:
            f"Collect the content of the report: {', '.join(shown)}"
        shell:
            "python -m smallsat content --project {params.project} --config {params.config:q}"
            " --default {params.default:q} --left-out {params.left_out:q} {params.studies}"
            " --output {output} > {log} 2>&1"

    rule:
        name:
            f"{prefix}report"
        input:
            sources=sources("smallsat.report.typesetting"),
            template=project("report/report.typ"),
            parts=TEMPLATES,
            content=f"report/build/{report}.json",
            figures=[report_figures(study) for study in shown],
            # Comes with the report of a what-if run.
            comparisons=[f"report/build/{study}-comparison.html" for study in shown if WHAT_IF],
        output:
            f"report/build/{report}.pdf",
        log:
            f"{logs}/report.log",
        benchmark:
            f"{logs}/report.benchmark.tsv"
        params:
            project=lambda w, input: Path(input.template).parents[1],
        message:
            f"Typeset the report: {', '.join(shown)}"
        shell:
            "python -m smallsat typeset {input.content} --project {params.project}"
            " --output {output} > {log} 2>&1"

    # The pages link figures, notebooks, comparisons and the PDF, which are there when the report is.
    rule:
        name:
            f"{prefix}site"
        input:
            sources=sources(
                "smallsat.site.pages",
                *[
                    f"smallsat.studies.{study}.{module}"
                    for study in SCENES
                    if study in shown
                    for module in ("configuration", "figures.interactive")
                ],
            ),
            content=f"report/build/{report}.json",
            report=f"report/build/{report}.pdf",
            template=project("report/report.typ"),
            parts=TEMPLATES,
            pages=[
                project(path.relative_to(ROOT))
                for path in sorted((ROOT / "report/site").glob("*.*"))
            ],
            published=[
                project(path.relative_to(ROOT))
                for path in sorted(PUBLISHED.glob("*/*.*"))
                if path.suffix in (".yaml", ".csv")
            ],
            drawings=[project(f"notebooks/{study}/figures.yaml") for study in shown],
            findings=[path for study in shown for path in results(study, *FINDINGS)],
            results=[
                path
                for study in SCENES
                if study in shown
                for path in results(study, *SCENES[study])
            ],
        output:
            directory(f"report/build/{prefix.replace('_', '-')}site"),
        log:
            f"{logs}/site.log",
        benchmark:
            f"{logs}/site.benchmark.tsv"
        params:
            project=lambda w, input: Path(input.template).parents[1],
        message:
            f"Write the web site, report/build/{prefix.replace('_', '-')}site"
        shell:
            "python -m smallsat site {input.content} --project {params.project} --output {output}"
            " > {log} 2>&1"


# A what-if run ends with what differs from the reproduction, or from its accepted results where it is
# not built.
if WHAT_IF:

    rule changes:
        input:
            sources=sources("smallsat.workflow.changes"),
        output:
            "changes.json",
        log:
            "logs/changes.log",
        params:
            config=as_json(CONFIG),
            default=as_json(DEFAULT),
        message:
            "Write down what this run changes"
        shell:
            "python -m smallsat changes --config {params.config:q} --default {params.default:q}"
            " --output {output} > {log} 2>&1"

    for study in STUDIES:

        rule:
            name:
                f"compare_{study}"
            input:
                sources=sources("smallsat.site.comparison"),
                changes="changes.json",
                pages=[
                    project(f"report/{name}")
                    for name in ("style.css", "site/site.css", "site/comparison.html.j2")
                ],
                published=published_files(
                    study, "values.csv", "errata.yaml", "claims.yaml", "artefacts.csv"
                ),
                results=results(study, *FINDINGS, "not-converged.csv"),
                figures=[f"{stem}.csv" for run in RUNS[study] for stem in run.stems],
                reproduction=[
                    project(path)
                    for path in (
                        *results(study, *FINDINGS),
                        *[f"{stem}.csv" for run in FIGURES[study] for stem in run.stems],
                    )
                    if (ROOT / path).exists()
                ],
            output:
                f"report/build/{study}-comparison.html",
            log:
                f"logs/report/{study}-comparison.log",
            params:
                study=study,
                project=lambda w, input: Path(input.pages[0]).parents[1],
            message:
                f"Compare with the reproduction: report/build/{study}-comparison.html"
            shell:
                "python -m smallsat compare . --study {params.study} --project {params.project}"
                " --output {output} | tee {log}"


rule animations:
    input:
        ANIMATIONS,
    log:
        "logs/animations.log",
    message:
        "All films are there"
