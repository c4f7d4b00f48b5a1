"""What the project needs stands in two files, for pip and for the lock: they agree."""

import re
import tomllib

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
