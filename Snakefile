# Targets a person types:
#   snakemake                               everything, report included
#   snakemake transfer                      one study
#   snakemake figures/transfer/fig-05.svg   one figure; a table: data/results/transfer/tables/table-4.csv
#   snakemake check                         verdicts only, with a summary; fails where one is wrong
#   snakemake animations                    the films
#   snakemake --configfile my.yaml          a what-if run, in runs/<name>/
import os
import re
import sys
from functools import cache
from pathlib import Path

from smallsat.catalogue import read_catalogue
from smallsat.config import as_json
from smallsat.errors import InputError
from smallsat.evidence.ledger import read_published
from smallsat.shard import Shard
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.figures import drawn, read_runs
from smallsat.workflow.isolation import isolate
from smallsat.workflow.names import check_names, rule_name
from smallsat.workflow.run import read_run
from smallsat.workflow.seconds import accepted
from smallsat.workflow.sources import named_modules, notebook_modules, source_files
from smallsat.workflow.targets import refusal


# The environment is .venv, made from requirements.lock. Snakemake's linter asks for a container
# beside it; this one is used only where apptainer is asked for.
container: "docker://python:3.11"


ROOT = Path(workflow.basedir)
PUBLISHED = ROOT / "data/published"

isolate(ROOT / ".cache")

try:
    given = workflow.config_settings
    run = read_run(ROOT, given.configfiles, given.config_args or [])
    CONFIG, DEFAULT, RUN_FOLDER = run.config, run.default, run.folder
    catalogue = read_catalogue(PUBLISHED)
    STUDIES = [study.name for study in catalogue]
    ARTEFACTS = {study.name: read_published(PUBLISHED, study)[1] for study in catalogue}
    FIGURES = {study: read_runs(ROOT / "notebooks" / study) for study in STUDIES}
    # What a study shows beyond its document.
    BEYOND = {
        study: (read_yaml(path) or []) if path.exists() else []
        for study in STUDIES
        for path in [PUBLISHED / study / "extras.yaml"]
    }
    for study in STUDIES:
        check_names(study, ARTEFACTS[study], BEYOND[study], FIGURES[study])
    # Without the figures of cases that a what-if run leaves out.
    RUNS = {
        study: [
            run if CONFIG[study] == DEFAULT[study] else drawn(run, CONFIG[study])
            for run in FIGURES[study]
        ]
        for study in STUDIES
    }
except InputError as error:
    sys.exit(f"smallsat: {error}")


workdir: ROOT / RUN_FOLDER


include: "rules/common.smk"


for study in STUDIES:

    include: f"rules/{study}.smk"


include: "rules/notebooks.smk"
include: "rules/evidence.smk"
include: "rules/report.smk"


# What a build is to make.
BUILT = [
    *rules.report.output,
    *rules.site.output,
    "data/results/verdicts.accepted",
    *[path for study in STUDIES for path in report_tables(study) + report_figures(study)],
]


include: "rules/provenance.smk"


rule all:
    default_target: True
    input:
        BUILT,
        ["ro-crate-metadata.json"] * (not WHAT_IF),
    log:
        "logs/all.log",
    message:
        "Everything is there; the report lies in report/build"


include: "rules/local.smk"
include: "rules/unknown.smk"
