"""A copy of the project in which a test may edit, kill and damage what it likes."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Project:
    """A copied project and the environment in which its commands run."""

    folder: Path
    environment: dict[str, str]

    def command(self, *arguments: str) -> list[str]:
        """A Snakemake call as a list of words."""
        return [sys.executable, "-m", "snakemake", "--cores", "2", *arguments]

    def snakemake(self, *arguments: str, timeout: int = 300) -> subprocess.CompletedProcess[str]:
        """Run Snakemake in the project."""
        return subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )

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


@pytest.fixture(scope="session")
def make_project(root: Path, tmp_path_factory) -> Callable[[], Project]:
    """Function that copies the tracked and the new files of the project into a fresh folder."""

    def make() -> Project:
        folder = tmp_path_factory.mktemp("project")
        listed = subprocess.run(
            ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
            cwd=root,
            capture_output=True,
            text=True,
            check=True,
        )
        for name in listed.stdout.splitlines():
            if (root / name).is_file():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(root / name, folder / name)
        environment = os.environ | {
            # The copy's own package, before the installed one.
            "PYTHONPATH": str(folder / "src"),
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "OMP_NUM_THREADS": "1",
        }
        return Project(folder, environment)

    return make


@pytest.fixture(scope="session")
def project(make_project) -> Project:
    """One copy for all tests that only read, or that clean up after themselves."""
    return make_project()
