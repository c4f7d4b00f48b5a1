# What these files share: paths, import closures, and how a step of a study becomes one of them.

# Seconds of the rules in the accepted build.
TOOK = accepted(ROOT / "data/accepted/seconds.csv")


def project(path):
    """A file of the project, as seen from the folder of the run."""
    return os.path.relpath(ROOT / path)


def published_files(study, *names):
    """Files among the published values of a study."""
    return [project(f"data/published/{study}/{name}") for name in names]


def results(study, *names):
    """Files among the results of a study."""
    return [f"data/results/{study}/{name}" for name in names]


@cache
def sources(command, *modules):
    """Source files that a command runs, so that editing any of them reruns the rule."""
    return [os.path.relpath(path) for path in source_files(command, *modules)]


def urgency(rule):
    """Priority of a rule: the longest job first, so that none begins when all others are done."""
    return round(TOOK.get(rule, 0))


def figure_files(*stems):
    """The files of figures: three formats and the data drawn."""
    return [f"{stem}.{suffix}" for stem in stems for suffix in ("svg", "pdf", "png", "csv")]


def targets(study, *kinds):
    """Targets of a document's artefacts, in the order of the document; those built so far."""
    return [
        row["target"]
        for row in ARTEFACTS[study]
        if row["kind"] in kinds and row["target"] and row["target"] not in LEFT_OUT
    ]


def report_tables(study):
    """Tables that the report of a study shows, the document's own first."""
    beyond = [entry["table"] for entry in BEYOND[study] if entry.get("table")]
    return targets(study, "table") + beyond


def report_figures(study):
    """Figures that the report of a study shows, the document's own first."""
    beyond = [stem for entry in BEYOND[study] for stem in entry.get("figures") or []]
    return targets(study, "figure") + [f"{stem}.svg" for stem in beyond]


def step(
    study,
    name,
    makes,
    *,
    runs="",
    reads=(),
    published=(),
    accepted=(),
    files=(),
    clock=(),
    part="",
    shard="",
    takes=None,
    priority=None,
    aside=False,
):
    """A computing step of a study becomes a rule.

    Parameters
    ----------
    study, name
        Of the study and of the rule, which is `<study>_<name>`.
    makes, clock
        What it makes in the study's results; `clock` differs from build to build, as seconds do,
        and is not judged.
    runs
        Module of the study's steps that it runs; else the one of its own name.
    reads
        Results of the study that it reads.
    part, shard
        Which part of the step, and which share of it, such as `1-of-4`.
    takes
        Type of the part of the study's section that it depends on; else the whole section. A
        change of anything else does not rerun it.
    published, accepted, files
        Published and accepted files of the study that it reads, and files of a person's own.
    priority
        Steps of a higher one start first, else those that take longer.
    aside
        Whether it is run only when asked for by its name.
    """
    implementation = f"smallsat.studies.{study}.steps.{runs or name}"
    words = [
        *[f"--published {project(f'data/published/{study}')}"] * bool(published),
        *[f"--accepted {project(f'data/accepted/{study}')}"] * bool(accepted),
        *[f"--part {part}"] * bool(part),
        *[f"--shard {shard}"] * bool(shard),
    ]
    if not aside:
        MADE[study] += results(study, *makes, *clock)

    rule:
        name:
            rule_name(study, name)
        input:
            sources=sources("smallsat.workflow.run_step", implementation),
            published=published_files(study, *published),
            accepted=[project(f"data/accepted/{study}/{name}") for name in accepted],
            files=list(files),
            results=results(study, *reads),
        output:
            results(study, *makes, *clock),
        log:
            f"logs/{study}/{name}.log",
        benchmark:
            f"logs/{study}/{name}.benchmark.tsv"
        priority: urgency(rule_name(study, name)) if priority is None else priority
        params:
            study=study,
            step=runs or name,
            words=" ".join(words),
            config=as_json(CONFIG[study].only(takes) if takes else CONFIG[study]),
        message:
            f"{study}: {name}"
        shell:
            "python -m smallsat run {params.study} {params.step} --config {params.config:q}"
            " --results data/results/{params.study} {params.words} > {log} 2>&1"


# Artefacts of cases that a what-if run leaves out.
LEFT_OUT = [
    f"{stem}.svg"
    for study in STUDIES
    for whole, run in zip(FIGURES[study], RUNS[study], strict=True)
    for stem in whole.stems
    if stem not in run.stems
]

# Films, made only when asked for.
ANIMATIONS = []

# Files that the steps and notebooks of a study make.
MADE = {study: [] for study in STUDIES}

# What the verdicts of a study rest on; each study's rule file says it.
JUDGED = {}

# What the scenes of a study, to turn and play, are made of; each study's rule file says it.
SCENES = {}

# Cases that no solver solved, a table a study.
NOT_CONVERGED = [f"data/results/{study}/not-converged.csv" for study in STUDIES]

# A notebook is run by papermill; the executed notebook is an output for the reader.
NOTEBOOK = (
    "python -m smallsat notebook {input.notebook} {output.notebook}"
    " --parameters {params.parameters:q} > {log} 2>&1"
)
