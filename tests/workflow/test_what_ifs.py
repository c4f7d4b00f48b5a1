"""The quick what-ifs, run as a user would; `make what-ifs` runs them all."""

import importlib.util
from pathlib import Path

import pytest

from smallsat.catalogue import read_catalogue

SCRIPT = Path(__file__).parents[1] / "what_ifs/run.py"
specification = importlib.util.spec_from_file_location("what_ifs", SCRIPT)
what_ifs = importlib.util.module_from_spec(specification)
specification.loader.exec_module(what_ifs)

ALL = what_ifs.read_what_ifs()
STUDIES = [study.name for study in read_catalogue(Path(__file__).parents[2] / "data/published")]


@pytest.mark.parametrize("study", STUDIES)
def test_every_study_has_ten_modest_what_ifs(study):
    """Ten at least that are to be done, and one at least that is to be refused."""
    expected = [what_if.expect for what_if in ALL if what_if.study == study]
    assert expected.count("done") >= 10
    assert "refused" in expected


@pytest.mark.parametrize("what_if", [w for w in ALL if w.quick], ids=lambda w: w.run)
def test_a_quick_what_if(project, what_if):
    """It ends as expected, without a traceback, and leaves the reproduction alone."""
    command = project.command()
    outcome = what_ifs.run(what_if, command, project.folder, env=project.environment)
    assert what_ifs.met(what_if, outcome), outcome
    assert [path.name for path in (project.folder / "data/results").iterdir()] == ["README.md"]
    # Cases of the document that are left out take their figures with them.
    if what_if.run == "what-if-transfer-few-cases":
        folder = project.folder / "runs" / what_if.run
        assert (folder / "data/results/transfer/tables/table-4.csv").exists()
        assert (folder / "figures/transfer/fig-25.svg").exists()
        assert not (folder / "figures/transfer/fig-27.svg").exists()
