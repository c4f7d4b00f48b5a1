"""Copies of the project for the tests of the workflow."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.project_copy import Project, copy_project


@pytest.fixture(scope="session")
def make_project(root: Path, tmp_path_factory) -> Callable[[], Project]:
    """Function that copies what belongs to the project into a fresh folder."""
    return lambda: copy_project(root, tmp_path_factory.mktemp("project"))


@pytest.fixture(scope="session")
def project(make_project) -> Project:
    """One copy for all tests that only read, or that clean up after themselves."""
    return make_project()
