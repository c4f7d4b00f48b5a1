"""Notebooks run by hand: as they stand, from any folder, without touching what was built."""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from smallsat import by_hand
from smallsat.catalogue import read_catalogue
from smallsat.errors import InputError

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted(
    path
    for path in (ROOT / "notebooks").rglob("*.ipynb")
    if path.parent.name != ".ipynb_checkpoints"
)


def code(notebook):
    cells = json.loads(notebook.read_text())["cells"]
    return "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")


@pytest.fixture
def by_hand_project(tested_run, root, tmp_path, monkeypatch):
    """A project with the results of the tests' run for those of the reproduction."""
    for name, place in {
        "data/results": tested_run / "data/results",
        "data/published": root / "data/published",
        "config": root / "config",
        "notebooks": root / "notebooks",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).symlink_to(place)
    monkeypatch.setattr(by_hand, "PROJECT", tmp_path)
    return tmp_path


@pytest.fixture
def written(monkeypatch):
    """Files that a notebook would write, in place of writing them: drawing takes the longest."""
    files = []

    def save_figure(figure, stem, data):
        assert len(figure.axes) and len(data)
        files.append(Path(stem))

    def write_film(pictures, path, *rest):
        assert next(iter(pictures))
        files.append(Path(path))

    monkeypatch.setattr("smallsat.drawing.figure.save_figure", save_figure)
    monkeypatch.setattr("smallsat.drawing.film.write_film", write_film)
    monkeypatch.setattr("smallsat.studies.racing.figures.animation.write_film", write_film)
    monkeypatch.setattr(
        "smallsat.results.write_table", lambda table, path: files.append(Path(path))
    )
    return files


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_notebook_runs_as_it_stands(notebook, by_hand_project, written, monkeypatch):
    """From its own folder, with the parameters in it; all that it writes lies in runs/lab."""
    monkeypatch.chdir(by_hand_project / notebook.parent.relative_to(ROOT))
    exec(compile(code(notebook), notebook.name, "exec"), {})
    plt.close("all")
    assert written
    assert all(path.parts[:2] == ("runs", "lab") for path in written)
    assert Path.cwd() == by_hand_project


def test_no_notebook_of_a_build_warns(tested_run):
    """What a cell writes to the error stream names places of the machine that it ran on."""
    executed = sorted((tested_run / "data/results").glob("*/notebooks/*.ipynb"))
    assert executed
    warned = [
        (path.name, "".join(output["text"]))
        for path in executed
        for cell in json.loads(path.read_text())["cells"]
        for output in cell.get("outputs", [])
        if output.get("name") == "stderr"
    ]
    assert warned == []


def test_a_study_that_is_not_built_is_answered_with_what_to_build(tmp_path, monkeypatch):
    monkeypatch.setattr(by_hand, "PROJECT", tmp_path)
    monkeypatch.chdir("/")
    with pytest.raises(InputError) as error:
        by_hand.enter("data/results/mars")
    assert str(error.value) == "data/results/mars: no results; build it first: snakemake mars"


def test_results_in_reach_are_those_of_the_run(tmp_path, monkeypatch):
    """In the folder of a run nothing is changed: there a build gives every parameter."""
    (tmp_path / "data/results/mars").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    by_hand.enter("data/results/mars")
    assert Path.cwd() == tmp_path


def test_sections_of_a_notebook_by_hand_are_those_of_the_reproduction(root, config):
    for study in read_catalogue(root / "data/published"):
        section = config[study.name]
        assert by_hand.default_section(study.name) == section.only(type(section))
