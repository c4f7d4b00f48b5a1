"""One small build of the Mars study that a fault can strike: started, watched, ended, compared."""

import hashlib
import re
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import psutil

from tests.compare_builds import differences, results
from tests.project_copy import Project

# Trajectories and tables, and a figure in its three formats: three jobs.
TARGETS = (
    "data/results/mars/light.csv",
    "data/results/mars/modes.csv",
    "figures/mars/fig-10.svg",
)
UNDISTURBED = "undisturbed"


def settings(run: str) -> list[str]:
    """The words that name a run of its own; the configuration is the documents'."""
    return ["--config", f"run={run}", "mars={visibility_deg: 35.5}"]


@dataclass
class Build:
    """A build under way.

    Attributes
    ----------
    project, run
        The copied project, and the name of the run.
    shell
        The shell that started it, in a session of its own.
    """

    project: Project
    run: str
    shell: subprocess.Popen[str]

    @property
    def folder(self) -> Path:
        """Folder of the run."""
        return self.project.folder / "runs" / self.run

    def snakemake(self) -> psutil.Process | None:
        """The process of Snakemake, once the shell has started it."""
        for process in _family(self.shell.pid):
            if _words(process)[1:3] == ["-m", "smallsat.workflow.command_line"]:
                return process
        return None

    def workers(self) -> list[psutil.Process]:
        """Jobs that run now: who waits for a fork, or does its work by itself."""
        return [
            process
            for process in _family(self.shell.pid)
            if _words(process)[1:2] == ["-m"] and _words(process)[2:3] == ["smallsat"]
        ]

    def forks(self) -> list[psutil.Process]:
        """The server of forks, and those that run now."""
        return [
            process
            for process in _family(self.shell.pid)
            if Path("".join(_words(process)[1:2])).name == "fork_server.py"
        ]

    def spent(self) -> float:
        """Seconds of processor time that the build has used; they depend little on other load."""
        total = 0.0
        for process in _family(self.shell.pid):
            try:
                times = process.cpu_times()
            except psutil.Error:
                continue
            total += times.user + times.system + times.children_user + times.children_system
        return total

    def ended(self, timeout: float = 600) -> tuple[int, str]:
        """Exit status and output, once it has ended."""
        output, _ = self.shell.communicate(timeout=timeout)
        return self.shell.returncode, output


def start(project: Project, run: str) -> Build:
    """Start a build as a person would, in a shell."""
    words = " ".join(f"'{word}'" for word in project.command(*TARGETS, *settings(run)))
    shell = subprocess.Popen(
        # The shell stays, to be killed. Where it was itself begun in the background it would not
        # hear of an interrupt.
        ["env", "--default-signal=INT", "bash", "-c", f"{words}; exit $?"],
        cwd=project.folder,
        env=project.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    return Build(project, run, shell)


def processes(folder: Path) -> list[psutil.Process]:
    """Processes that work in a folder or below it."""
    found = []
    for process in psutil.process_iter():
        try:
            place = Path(process.cwd())
        except (psutil.Error, OSError):
            continue
        if place.is_relative_to(folder) and process.status() != psutil.STATUS_ZOMBIE:
            found.append(process)
    return found


def gone(folder: Path, seconds: float) -> bool:
    """Whether no process works in a folder any more, within some seconds."""
    deadline = time.monotonic() + seconds
    while left := processes(folder):
        if time.monotonic() > deadline:
            return not left
        time.sleep(0.1)
    return True


def made(output: str) -> int:
    """How many jobs a build says that it has done."""
    return max((int(n) for n in re.findall(r"^\[ *(\d+)/\d+\]", output, re.MULTILINE)), default=0)


def moved(project: Project, run: str) -> list[str]:
    """How a run differs from the undisturbed one, a line a file."""
    runs = project.folder / "runs"
    return list(differences(runs / UNDISTURBED, runs / run))


def digest(build: Path) -> str:
    """A digest of all bytes that `tests.compare_builds` compares."""
    whole = hashlib.sha256()
    for name in sorted(results(build)):
        whole.update(name.encode() + b"\0" + (build / name).read_bytes())
    return whole.hexdigest()[:12]


def _family(pid: int) -> Iterator[psutil.Process]:
    try:
        process = psutil.Process(pid)
        yield process
        yield from process.children(recursive=True)
    except psutil.Error:
        return


def _words(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:
        return []
