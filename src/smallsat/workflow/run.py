"""A run: its configuration, checked in full before anything is computed, and its folder."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from smallsat.catalogue import study_module
from smallsat.config import Config, default_config, overlaid_config, run_folder, schema_of


@dataclass(frozen=True)
class Run:
    """A checked configuration and where its results go.

    Attributes
    ----------
    config
        The configuration; paths of course files are absolute, since jobs run in the run's folder.
    folder
        Folder of the run from the project's root; ``.`` for the reproduction.
    """

    config: Config
    folder: str


def read_run(project: Path, files: Iterable[Path], entries: Iterable[str]) -> Run:
    """The run that a person asks for.

    Parameters
    ----------
    project
        Folder of the project.
    files, entries
        What was given to ``--configfile`` and to ``--config``.

    Raises
    ------
    InputError
        Naming the first key or file that does not do, its value and what is allowed.
    """
    default = default_config(project)
    config = checked(overlaid_config(default, schema_of(project), files, entries))
    return Run(config, run_folder(config, default))


def checked(config: Config) -> Config:
    """A configuration that fits its schema, after the checks that a schema cannot make.

    Paths of course files become absolute.

    Raises
    ------
    InputError
        Naming the first key that does not do, its value and what is allowed.
    """
    return {
        key: _checked(key, value) if isinstance(value, dict) else value
        for key, value in config.items()
    }


def _checked(study: str, section: Config) -> Config:
    """The section after the checks of its study, if this has a module ``parameters``."""
    module = study_module(study, "parameters")
    return section if module is None else module.check(section)
