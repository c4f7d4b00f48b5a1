import pytest

from smallsat.studies.slew.parameters import Parameters


@pytest.fixture(scope="session")
def section(config):
    return config.slew


@pytest.fixture(scope="session")
def parameters(section):
    return Parameters.from_section(section)
