from pathlib import Path

import pytest

from smallsat.strict_yaml import read_yaml
from smallsat.studies.racing.parameters import parameters

CONFIG = Path(__file__).parents[2] / "config/default/racing.yaml"


@pytest.fixture(scope="session")
def config():
    return read_yaml(CONFIG)


@pytest.fixture(scope="session")
def section(config):
    return config["racing"]


@pytest.fixture(scope="session")
def given(section):
    return parameters(section)
