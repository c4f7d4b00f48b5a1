"""What the project needs stands in two files, for pip and for the lock: they agree.

So does what only one target needs, with a lock of its own.
"""

import re
import tomllib
from pathlib import Path

import pytest

# The build backend stands in pyproject.toml by itself.
BACKEND = {"setuptools"}


def test_both_lists_name_the_same_packages(root):
    """requirements.in, from which the lock is made, and pyproject.toml."""
    text = (root / "requirements.in").read_text()
    wanted = {line for line in text.splitlines() if line and not line.startswith("#")}
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    declared = {*project["dependencies"], *project["optional-dependencies"]["test"]}
    assert {name.lower() for name in declared} == wanted - BACKEND
    locked = re.findall(r"^([\w.-]+)==", (root / "requirements.lock").read_text(), re.MULTILINE)
    assert wanted <= set(locked)


ROOT = Path(__file__).parents[1]
WANTED = sorted([*ROOT.glob("requirements*.in"), *ROOT.glob("*/requirements*.in")])


@pytest.mark.parametrize("wanted", WANTED, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_list_is_locked_by_hashes(wanted):
    """All that a list asks for stands in its lock, with hashes; `make lock` makes it from it."""
    lock = wanted.with_suffix(".lock")
    packages = re.split(r"\n(?=[\w.-]+==)", lock.read_text())
    locked = {re.split("==", package)[0]: package for package in packages}
    names = [line for line in wanted.read_text().splitlines() if line and line[0] != "#"]
    assert names and set(names) <= set(locked)
    assert all(re.search(r"--hash=sha256:[0-9a-f]{64}", package) for package in locked.values())
    assert "://" not in lock.read_text()
    made = f"{wanted.relative_to(ROOT)} .*-o {lock.relative_to(ROOT)}$"
    assert re.search(made, (ROOT / "Makefile").read_text(), re.MULTILINE)
