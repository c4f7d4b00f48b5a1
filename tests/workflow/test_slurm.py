"""The profile slurm on a Slurm of one node, which `make test-slurm` starts; else it is skipped."""

import csv
import datetime
import json
import os
import re
import subprocess
import time
from collections import Counter
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import pytest

from smallsat.workflow.seconds import last_build, machine

ROOT = Path(__file__).parents[2]
CLUSTER = ROOT / "runs/cluster"

pytest.importorskip("snakemake_executor_plugin_slurm", reason="needs a Slurm: make test-slurm")
pytestmark = pytest.mark.skipif(
    not (CLUSTER / "slurmctld.pid").exists(), reason="needs a Slurm of one node: make test-slurm"
)

SHARDS = 6
SMALL = {"horizons": [15, 30], "sample_times_s": [50.0, 60.0]}
# In one line, which is how a job on another node gets it.
STUDIES = "rendezvous=" + json.dumps(
    {"studies": {"share": 0.02, "shards": SHARDS, "rendezvous": SMALL}}
)
SWEEP = "data/results/rendezvous/studies/rendezvous-sweep.parquet"
# The cluster has no accounting, which the plugin asks by default; logs say which job was whose.
PROFILE = (
    *("--profile", "profiles/slurm", "--slurm-status-command", "squeue"),
    "--slurm-keep-successful-logs",
)


def cluster(word: str) -> None:
    """Do something to the cluster."""
    subprocess.run([ROOT / "tests/workflow/cluster", word, CLUSTER], check=True)


@dataclass(frozen=True)
class Job:
    """One that the cluster has ended: its number, how it ended, and after how many seconds."""

    number: str
    state: str
    seconds: float


def ended() -> list[Job]:
    """What the cluster has ended so far."""
    lines = re.findall(
        r"JobId=(\d+) .*JobState=(\w+) .*StartTime=(\S+) EndTime=(\S+)",
        (CLUSTER / "jobs.txt").read_text(),
    )
    when = datetime.datetime.fromisoformat
    return [
        Job(number, state, (when(end) - when(start)).total_seconds())
        for number, state, start, end in lines
    ]


def states() -> list[str]:
    """How each of them has ended."""
    return [job.state for job in ended()]


def rules(run: Path) -> dict[str, str]:
    """The rule of each job that the cluster has begun, by the job's number."""
    logs = (run / ".snakemake/slurm_logs").glob("rule_*/*.log")
    return {path.stem: path.parent.name.removeprefix("rule_") for path in logs}


def completed(run: Path) -> dict[str, Job]:
    """Jobs that the cluster has brought to their end, by their rule."""
    of = rules(run)
    return {of[job.number]: job for job in ended() if job.state == "COMPLETED"}


def overheads(run: Path) -> list[float]:
    """Seconds that each job took beyond those of its rule."""
    own = last_build(run / "logs")
    return [job.seconds - own[rule] for rule, job in completed(run).items()]


def until(met, seconds: float, process: subprocess.Popen[str]) -> None:
    """Wait until something is so, while a process runs."""
    deadline = time.monotonic() + seconds
    while not met():
        assert process.poll() is None, process.communicate()[0]
        assert time.monotonic() < deadline, (CLUSTER / "slurmctld.log").read_text()
        time.sleep(0.2)


def shards(run: Path) -> set[str]:
    """Those that are written."""
    written = (run / "data/results/rendezvous/studies/shards").glob("*.parquet")
    return {path.stem for path in written}


def in_flight(run: Path) -> set[str]:
    """Shards that a job has begun to fly and not written."""
    logs = (run / "logs/rendezvous").glob("*-of-*.log")
    return {path.stem for path in logs} - shards(run)


def test_a_node_fails_and_the_bytes_are_those_of_a_local_build(make_project):
    """Shards run in the queue and small rules beside it; the node dies with its jobs in between.

    What was done before is kept, what died is run again, and every table is the local build's.
    """
    project = make_project()
    done = project.snakemake(SWEEP, "--config", "run=local", STUDIES, timeout=1200)
    assert done.returncode == 0, done.stdout + done.stderr

    run = project.folder / "runs/cluster"
    process = subprocess.Popen(
        project.command(SWEEP, *PROFILE, "--config", "run=cluster", STUDIES),
        cwd=project.folder,
        env=project.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        until(lambda: "COMPLETED" in states() and in_flight(run), 1200, process)
        cluster("fail")
        until(lambda: "NODE_FAIL" in states(), 300, process)
        # A shard may be whole whose job has died before it could say so: that one is run again.
        done_before = completed(run).keys()
        cluster("return")
        output, _ = process.communicate(timeout=1200)
    finally:
        process.kill()
    assert process.returncode == 0, output
    assert "FAILED rendezvous: rendezvous-sweep" in output and "failed, as told" not in output

    # By jobs and not by the times of files: Snakemake touches a shard when it learns of its end.
    jobs = Counter(rules(run).values())
    assert done_before and all(jobs[rule] == 1 for rule in done_before)
    assert max(jobs.values()) == 2
    # Nothing but shards was in the queue.
    assert states().count("COMPLETED") == SHARDS == len(shards(run))
    local, remote = (
        {
            path.relative_to(folder): path.read_bytes()
            for path in (folder / "data/results").rglob("*")
            if path.is_file()
        }
        for folder in (project.folder / "runs/local", run)
    )
    assert Path(SWEEP) in local and local.keys() == remote.keys()
    differing = [str(name) for name in local if local[name] != remote[name]]
    assert differing == []

    row = {
        "date": datetime.date.today().isoformat(),
        "machine": machine(),
        "slurm": subprocess.check_output(["sinfo", "--version"], text=True).split()[-1],
        "snakemake": version("snakemake"),
        "executor": version("snakemake-executor-plugin-slurm"),
        "shards": SHARDS,
        "node_failures": states().count("NODE_FAIL"),
        "files": len(local),
        "differing": len(differing),
        # Of the quickest job: other work on the machine only adds to it.
        "overhead_s": f"{min(overheads(run)):.1f}",
        "load": f"{os.getloadavg()[1]:.1f}",
    }
    with (CLUSTER / "slurm.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, row, lineterminator="\n")
        table.writeheader()
        table.writerow(row)
