"""What several test files need: the project's folder and its default configuration."""

import gc
from pathlib import Path

import pytest

from smallsat.config import Config, default_config
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.ledger import Ledger, read_artefacts, read_ledger
from smallsat.quantities import Part
from smallsat.workflow.isolation import isolate

# What is collected is kept: to look through it for garbage so often takes a tenth of the time.
gc.set_threshold(200_000)

ROOT = Path(__file__).parents[1]
# Before matplotlib or Jupyter is imported: the settings of whoever runs the tests stay out.
isolate(ROOT / ".cache")


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def config() -> Config:
    return default_config(ROOT)


@pytest.fixture(scope="session")
def changed():
    """A part of the configuration with another value at a dotted key, one not allowed even."""

    def of(part: Part, key: str, value):
        name, _, below = key.replace("-", "_").partition(".")
        assert name in type(part).model_fields
        update = {name: of(part[name], below, value) if below else value}
        return part.model_copy(update=update)

    return of


@pytest.fixture(scope="session")
def ledger(root):
    """The ledger of a study, with other literals at some ids."""

    def of(study: str, printed: dict[str, str] | None = None) -> Ledger:
        rows = read_ledger(root / f"data/published/{study}/values.csv")
        changed = {f"{study}/{name}": literal for name, literal in (printed or {}).items()}
        assert changed.keys() <= {row["id"] for row in rows}
        new = [row | {"printed": changed.get(row["id"], row["printed"])} for row in rows]
        return Ledger(new, study)

    return of


@pytest.fixture(scope="session")
def grounds(root, ledger):
    """The grounds of a study for its section and results, with other literals at some ids."""

    def of(study: str, section: Part, results: Path, printed: dict[str, str] | None = None):
        artefacts = read_artefacts(root / f"data/published/{study}/artefacts.csv")
        captions = {row["id"]: row["caption"] for row in artefacts}
        return Grounds(section, results, ledger(study, printed), captions)

    return of


@pytest.fixture(scope="session")
def tested_run(root) -> Path:
    """Folder of the run that `make test` makes: all in full, statistical parts for a share."""
    folder = root / "runs/tests"
    if not (folder / "data/results/verdicts.csv").exists():
        pytest.fail(f"{folder.relative_to(root)} is missing; run `make test`")
    return folder
