"""The user's own settings reach nothing: the same bytes, always this environment."""

import json

import pytest

FIGURE = "figures/mars/fig-10"
FORMATS = ("svg", "pdf", "png", "csv")


@pytest.fixture(scope="module")
def built(make_project):
    """A project with one figure."""
    project = make_project()
    done = project.snakemake(f"{FIGURE}.svg")
    assert done.returncode == 0, done.stdout + done.stderr
    return project


def drawn(project):
    return {suffix: (project.folder / f"{FIGURE}.{suffix}").read_bytes() for suffix in FORMATS}


def drawn_again(project, **environment):
    """Bytes of the figure, drawn anew with these variables in the environment."""
    for suffix in FORMATS:
        (project.folder / f"{FIGURE}.{suffix}").unlink()
    done = project.run(project.command(f"{FIGURE}.svg"), **environment)
    assert done.returncode == 0, done.stdout + done.stderr
    return drawn(project)


def test_settings_of_matplotlib_ipython_jupyter_and_python(built, tmp_path):
    """A matplotlibrc, a start-up file that fails, a foreign kernel, a module that hides ours."""
    before = drawn(built)
    home, shadow = tmp_path / "home", tmp_path / "shadow"
    kernel = {"argv": ["/bin/false"], "display_name": "foreign", "language": "python"}
    for path, text in {
        home / ".config/matplotlib/matplotlibrc": "lines.linewidth: 9\nfont.size: 30\n",
        home / ".ipython/profile_default/startup/00.py": "raise SystemExit('started up')\n",
        home / ".local/share/jupyter/kernels/python3/kernel.json": json.dumps(kernel),
        shadow / "kernels/python3/kernel.json": json.dumps(kernel),
        shadow / "numpy.py": "raise SystemExit('the wrong numpy')\n",
        shadow / "matplotlibrc": "lines.linewidth: 9\n",
    }.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    after = drawn_again(
        built,
        HOME=str(home),
        MATPLOTLIBRC=str(shadow),
        MPLBACKEND="no-such-backend",
        IPYTHONDIR=str(home / ".ipython"),
        JUPYTER_PATH=str(shadow),
        PYTHONPATH=str(shadow),
        PIP_USER="1",
    )
    assert after == before


def test_a_home_that_cannot_be_written(built):
    """Nothing is kept outside the project."""
    before = drawn(built)
    assert drawn_again(built, HOME="/dev/null/home") == before


def test_a_file_of_the_run_is_no_module(built):
    """A file named like a library in the folder that jobs run in."""
    before = drawn(built)
    for name in ("numpy.py", "matplotlibrc"):
        (built.folder / name).write_text("raise SystemExit('the wrong one')\n")
    assert drawn_again(built) == before
