"""Names that files of the project give to what a build makes: plain ones, inside of their study.

They become paths and words of a shell, so that any other could write outside of the project, or run
a command.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from smallsat.errors import InputError
from smallsat.workflow.figures import NotebookRun

_PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


def rule_name(study: str, name: str) -> str:
    """The rule of a step or a notebook run of a study."""
    return f"{study}_{name}".replace("-", "_")


def check_names(
    study: str,
    artefacts: Iterable[Mapping[str, str]],
    beyond: Iterable[Mapping[str, object]],
    runs: Iterable[NotebookRun],
) -> None:
    """Refuse a name that is not of letters, digits, '.', '_' and '-', or leads elsewhere.

    Parameters
    ----------
    study
        Name of the study, that of its folders.
    artefacts, beyond
        Entries of ``artefacts.csv`` and of ``extras.yaml``.
    runs
        Runs of its notebooks, from ``figures.yaml``.

    Raises
    ------
    InputError
        Naming the file, the name and what is allowed.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", study):
        raise InputError(
            f"data/published/{study!r}: no name of a study; give one of small letters and digits"
        )
    published = f"data/published/{study}"
    for row in artefacts:
        if row["target"]:
            _check_target(f"{published}/artefacts.csv", study, row["target"])
    for entry in beyond:
        stems = entry.get("figures") or []
        targets = [entry["table"]] if entry.get("table") else []
        for target in [*targets, *(stems if isinstance(stems, list) else [stems])]:
            _check_target(f"{published}/extras.yaml", study, str(target))
    for run in runs:
        film = [run.film] if run.film else []
        for name in (run.name, run.notebook, *run.figures, *film, *run.reads, *run.makes):
            _check(f"notebooks/{study}/figures.yaml", name, Path(name).parts)


def _check_target(file: str, study: str, target: str) -> None:
    folders = (("figures", study), ("data", "results", study))
    parts = Path(target).parts
    inside = any(parts[: len(folder)] == folder and parts[len(folder) :] for folder in folders)
    _check(file, target, parts if inside else ())


def _check(file: str, name: str, parts: tuple[str, ...]) -> None:
    if not parts or not all(_PLAIN.fullmatch(part) for part in parts):
        raise InputError(
            f"{file}: {name!r} is not allowed; must be of letters, digits, '.', '_' and '-', "
            "and lie in the folders of the study"
        )
