"""The studies of many manoeuvres as a workflow: killed in three ways, they end alike."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

TARGET = "data/results/rendezvous/studies/rendezvous-sweep.parquet"
SHARDS = "data/results/rendezvous/studies/shards"


def settings(run, shards):
    """Few manoeuvres, in so many shards, in a folder of their own."""
    small = {
        "samples": 7,
        "shards": shards,
        "rendezvous": {"horizons": [15, 30], "sample_times_s": [30.0, 60.0]},
    }
    return ("--config", f"run={run}", f"rendezvous={json.dumps({'studies': small})}")


@pytest.fixture(scope="module")
def project(make_project):
    """A project whose studies were run undisturbed, in three shards."""
    project = make_project()
    done = project.snakemake(TARGET, *settings("undisturbed", 3), timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
    return project


def content(project, run):
    return (project.folder / "runs" / run / TARGET).read_bytes()


def start(project, run):
    return subprocess.Popen(
        project.command(TARGET, *settings(run, 3)),
        cwd=project.folder,
        env=project.environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def until(condition, seconds=300):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if found := condition():
            return found
        time.sleep(0.01)
    pytest.fail("did not come to pass in time")


def workers(project, run):
    """Processes that fly a shard of a run."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            words = (path / "cmdline").read_bytes().split(b"\0")
            folder = (path / "cwd").readlink()
        except OSError:
            continue
        if b"--shard" in words and folder == project.folder / "runs" / run:
            found.append(int(path.name))
    return found


def test_any_number_of_shards(project):
    """One shard instead of three: the same table, byte for byte."""
    done = project.snakemake(TARGET, *settings("one-shard", 1))
    assert done.returncode == 0, done.stdout + done.stderr
    assert content(project, "one-shard") == content(project, "undisturbed")


def test_progress_is_in_each_shards_log(project):
    """Which case, and how many of its manoeuvres are flown."""
    log = project.folder / "runs/undisturbed/logs/rendezvous/rendezvous-sweep-2-of-3.log"
    assert "case 4 of 4, N 30, Ts 60 s: 2 of 2 manoeuvres" in log.read_text()


def noted(project, run):
    """Shards that Snakemake has taken note of, and when they were written."""
    names = [f"{SHARDS}/rendezvous-sweep-{k}-of-3.parquet" for k in (1, 2, 3)]
    paths = [project.folder / "runs" / run / name for name in names if project.noted(run, name)]
    return {path: path.stat().st_mtime_ns for path in paths}


def test_a_killed_snakemake_goes_on(project):
    """SIGKILL to Snakemake and all of its jobs: noted shards are not flown again."""
    run = project.folder / "runs/killed"
    process = start(project, "killed")
    until(lambda: noted(project, "killed"))
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    kept = noted(project, "killed")
    assert kept and not (run / TARGET).exists()
    resumed = project.snakemake(TARGET, *settings("killed", 3))
    assert resumed.returncode == 0, resumed.stdout + resumed.stderr
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert content(project, "killed") == content(project, "undisturbed")


def test_a_killed_worker_is_flown_again(project):
    """SIGKILL to one worker: the call fails, says so, and the next one ends in the same bytes."""
    process = start(project, "worker")
    os.kill(until(lambda: workers(project, "worker"))[0], signal.SIGKILL)
    assert process.wait(timeout=300) != 0
    folder = project.folder / "runs/worker"
    assert not (folder / TARGET).exists()
    kept = {path: path.stat().st_mtime_ns for path in (folder / SHARDS).glob("*.parquet")}
    assert 0 < len(kept) < 3
    resumed = project.snakemake(TARGET, *settings("worker", 3))
    assert resumed.returncode == 0, resumed.stdout + resumed.stderr
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert content(project, "worker") == content(project, "undisturbed")


def test_a_half_written_shard_is_found_and_made_again(project):
    """Half a file under a shard's name: one line names it, and the same call makes it again."""
    run = project.folder / "runs/undisturbed"
    whole = content(project, "undisturbed")
    shard = run / SHARDS / "rendezvous-sweep-2-of-3.parquet"
    shard.write_bytes(shard.read_bytes()[: shard.stat().st_size // 2])
    (run / TARGET).unlink()
    again = project.snakemake(TARGET, *settings("undisturbed", 3))
    output = again.stdout + again.stderr
    assert again.returncode == 0, output
    assert "rendezvous-sweep-2-of-3.parquet: changed after it was made" in output
    assert content(project, "undisturbed") == whole
