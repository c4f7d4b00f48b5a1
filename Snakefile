# Targets a person types:
#   snakemake                               everything, report included
#   snakemake transfer                      one study
#   snakemake figures/transfer/fig-05.svg   one figure; a table: data/results/transfer/tables/table-4.csv
#   snakemake check                         verdicts only, with a summary; fails where one is wrong
#   snakemake animations                    the films
#   snakemake --configfile my.yaml          a what-if run, in runs/<name>/
import json
import os
import re
import sys
from pathlib import Path

from smallsat.errors import InputError
from smallsat.evidence.ledger import read_artefacts, read_ledger
from smallsat.workflow.isolation import isolate
from smallsat.studies.racing.parameters import parameters as racing_parameters
from smallsat.workflow.run import read_run
from smallsat.workflow.sources import source_files
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.targets import refusal


# The environment is .venv, made from requirements.lock. Snakemake's linter asks for a container
# beside it; this one is used only where apptainer is asked for.
container: "docker://python:3.11"


ROOT = Path(workflow.basedir)

isolate(ROOT / ".cache")

try:
    given = workflow.config_settings
    run = read_run(ROOT, given.configfiles, given.config_args or [])
    config, RUN_FOLDER = run.config, run.folder
    read_ledger(ROOT / "data/published/values.csv")
    ARTEFACTS = read_artefacts(ROOT / "data/published/artefacts.csv")
except InputError as error:
    sys.exit(f"smallsat: {error}")


workdir: ROOT / RUN_FOLDER


STUDIES = ["transfer", "mars", "slew", "racing", "rendezvous"]


include: "rules/common.smk"
include: "rules/transfer.smk"
include: "rules/mars.smk"
include: "rules/slew.smk"
include: "rules/racing.smk"
include: "rules/rendezvous_engine.smk"
include: "rules/rendezvous_studies.smk"
include: "rules/rendezvous.smk"
include: "rules/evidence.smk"
include: "rules/report.smk"


rule all:
    default_target: True
    input:
        rules.report.output,
        "data/results/verdicts.accepted",
        TABLES,
        FIGURES,
    log:
        "logs/all.log",
    message:
        "Everything is there; the report lies in report/build"


include: "rules/unknown.smk"
