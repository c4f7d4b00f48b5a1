"""Typeset the report: one Typst source, as a PDF or as a web page."""

import argparse
import re
from pathlib import Path
from typing import Literal

import typst

from smallsat.errors import InputError


def compile_report(content: Path, project: Path, output: Path) -> None:
    """Typeset the report; as a page if the output is an ``.html``. Works offline.

    Parameters
    ----------
    content
        JSON of `smallsat.report.content.collect`, in ``report/build`` of the run.
    project
        Folder of the project: the templates lie in ``report``, the run in it or below it.
    output
        Where the report goes, beside the content, so that the page's links hold.

    Raises
    ------
    InputError
        Naming the template or file that Typst stumbled over.
    """
    # Typst names files from the root, which is the project.
    root = project.resolve()
    run = output.resolve().parents[2].relative_to(root).as_posix()
    kind: Literal["pdf", "html"] = "html" if output.suffix == ".html" else "pdf"
    output.parent.mkdir(parents=True, exist_ok=True)
    partial = output.with_name(f".{output.name}.partial")
    inputs = {
        "content": "/" + content.resolve().relative_to(root).as_posix(),
        "run": "" if run == "." else f"/{run}",
        "format": kind,
    }
    try:
        typst.compile(
            root / "report/report.typ",
            output=partial,
            root=root,
            format=kind,
            sys_inputs=inputs,
            # The same fonts, and so the same bytes, on every machine.
            ignore_system_fonts=True,
        )
    except typst.TypstError as error:
        raise InputError(f"{output}: not typeset: {error.message}{_place(error)}") from None
    partial.replace(output)


def _place(error: typst.TypstError) -> str:
    """File, line and column of an error, after any warnings."""
    place = re.search(r"^error:.*?┌─ (\S+)", error.diagnostic, re.DOTALL | re.MULTILINE)
    return f" ({place[1]})" if place else ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``typeset``."""
    parser.add_argument("content", type=Path)
    parser.add_argument("--project", required=True, type=Path, help="folder of the project")
    parser.add_argument("--output", required=True, type=Path, nargs="+", help=".pdf or .html")


def main(arguments: argparse.Namespace) -> None:
    """Typeset every output that is asked for."""
    for output in arguments.output:
        compile_report(arguments.content, arguments.project, output)
