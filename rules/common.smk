# What these files share: paths, import closures, and the files that one artefact consists of.


def project(path):
    """A file of the project, as seen from the folder of the run."""
    return os.path.relpath(ROOT / path)


def sources(*modules):
    """Source files that a command runs, so that editing any of them reruns the rule."""
    return [os.path.relpath(path) for path in source_files(*modules)]


def named_modules(study):
    """Modules that the errata and claims of a study name."""
    return sorted(
        {
            entry[key].partition(":")[0]
            for name, key in (("errata", "proof"), ("claims", "predicate"))
            for entry in read_yaml(ROOT / f"data/published/{study}/{name}.yaml")
        }
    )


def figure_files(*stems):
    """The files of figures: three formats and the data drawn."""
    return [f"{stem}.{suffix}" for stem in stems for suffix in ("svg", "pdf", "png", "csv")]


def targets(document, *kinds):
    """Targets of a document's artefacts, in the order of the document; those built so far."""
    return [
        row["target"]
        for row in ARTEFACTS
        if row["document"] == document
        and row["kind"] in kinds
        and row["target"]
        and row["target"] not in LEFT_OUT
    ]


def extra_tables(study):
    """Tables beyond the document that the report of a study shows."""
    return [entry["table"] for entry in EXTRAS.get(study, []) if entry.get("table")]


def report_figures(study):
    """Figures that the report of a study shows."""
    extras = [stem for entry in EXTRAS.get(study, []) for stem in entry.get("figures") or []]
    return targets(study, "figure") + [f"{stem}.svg" for stem in extras]


def as_json(value):
    """A parameter for a command line; sorted, so that equal values are equal text."""
    return json.dumps(value, sort_keys=True)


# Tables and figures that go beyond a document.
EXTRAS = {
    study: read_yaml(path) or []
    for study in STUDIES
    if (path := ROOT / f"data/published/{study}/extras.yaml").exists()
}

# What the verdicts of a study rest on; each study's rule file adds its own.
STUDY_RESULTS = {}

# Cases that no solver solved, a table a study.
NOT_CONVERGED = [f"data/results/{study}/not-converged.csv" for study in STUDIES]

# Artefacts of cases that a what-if run leaves out.
LEFT_OUT = []

# Films, made only when asked for.
ANIMATIONS = []

# A notebook is run by papermill; the executed notebook is an output for the reader.
NOTEBOOK = (
    "python -m smallsat.workflow.notebook {input.notebook} {output.notebook}"
    " --parameters {params.parameters:q} > {log} 2>&1"
)
NOTEBOOK_SOURCES = sources("smallsat.workflow.notebook")
