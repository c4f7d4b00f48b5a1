"""Typeset the report: one Typst source, as a PDF or, part by part, for web pages."""

import argparse
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import typst

from smallsat.errors import InputError


def compile_report(content: Path, project: Path, output: Path) -> None:
    """Typeset the report as a PDF. Works offline.

    Parameters
    ----------
    content
        JSON of `smallsat.report.content.collect`, in ``report/build`` of the run.
    project
        Folder of the project: the templates lie in ``report``, the run in it or below it.
    output
        Where the report goes.

    Raises
    ------
    InputError
        Naming the template or file that Typst stumbled over.
    """
    partial = output.with_name(f".{output.name}.partial")
    partial.write_bytes(_typeset(content, project, "pdf"))
    partial.replace(output)


def compile_part(content: Path, project: Path, part: str, up: str) -> str:
    """One part of the report as a page: ``front``, ``pipeline``, or a study by its name.

    Parameters
    ----------
    content, project
        As for `compile_report`.
    up
        Path from the page that it becomes a part of to the folder of the run.
    """
    return _typeset(content, project, "html", {"part": part, "up": up}).decode()


def _typeset(
    content: Path, project: Path, kind: Literal["pdf", "html"], more: Mapping[str, str] = {}
) -> bytes:
    # Typst names files from the root, which is the project.
    root, place = project.resolve(), content.resolve()
    run = place.parents[2].relative_to(root).as_posix()
    inputs = {
        "content": "/" + place.relative_to(root).as_posix(),
        "run": "" if run == "." else f"/{run}",
        "format": kind,
        **more,
    }
    try:
        return typst.compile(
            root / "report/report.typ",
            root=root,
            format=kind,
            sys_inputs=inputs,
            # The same fonts, and so the same bytes, on every machine.
            ignore_system_fonts=True,
            # Tagged, so that it can be read aloud, and kept for long.
            pdf_standards=["ua-1", "a-2a"] if kind == "pdf" else [],
        )
    except typst.TypstError as error:
        raise InputError(f"{content}: not typeset: {error.message}{_place(error)}") from None


def _place(error: typst.TypstError) -> str:
    """File, line and column of an error, after any warnings."""
    place = re.search(r"^error:.*?┌─ (\S+)", error.diagnostic, re.DOTALL | re.MULTILINE)
    return f" ({place[1]})" if place else ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``typeset``."""
    parser.add_argument("content", type=Path)
    parser.add_argument("--project", required=True, type=Path, help="folder of the project")
    parser.add_argument("--output", required=True, type=Path, help="a .pdf")


def main(arguments: argparse.Namespace) -> None:
    """Typeset the report."""
    compile_report(arguments.content, arguments.project, arguments.output)
