"""The user's own settings reach nothing: the same bytes, always this environment."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from smallsat.workflow.isolation import KERNEL, has_instructions, isolated

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


@pytest.mark.skipif(
    not has_instructions(Path("/proc/cpuinfo")), reason="this processor has another kernel"
)
@pytest.mark.parametrize(
    "theirs", [{}, {"OPENBLAS_CORETYPE": "Prescott", "OPENBLAS_L2_SIZE": "64"}]
)
@pytest.mark.parametrize("named", ["", "Sandybridge"])
def test_one_kernel_of_the_linear_algebra(tmp_path, theirs, named):
    """Whatever the processor and the user's settings; another only by the project's variable."""
    own = isolated(os.environ | theirs | {"SMALLSAT_KERNEL": named}, tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", "import numpy"],
        env=own | {"OPENBLAS_VERBOSE": "2"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr.split() == ["Core:", named or KERNEL]
    assert "OPENBLAS_L2_SIZE" not in own


def test_a_processor_without_the_instructions_keeps_its_own_kernel(tmp_path):
    """An old one, or one that says nothing of itself."""
    old = tmp_path / "cpuinfo"
    old.write_text("flags : sse2 avx\n")
    assert not has_instructions(old)
    assert not has_instructions(tmp_path / "none")
    old.write_text("flags : sse2 avx fma avx2\n")
    assert has_instructions(old)
