"""The kernel of a notebook: what a notebook says comes out, and an end is told at once."""

import sys
from argparse import Namespace

import nbformat
import pytest
from papermill import PapermillExecutionError

from smallsat.errors import InputError
from smallsat.workflow.kernel import Kernel
from smallsat.workflow.notebook import main


@pytest.fixture
def executed(tmp_path):
    """Runs the cells of a notebook, and gives what came of them."""

    def run(*cells):
        asked = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
        asked.metadata["kernelspec"] = {"name": "python3", "display_name": "", "language": "python"}
        nbformat.write(asked, tmp_path / "asked.ipynb")
        main(
            Namespace(
                notebook=tmp_path / "asked.ipynb", executed=tmp_path / "done.ipynb", parameters={}
            )
        )
        return nbformat.read(tmp_path / "done.ipynb", as_version=4).cells

    return run


def test_all_that_cells_say_is_kept(executed):
    """In order, from the first cell on: nothing is lost to a client that listens late."""
    cells = executed("print('first')", "1 + 1", "print('last')")
    assert cells[0].outputs[0].text == "first\n"
    assert cells[1].outputs[0].data["text/plain"] == "2"
    assert cells[2].outputs[0].text == "last\n"


def test_a_kernel_that_ends_before_it_answers_is_told(executed, monkeypatch):
    """In place of a wait for a minute."""
    monkeypatch.setattr(
        Kernel, "format_kernel_cmd", lambda *_, **__: [sys.executable, "-c", "pass"]
    )
    with pytest.raises(RuntimeError, match="ended before it answered"):
        executed("1")


def test_an_error_in_a_cell_stops_the_notebook(executed):
    """Bad input as its one line, anything else with its cell."""
    with pytest.raises(InputError, match=r"^a\.yaml: no such file$"):
        executed(
            "from smallsat.errors import InputError", "raise InputError('a.yaml: no such file')"
        )
    with pytest.raises(PapermillExecutionError, match="division by zero"):
        executed("1 / 0")
