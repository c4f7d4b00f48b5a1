from pathlib import Path

import pytest

from smallsat.strict_yaml import read_yaml
from smallsat.studies.slew.parameters import parameters

CONFIG = Path(__file__).parents[2] / "config/default/slew.yaml"


@pytest.fixture(scope="session")
def section():
    return read_yaml(CONFIG)["slew"]


@pytest.fixture(scope="session")
def given(section):
    return parameters(section)
