"""What several test files need: the project's folder and its default configuration."""

from pathlib import Path

import pytest

from smallsat.config import default_config
from smallsat.workflow.isolation import isolate

ROOT = Path(__file__).parents[1]
# Before matplotlib or Jupyter is imported: the settings of whoever runs the tests stay out.
isolate(ROOT / ".cache")


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def config() -> dict:
    return default_config(ROOT)


@pytest.fixture(scope="session")
def tested_run(root) -> Path:
    """Folder of the run that `make test` makes: all in full, statistical parts for a share."""
    folder = root / "runs/tests"
    if not (folder / "data/results/verdicts.csv").exists():
        pytest.fail(f"{folder.relative_to(root)} is missing; run `make test`")
    return folder
