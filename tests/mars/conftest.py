from pathlib import Path

import pytest

from smallsat.strict_yaml import read_yaml
from smallsat.studies.mars.methods.simulation import document_runs
from smallsat.studies.mars.parameters import parameters

CONFIG = Path(__file__).parents[2] / "config/default/mars.yaml"


@pytest.fixture(scope="session")
def section():
    return read_yaml(CONFIG)["mars"]


@pytest.fixture(scope="session")
def given(section):
    return parameters(section)


@pytest.fixture(scope="session")
def runs(section, given):
    return document_runs(section, given)
