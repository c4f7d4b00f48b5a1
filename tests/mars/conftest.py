from pathlib import Path

import pytest

from smallsat.mars.parameters import parameters
from smallsat.mars.simulation import document_runs
from smallsat.strict_yaml import read_yaml

CONFIG = Path(__file__).parents[2] / "config/default.yaml"


@pytest.fixture(scope="session")
def section():
    return read_yaml(CONFIG)["mars"]


@pytest.fixture(scope="session")
def given(section):
    return parameters(section)


@pytest.fixture(scope="session")
def runs(section, given):
    return document_runs(section, given)
