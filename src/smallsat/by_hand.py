"""A notebook run by hand, from whichever folder it is opened in.

A build runs a notebook in the folder of its run and gives it every parameter. By hand it runs with
the parameters that stand in it: it reads the results of the reproduction, and what it draws and
writes goes into ``runs/lab``, so that the reproduction stays as it was built.
"""

import os
from pathlib import Path
from typing import Any

from IPython.core.getipython import get_ipython
from IPython.core.interactiveshell import InteractiveShell
from IPython.core.pylabtools import select_figure_formats

from smallsat.catalogue import section_type
from smallsat.errors import InputError
from smallsat.quantities import Part
from smallsat.strict_yaml import read_yaml

PROJECT = Path(__file__).parents[2]


def enter(results: str | Path) -> None:
    """Make the project's folder the working folder, unless the results are in reach from here.

    Parameters
    ----------
    results
        Folder of a study's results, ``data/results/<study>``.

    Raises
    ------
    InputError
        If the study is not built, with the command that builds it.
    """
    results = Path(results)
    if results.is_dir():
        return
    if shell := get_ipython():
        _show(shell)
    os.chdir(PROJECT)
    if not results.is_dir():
        raise InputError(f"{results}: no results; build it first: snakemake {results.name}")


def _show(shell: InteractiveShell) -> None:
    """Show figures below the cell that draws them, and an `InputError` as its one line.

    A build shows neither: its figures are files, and matplotlib draws without a display.
    """
    from matplotlib_inline.backend_inline import show

    select_figure_formats(shell, {"png"})
    shell.events.register("post_run_cell", lambda _: show(close=True))
    # IPython asks an error how it is to be shown.
    InputError._render_traceback_ = lambda error: [f"smallsat: {error}"]  # type: ignore[attr-defined]


def default_section(study: str, kind: type[Part] | None = None) -> dict[str, Any]:
    """The documents' own values of a study, as a build of the reproduction gives them.

    Parameters
    ----------
    kind
        The part of the study's section that is asked for; else the whole.
    """
    values = read_yaml(PROJECT / f"config/default/{study}.yaml")[study]
    whole = section_type(study).model_validate(values)
    return whole.only(kind or type(whole))
