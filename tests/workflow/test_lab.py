"""Notebooks by hand in a kernel, as JupyterLab starts one: in the notebook's own folder."""

import json
import shutil

import pytest


@pytest.fixture
def outputs(project, tmp_path):
    """Function that runs a notebook by hand: what it shows, and what the command says."""

    def of(study, name):
        executed = tmp_path / "executed.ipynb"
        done = project.run(
            f". .venv/bin/activate && cd notebooks/{study}"
            f" && python -m smallsat notebook {name}.ipynb {executed}"
        )
        cells = json.loads(executed.read_text())["cells"]
        return [output for cell in cells for output in cell.get("outputs", [])], done

    return of


def test_a_figure_is_shown_and_lies_in_the_labs_own_folder(outputs, project, tested_run):
    """The reproduction, of which only two tables are there, is left as it was."""
    results = project.folder / "data/results/mars"
    results.mkdir(parents=True)
    for name in ("modes.csv", "mode-shares.csv"):
        shutil.copy(tested_run / "data/results/mars" / name, results)
    shown, done = outputs("mars", "day-modes")
    built = sorted(path.name for path in results.rglob("*"))
    shutil.rmtree(results)
    assert done.returncode == 0, done.stderr
    assert ["image/png" in output["data"] for output in shown] == [True]
    assert (project.folder / "runs/lab/figures/mars/day-modes.svg").exists()
    assert built == ["mode-shares.csv", "modes.csv"]
    assert [path.name for path in (project.folder / "figures").iterdir()] == ["README.md"]


def test_what_to_build_is_one_line(outputs):
    """In the notebook as in a terminal."""
    (error,), done = outputs("racing", "course")
    line = "smallsat: data/results/racing: no results; build it first: snakemake racing"
    assert error["traceback"] == [line]
    assert line in done.stderr.splitlines()


def test_make_installs_the_lab_only_once(project):
    """A checkout with it starts it; one without installs what the lock of its own says."""
    assert "requirements.lab.lock" in project.run("make -n lab").stdout
    (project.folder / ".venv/lab").touch()
    planned = project.run("make -n lab").stdout
    (project.folder / ".venv/lab").unlink()
    assert planned.splitlines() == ["python -m smallsat lab -- "]
