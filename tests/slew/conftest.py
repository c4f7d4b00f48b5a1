from pathlib import Path

import pytest

from smallsat.slew.parameters import parameters
from smallsat.strict_yaml import read_yaml

CONFIG = Path(__file__).parents[2] / "config/default.yaml"


@pytest.fixture(scope="session")
def section():
    return read_yaml(CONFIG)["slew"]


@pytest.fixture(scope="session")
def given(section):
    return parameters(section)
