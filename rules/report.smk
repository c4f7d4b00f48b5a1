# The report: its content collected from the results, then typeset as a PDF and as a web page.
# It is built whatever the verdicts are, so that a wrong one can be read about.
EXTRAS = {
    study: read_yaml(path) or []
    for study in STUDIES
    if (path := ROOT / f"data/published/{study}/extras.yaml").exists()
}
EXTRA_TABLES = [entry["table"] for study in EXTRAS for entry in EXTRAS[study] if entry.get("table")]
EXTRA_FIGURES = [
    f"{stem}.svg"
    for study in EXTRAS
    for entry in EXTRAS[study]
    for stem in entry.get("figures") or []
]
FIGURES = [target for study in STUDIES for target in targets(study, "figure")] + EXTRA_FIGURES
TABLES = [target for study in STUDIES for target in targets(study, "table")] + EXTRA_TABLES
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


rule report:
    input:
        sources=sources("smallsat.report.__main__", "smallsat.report.typesetting"),
        template=project("report/report.typ"),
        parts=[
            project(path.relative_to(ROOT))
            for path in sorted((ROOT / "report").rglob("*"))
            if path.suffix in (".typ", ".css") and path.name != "report.typ"
        ],
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
        "(python -m smallsat.report compile {input.content} --project {params.project}"
        " --output {output.pdf}"
        " && python -m smallsat.report compile {input.content} --project {params.project}"
        " --output {output.html}) > {log} 2>&1"


rule animations:
    input:
        ANIMATIONS,
    log:
        "logs/animations.log",
    message:
        "All films are there"
