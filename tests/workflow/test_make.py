"""`make` before there is an environment: which Python, and a checkout that was moved."""

import shutil
import subprocess

import pytest


def fake(folder, name, text):
    """A program that stands for another Python."""
    path = folder / name
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def moved(make_project):
    """A project whose environment was made elsewhere."""
    project = make_project()
    (project.folder / ".venv/installed").write_text("/elsewhere")
    return project


def test_a_python_that_does_not_do_is_answered_in_one_line(moved):
    """A missing one, another version, one without venv: what is needed and what to do."""
    other = "case $1 in --version) echo Python 3.10.4;; *) exit 1;; esac"
    no_venv = "case $2 in *version_info*) exit 0;; *) exit 1;; esac"
    for python, words in (
        ("no-such-python", ("not found", "Python 3.11")),
        (fake(moved.folder, "older", other), ("is Python 3.10.4", "needed is Python 3.11")),
        (fake(moved.folder, "bare", no_venv), ("has no venv", "install it")),
    ):
        done = moved.run(["make", f"PYTHON={python}", ".venv/installed"])
        lines = [line for line in done.stderr.splitlines() if not line.startswith("make: ***")]
        assert done.returncode != 0
        assert len(lines) == 1 and all(word in lines[0] for word in words), done.stderr


def test_a_moved_checkout_makes_its_environment_anew(moved):
    """The environment knows its folder; in the same place nothing is to be done."""
    assert "-m venv --clear" in moved.run("make -n").stdout
    (moved.folder / ".venv/installed").write_text(str(moved.folder))
    assert "-m venv --clear" not in moved.run("make -n").stdout


@pytest.mark.parametrize(
    ("command", "lacking"),
    [
        (["flight/install"], "qemu-system-arm"),
        (["tests/workflow/cluster", "start", "runs/cluster"], "slurmctld"),
    ],
)
def test_what_is_missing_is_said_where_it_may_not_be_installed(root, tmp_path, command, lacking):
    """Without emulators or Slurm, and for a user who is not root: one line that names them."""
    for name in ("bash", "dirname", "realpath"):
        (tmp_path / name).symlink_to(shutil.which(name))
    fake(tmp_path, "id", "echo 1000")
    done = subprocess.run(
        command, cwd=root, env={"PATH": str(tmp_path)}, capture_output=True, text=True
    )
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert lacking in line and "install (Debian)" in line
