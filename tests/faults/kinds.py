"""The kinds of faults: each strikes a build, or what a build has left, and says what it hit."""

import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from random import Random

import psutil

from tests.compare_builds import results
from tests.faults.builds import Build

DAY_S = 86400
NO_JOB = "nothing: no job ran"


@dataclass(frozen=True)
class Fault:
    """A kind of fault.

    Attributes
    ----------
    strike
        Function of a build and of a stream of random numbers that returns what was hit.
    words
        What a person would call it.
    moments
        At how many moments it strikes.
    running
        Whether it strikes a build under way; else one that has ended.
    beside
        Whether the next build begins while the struck one may still run.
    """

    words: str
    strike: Callable[[Build, Random], str]
    moments: int
    running: bool = True
    beside: bool = False


def _awaited(
    build: Build, found: Callable[[], list[psutil.Process]], least: int
) -> list[psutil.Process]:
    """Processes of a build, once there are so many; none if it ends, or a minute does, before."""
    deadline = time.monotonic() + 60
    while len(processes := found()) < least:
        if build.shell.poll() is not None or time.monotonic() > deadline:
            return []
        time.sleep(0.02)
    return processes


def kill_worker(build: Build, random: Random) -> str:
    """SIGKILL to one job that runs now."""
    workers = _awaited(build, build.workers, 1)
    if not workers:
        return NO_JOB
    worker = random.choice(workers)
    hit = " ".join(worker.cmdline()[3:6]).removeprefix("../../")
    worker.kill()
    return hit.split(" --")[0]


def kill_fork(build: Build, random: Random) -> str:
    """SIGKILL to the server of forks or to one of them, while a job runs."""
    forks = _awaited(build, build.forks, 2)
    if not forks:
        return NO_JOB
    fork = random.choice(forks)
    hit = "a fork" if fork.parent() in forks else "the server of forks"
    fork.kill()
    return hit


def kill_snakemake(build: Build, random: Random) -> str:
    """SIGKILL to Snakemake alone; its jobs have to notice."""
    process = build.snakemake()
    assert process is not None
    jobs = len(build.workers())
    process.kill()
    return f"jobs under way: {jobs}"


def kill_shell(build: Build, random: Random) -> str:
    """SIGKILL to the shell alone; the build goes on, and the next one begins beside it."""
    os.kill(build.shell.pid, signal.SIGKILL)
    return "the build goes on"


def interrupt(build: Build, random: Random) -> str:
    """Ctrl-C: SIGINT to all that run in the foreground."""
    jobs = len(build.workers())
    os.killpg(build.shell.pid, signal.SIGINT)
    return f"jobs under way: {jobs}"


def fill_disk(build: Build, random: Random) -> str:
    """Leave not a byte on the disk of the run, which is small."""
    file = build.folder / "filler"
    with file.open("wb") as filler:
        while free := shutil.disk_usage(build.folder).free:
            # The build writes meanwhile, and may take some of it first.
            with suppress(OSError):
                os.posix_fallocate(filler.fileno(), 0, file.stat().st_size + free)
    return f"{file.stat().st_size >> 20} MiB were free"


def truncate(build: Build, random: Random) -> str:
    """Leave a part of a result."""
    result = _result(build, random)
    size = result.stat().st_size
    os.truncate(result, random.randrange(1, size))
    return result.name


def empty(build: Build, random: Random) -> str:
    """Leave an empty file in place of a result."""
    result = _result(build, random)
    os.truncate(result, 0)
    return result.name


def replace(build: Build, random: Random) -> str:
    """Another result of the same format, whole and well-formed, in place of one; with its date."""
    result = _result(build, random)
    others = [
        path
        for path in _results(build)
        if path.suffix == result.suffix and path.read_bytes() != result.read_bytes()
    ]
    other = random.choice(others)
    shutil.copy2(other, result)
    return f"{other.name} as {result.name}"


def damage_record(build: Build, random: Random) -> str:
    """Snakemake's record of a result: half of it, bytes that are no text, or none of them left."""
    folder = build.folder / ".snakemake/metadata"
    how = random.choice(("half of a record", "a record overwritten", "no record left"))
    record = random.choice(sorted(path for path in folder.rglob("*") if path.is_file()))
    if how == "half of a record":
        os.truncate(record, record.stat().st_size // 2)
    elif how == "a record overwritten":
        record.write_bytes(random.randbytes(record.stat().st_size))
    else:
        shutil.rmtree(folder)
    return how


def cut_compiled(build: Build, random: Random) -> str:
    """Half of a file in which Numba keeps what it has compiled."""
    folder = build.project.folder / "src/smallsat/__pycache__"
    file = random.choice(sorted(folder.glob("numba-*/*/*.nb?")))
    os.truncate(file, file.stat().st_size // 2)
    return file.suffix.removeprefix(".")


def stop(build: Build, random: Random) -> str:
    """SIGKILL to everything, as when the power fails."""
    done = len(_results(build))
    os.killpg(build.shell.pid, signal.SIGKILL)
    return f"files made: {done}"


def set_clock_back(build: Build, random: Random) -> str:
    """All that the build has made so far is dated a day later than now."""
    for path in sorted(build.folder.rglob("*")):
        if path.is_file() and not path.is_symlink():
            status = path.stat()
            day = DAY_S * 10**9
            os.utime(path, ns=(status.st_atime_ns + day, status.st_mtime_ns + day))
    for record in (build.folder / ".snakemake/metadata").rglob("*"):
        if record.is_file():
            status, content = record.stat(), json.loads(record.read_text())
            content["endtime"] += DAY_S
            record.write_text(json.dumps(content))
            os.utime(record, ns=(status.st_atime_ns, status.st_mtime_ns))
    return f"files made: {len(_results(build))}"


def stop_and_set_clock_back(build: Build, random: Random) -> str:
    """Stopped, and begun again under a clock that was set back a day."""
    os.killpg(build.shell.pid, signal.SIGKILL)
    build.shell.wait()
    return set_clock_back(build, random)


def let_it_run(build: Build, random: Random) -> str:
    """Nothing: the next build begins beside this one."""
    return f"jobs under way: {len(build.workers())}"


@contextmanager
def small_disk(folder: Path) -> Iterator[None]:
    """A disk of few megabytes at a folder."""
    folder.mkdir(parents=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=48m", "none", str(folder)], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """A folder in which nobody, root neither, can write."""
    subprocess.run(["mount", "--bind", str(folder), str(folder)], check=True)
    try:
        subprocess.run(["mount", "-o", "remount,bind,ro", str(folder)], check=True)
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def _results(build: Build) -> list[Path]:
    return [build.folder / name for name in sorted(results(build.folder))]


def _result(build: Build, random: Random) -> Path:
    return random.choice([path for path in _results(build) if path.stat().st_size > 1])


FULL_DISK, READ_ONLY = "disk full", "folder read-only"
FAULTS = (
    Fault("SIGKILL to a worker", kill_worker, 3),
    Fault("SIGKILL to Snakemake", kill_snakemake, 3),
    Fault("SIGKILL to the shell", kill_shell, 2, beside=True),
    Fault("Ctrl-C", interrupt, 3),
    Fault(FULL_DISK, fill_disk, 3),
    Fault("result truncated", truncate, 2, running=False),
    Fault("result emptied", empty, 2, running=False),
    Fault("result replaced", replace, 2, running=False),
    Fault("Snakemake's records damaged", damage_record, 3, running=False),
    Fault("Numba's cache cut", cut_compiled, 1),
    Fault(READ_ONLY, stop, 2),
    Fault("clock set back, stopped", stop_and_set_clock_back, 1),
    Fault("clock set back, running", set_clock_back, 1),
    Fault("two builds at once", let_it_run, 2, beside=True),
    Fault("SIGKILL to a fork or the server", kill_fork, 4),
)
