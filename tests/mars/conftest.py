import pytest

from smallsat.studies.mars.methods.simulation import document_runs
from smallsat.studies.mars.parameters import Parameters


@pytest.fixture(scope="session")
def section(config):
    return config.mars


@pytest.fixture(scope="session")
def parameters(section):
    return Parameters.from_section(section)


@pytest.fixture(scope="session")
def runs(section, parameters):
    return document_runs(section, parameters)
