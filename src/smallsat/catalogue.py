"""The studies of the project: the one list of them, read from each ``study.yaml``."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from smallsat.errors import InputError
from smallsat.strict_yaml import read_yaml


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
        Of the document; author and year are empty where the document does not name them.
    subject
        What the study is about, as a heading.
    """

    name: str
    order: int
    title: str
    subject: str
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


def _study(path: Path) -> Study:
    entries: Any = read_yaml(path)
    known = [field.name for field in fields(Study) if field.name != "name"]
    if not isinstance(entries, dict) or set(entries) - set(known):
        raise InputError(f"{path}: allowed are the keys {', '.join(known)}; correct it")
    if missing := {"order", "title", "subject"} - set(entries):
        raise InputError(f"{path}: '{min(missing)}' is missing; add it")
    if not isinstance(entries["order"], int):
        raise InputError(f"{path}: 'order' is {entries['order']!r}; give a whole number")
    return Study(path.parent.name, **entries)
