import pytest

from smallsat.studies.racing.parameters import Parameters


@pytest.fixture(scope="session")
def section(config):
    return config.racing


@pytest.fixture(scope="session")
def parameters(section):
    return Parameters.from_section(section)
