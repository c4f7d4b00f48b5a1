"""A copy of the project in which a test may edit, kill and damage what it likes."""

import fnmatch
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from base64 import urlsafe_b64encode
from dataclasses import dataclass
from pathlib import Path

# What a running make hands down.
MAKE = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKE_TERMOUT", "MAKE_TERMERR")


@dataclass(frozen=True)
class Project:
    """A copied project and the environment in which its commands run."""

    folder: Path
    environment: dict[str, str]

    def command(self, *arguments: str) -> list[str]:
        """A Snakemake call as a list of words."""
        return [str(self.folder / ".venv/bin/snakemake"), "--cores=2", *arguments]

    def run(
        self, command: str | list[str], timeout: int = 300, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        """Run words, or a line as a shell would, in the project."""
        return subprocess.run(
            command if isinstance(command, list) else ["bash", "-c", command],
            cwd=self.folder,
            env=self.environment | environment,
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )

    def snakemake(self, *arguments: str, timeout: int = 300) -> subprocess.CompletedProcess[str]:
        """Run Snakemake in the project."""
        return self.run(self.command(*arguments), timeout)

    def jobs(self, *arguments: str) -> str:
        """The jobs that a dry run would start, as Snakemake lists them."""
        done = self.snakemake("--dry-run", *arguments)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    def refusal(self, *arguments: str) -> str:
        """The one line with which a bad call is refused; fails on a traceback or on success."""
        done = self.snakemake("--dry-run", *arguments)
        output = done.stdout + done.stderr
        assert done.returncode != 0, output
        assert "Traceback" not in output, output
        lines = [line for line in output.splitlines() if line.startswith("smallsat: ")]
        assert len(lines) == 1, output
        return lines[0]

    def noted(self, run: str, *names: str) -> bool:
        """Whether files of a run are whole and Snakemake has taken note of them.

        It marks the outputs of a job when the job starts and takes the marks away once the job is
        recorded; what is still marked is made again.
        """
        folder = self.folder / "runs" / run
        marks = folder / ".snakemake/incomplete"
        return all(
            (folder / name).exists()
            and not (marks / urlsafe_b64encode(name.encode()).decode()).exists()
            for name in names
        )


def make_environment(folder: Path) -> None:
    """An environment for a copied project: its own package, the installed libraries."""
    venv.create(folder / ".venv", symlinks=True)
    python = folder / ".venv/bin/python"
    (site,) = (folder / ".venv/lib").glob("python*/site-packages")
    (site / "project.pth").write_text(f"{folder / 'src'}\n{sysconfig.get_path('purelib')}\n")
    script = folder / ".venv/bin/snakemake"
    script.write_text(
        f"#!{python}\nfrom smallsat.workflow.command_line import snakemake\nsnakemake()\n"
    )
    script.chmod(0o755)
    (folder / ".venv/installed").write_text(str(folder))


def copy_project(root: Path, folder: Path) -> Project:
    """A copy, in a folder that is there, of what belongs to the project."""
    lines = (root / ".gitignore").read_text().split()
    kept = {line.removeprefix("!/") for line in lines if line.startswith("!")}
    # What Python and Numba have compiled comes along: no copy does it anew.
    unmarked = [line for line in lines if not line.startswith(("/", "!"))]
    anywhere = [line.rstrip("/") for line in unmarked if line != "__pycache__/"]
    at_the_top = [line.strip("/") for line in lines if line.startswith("/")]

    def unwanted(folder: str, names: list[str]) -> set[str]:
        place = Path(folder).relative_to(root)
        return {
            name
            for name in names
            if name == ".git"
            or (
                any(fnmatch.fnmatch(str(place / name), rule) for rule in at_the_top)
                and str(place / name) not in kept
            )
            or any(fnmatch.fnmatch(name, rule) for rule in anywhere)
        }

    shutil.copytree(root, folder, ignore=unwanted, dirs_exist_ok=True)
    make_environment(folder)
    path = [str(folder / ".venv/bin"), *os.environ["PATH"].split(os.pathsep)]
    # Nothing of a `make` that runs the tests: a command of the README is typed by itself.
    outside = {name: value for name, value in os.environ.items() if name not in MAKE}
    environment = outside | {
        "PATH": os.pathsep.join(part for part in path if part != str(Path(sys.executable).parent))
    }
    return Project(folder, environment)
