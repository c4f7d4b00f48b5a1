"""A rule's inputs are what its job reads: held against the files that the jobs did open.

`make test` lets every job of its run note the files of the project that it opens
(`smallsat.opened`); the notebooks' jobs are run here, one of each notebook.
"""

import json
import os
import shlex
import subprocess
from dataclasses import dataclass, field

import pytest

from smallsat.catalogue import read_catalogue
from smallsat.workflow.figures import read_runs
from smallsat.workflow.fork_server import possible

RUN = "runs/tests"


@dataclass
class Job:
    """A job of Snakemake: what its rule declares, what its processes opened, whether in a fork."""

    rule: str
    inputs: set[str]
    outputs: set[str] = field(default_factory=set)
    opened: set[str] | None = None
    fork: bool = False


def words_of(command):
    """The command before its output is sent elsewhere, as its process sees it."""
    return tuple(shlex.split(command.partition(" > ")[0].partition(" | ")[0]))


# Forks a job, and ends it when its build has ended; what a job makes does not depend on it.
WATCH = {f"src/smallsat/workflow/{name}.py" for name in ("__init__", "fork_server", "one_build")}


def source(root, name):
    """The file of a module that was imported, or of a package."""
    package = name.removesuffix(".py") + "/__init__.py"
    return package if name.startswith("src/") and (root / package).exists() else name


def projected(root, run, names):
    """Names as seen from the folder of a run, as seen from the project."""
    return {(run / name).resolve().relative_to(root).as_posix() for name in names}


def figures(root):
    """One figure of each notebook, of its shortest run; films are left out."""
    for study in read_catalogue(root / "data/published"):
        runs = [run for run in read_runs(root / "notebooks" / study.name) if run.figures]
        longest_first = sorted(runs, key=lambda run: len(run.figures), reverse=True)
        for run in {run.notebook: run for run in longest_first}.values():
            yield f"{run.stems[0]}.svg"


@pytest.fixture(scope="module")
def jobs(root, tested_run):
    """Every job of the tests' run and of one figure of each notebook."""
    records = root / RUN / "opened"
    options = ["--configfile", "config/tests.yaml"]
    targets = ["verdicts", *figures(root)]
    environment = {"SMALLSAT_OPENED": str(records)}
    snakemake = [str(root / ".venv/bin/snakemake"), *targets, *options]
    done = run_clean([*snakemake, "--cores", "2"], root, environment)
    assert done.returncode == 0, done.stderr[-2000:]
    listed = run_clean([*snakemake, "--detailed-summary"], root, {}).stdout.splitlines()
    header = listed[0].split("\t")
    found: dict[tuple[str, ...], Job] = {}
    for line in listed[1:]:
        row = dict(zip(header, line.split("\t"), strict=False))
        inputs = projected(root, tested_run, row["input-file(s)"].split(","))
        job = found.setdefault(words_of(row["shellcmd"]), Job(row["rule"], inputs))
        job.outputs |= projected(root, tested_run, [row["output_file"]])
    read_records(root, records, found)
    return list(found.items())


def run_clean(command, root, more):
    environment = {name: value for name, value in os.environ.items() if name != "SMALLSAT_OPENED"}
    return subprocess.run(
        command, cwd=root, env=environment | more, capture_output=True, text=True, check=False
    )


def read_records(root, folder, jobs):
    """Give each job what its last process opened, and the kernels that this one started.

    A process that waits comes before the fork that does its work.
    """
    processes: dict[int, Job] = {}
    for path in sorted(folder.glob("*.txt")):
        head, *lines = path.read_text().splitlines()
        names = {source(root, line) for line in lines}
        process = json.loads(head)
        words = ("python", *process["argv"][1:])
        if words in jobs:
            job = jobs[words]
            job.opened, job.fork = names, process["fork"]
        elif job := processes.get(process["parent"]):
            job.opened |= names
        else:
            continue
        processes[process["pid"]] = job


def test_every_job_was_seen(jobs):
    """No job without a record, but those whose library opens files by itself."""
    unseen = [job.rule for words, job in jobs if job.opened is None and words[1:2] == ("-m",)]
    assert unseen == [], "if made by another command than `make test`: rm -r runs/tests, make test"


def test_every_job_is_a_fork(jobs):
    """None imports the libraries anew, because of a variable of its own say."""
    alone = [job.rule for words, job in jobs if words[1:2] == ("-m",) and not job.fork]
    assert alone == [] or not possible()


def test_what_a_job_opens_is_declared(jobs):
    """Sources, published values, results and notebooks: nothing is read behind Snakemake's back."""
    wrong = {}
    for _, job in jobs:
        beside = {name.rpartition("/")[0] for name in job.outputs}
        undeclared = {
            name
            for name in job.opened or ()
            if name not in job.inputs | job.outputs | WATCH
            # A table is written beside its place and then moved there.
            and not (name.endswith(".partial") and name.rpartition("/")[0] in beside)
        }
        if undeclared:
            wrong[job.rule] = sorted(undeclared)
    assert wrong == {}


def test_what_is_declared_is_read(jobs):
    """A change of a published file or of a result reruns no job that does not read it."""
    wrong = {}
    for _, job in jobs:
        if job.opened is None:
            continue
        data = {name for name in job.inputs if name.startswith(("data/", RUN))}
        if unread := data - job.opened:
            wrong[job.rule] = sorted(unread)
    assert wrong == {}
