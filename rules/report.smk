# The report: its content collected from the results, then typeset as a PDF and as a web page.
# It is built whatever the verdicts are, so that a wrong one can be read about.
FIGURES = [figure for study in STUDIES for figure in report_figures(study)]
TABLES = [table for study in STUDIES for table in targets(study, "table") + extra_tables(study)]
# The text of each study's method.
CHAPTERS = [
    project(path) for study in STUDIES if (ROOT / (path := f"report/chapters/{study}.typ")).exists()
]
# Seconds, the only results that differ from run to run.
STUDY_TIMINGS = [f"data/results/{study}/timings.csv" for study in ("transfer", "slew", "racing")]


rule report_content:
    input:
        sources=sources("smallsat.report.__main__", "smallsat.report.content"),
        published=[project(f"data/published/{name}.csv") for name in ("values", "artefacts")],
        extras=[project(f"data/published/{study}/extras.yaml") for study in EXTRAS],
        documents=project("report/documents.yaml"),
        chapters=CHAPTERS,
        default=project("config/default.yaml"),
        verdicts="data/results/verdicts.csv",
        findings=[
            f"data/results/{study}/{name}.csv"
            for study in STUDIES
            for name in ("errata", "claims")
        ],
        not_converged=NOT_CONVERGED,
        timings=STUDY_TIMINGS,
        tables=TABLES,
        # The notebooks that draw them are listed in the report.
        figures=FIGURES,
    output:
        "report/build/content.json",
    log:
        "logs/report/content.log",
    benchmark:
        "logs/report/content.benchmark.tsv"
    params:
        project=lambda _, input: Path(input.documents).parent.parent,
        config=as_json(config),
        left_out=as_json(LEFT_OUT),
    message:
        "Collect the content of the report"
    shell:
        "python -m smallsat.report content --project {params.project} --config {params.config:q}"
        " --left-out {params.left_out:q} --output {output} > {log} 2>&1"


TEMPLATES = [
    project(path.relative_to(ROOT))
    for path in sorted((ROOT / "report").rglob("*"))
    if path.suffix in (".typ", ".css") and path.name != "report.typ"
]
TYPESET = (
    "(python -m smallsat.report compile {input.content} --project {params.project}"
    " --output {output.pdf}"
    " && python -m smallsat.report compile {input.content} --project {params.project}"
    " --output {output.html}) > {log} 2>&1"
)


rule report:
    input:
        sources=sources("smallsat.report.__main__", "smallsat.report.typesetting"),
        template=project("report/report.typ"),
        parts=TEMPLATES,
        content="report/build/content.json",
        # The page shows the SVG, the PDF takes in the PDF.
        figures=FIGURES,
        drawings=[str(Path(figure).with_suffix(".pdf")) for figure in FIGURES],
    output:
        pdf="report/build/report.pdf",
        html="report/build/report.html",
    log:
        "logs/report/report.log",
    benchmark:
        "logs/report/report.benchmark.tsv"
    params:
        project=lambda _, input: Path(input.template).parent.parent,
    message:
        "Typeset the report: report/build/report.pdf and report.html"
    shell:
        TYPESET


# The report of one study alone, for a what-if that leaves the others as they are.
for study in STUDIES:

    rule:
        name:
            f"{study}_report_content"
        input:
            sources=sources("smallsat.report.__main__", "smallsat.report.content"),
            published=[project(f"data/published/{name}.csv") for name in ("values", "artefacts")],
            extras=[
                project(f"data/published/{name}/extras.yaml") for name in EXTRAS if name == study
            ],
            documents=project("report/documents.yaml"),
            chapters=CHAPTERS,
            default=project("config/default.yaml"),
            findings=[
                f"data/results/{study}/{name}.csv"
                for name in ("verdicts", "errata", "claims", "not-converged")
            ],
            timings=[path for path in STUDY_TIMINGS if f"/{study}/" in path],
            tables=targets(study, "table") + extra_tables(study),
            figures=report_figures(study),
        output:
            f"report/build/{study}.json",
        log:
            f"logs/report/{study}-content.log",
        benchmark:
            f"logs/report/{study}-content.benchmark.tsv"
        params:
            project=lambda _, input: Path(input.documents).parent.parent,
            config=as_json(config),
            left_out=as_json(LEFT_OUT),
            study=study,
        message:
            f"{study}: collect the content of its report"
        shell:
            "python -m smallsat.report content --project {params.project} --config {params.config:q}"
            " --left-out {params.left_out:q} --studies {params.study} --output {output}"
            " > {log} 2>&1"

    rule:
        name:
            f"{study}_report"
        input:
            sources=sources("smallsat.report.__main__", "smallsat.report.typesetting"),
            template=project("report/report.typ"),
            parts=TEMPLATES,
            content=f"report/build/{study}.json",
            figures=report_figures(study),
            drawings=[str(Path(figure).with_suffix(".pdf")) for figure in report_figures(study)],
        output:
            pdf=f"report/build/{study}.pdf",
            html=f"report/build/{study}.html",
        log:
            f"logs/report/{study}.log",
        benchmark:
            f"logs/report/{study}.benchmark.tsv"
        params:
            project=lambda _, input: Path(input.template).parent.parent,
        message:
            f"{study}: typeset its report: report/build/{study}.pdf and {study}.html"
        shell:
            TYPESET


rule animations:
    input:
        ANIMATIONS,
    log:
        "logs/animations.log",
    message:
        "All films are there"
