"""The studies of the project: the one list of them, read from each ``study.yaml``."""

from dataclasses import dataclass, fields
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from smallsat.errors import InputError
from smallsat.quantities import Part
from smallsat.strict_yaml import read_yaml

NUMBERS = ("order", "values", "artefacts")


@dataclass(frozen=True)
class Study:
    """A study and the document that it reruns.

    Attributes
    ----------
    name
        Name of its folders, of its section of the configuration and of its targets.
    order
        Place in the report; every study has another one.
    title, author, year
        How the document is named; author and year are empty where it does not say them.
    subject
        What the study is about, as a heading.
    values, artefacts
        Number of published values, and of tables, figures and films: none may be lost.
    """

    name: str
    order: int
    title: str
    subject: str
    values: int
    artefacts: int
    author: str = ""
    year: int | None = None


def read_catalogue(published: Path) -> list[Study]:
    """All studies in the order of the report.

    Parameters
    ----------
    published
        Folder ``data/published``: every folder in it that has a ``study.yaml`` is a study.

    Raises
    ------
    InputError
        Naming the file and the key that is missing, unknown, or an order that is taken.
    """
    studies = [_study(path) for path in sorted(published.glob("*/study.yaml"))]
    by_order: dict[int, Study] = {}
    for study in studies:
        if study.order in by_order:
            raise InputError(
                f"{published / study.name}/study.yaml: 'order' is {study.order}, as that of "
                f"{by_order[study.order].name}; give every study another one"
            )
        by_order[study.order] = study
    return [by_order[order] for order in sorted(by_order)]


def study_module(study: str, name: str) -> ModuleType | None:
    """A module of a study's code, such as ``figures.selection``; none if it has no such file."""
    folder = Path(__file__).parent / "studies" / study
    path = folder.joinpath(*name.split(".")).with_suffix(".py")
    return import_module(f"smallsat.studies.{study}.{name}") if path.exists() else None


def section_type(study: str) -> type[Part]:
    """The type of a study's section of the configuration."""
    module = study_module(study, "configuration")
    if module is None:
        raise InputError(f"src/smallsat/studies/{study}/configuration.py: no such file; write it")
    return module.Configuration


def _study(path: Path) -> Study:
    entries: Any = read_yaml(path)
    known = [field.name for field in fields(Study) if field.name != "name"]
    if not isinstance(entries, dict) or set(entries) - set(known):
        raise InputError(f"{path}: allowed are the keys {', '.join(known)}; correct it")
    if missing := {"title", "subject", *NUMBERS} - set(entries):
        raise InputError(f"{path}: '{min(missing)}' is missing; add it")
    for key in NUMBERS:
        if not isinstance(entries[key], int):
            raise InputError(f"{path}: '{key}' is {entries[key]!r}; give a whole number")
    return Study(path.parent.name, **entries)
