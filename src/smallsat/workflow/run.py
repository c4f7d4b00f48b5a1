"""A run: its configuration, checked in full before anything is computed, and its folder."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from smallsat.catalogue import study_module
from smallsat.config import Config, default_config, overlaid_config, run_folder


@dataclass(frozen=True)
class Run:
    """A checked configuration and where its results go.

    Attributes
    ----------
    config, default
        The configuration, and the documents' own values.
    folder
        Folder of the run from the project's root; ``.`` for the reproduction.
    """

    config: Config
    default: Config
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
    config = overlaid_config(default, files, entries)
    check(config, default)
    return Run(config, default, run_folder(config, default))


def check(config: Config, default: Config) -> None:
    """Refuse what no type can, by the checks of each study that has a module ``parameters``.

    A section that is as the documents have it is passed over: the tests check those, and a call of
    Snakemake loads the models of the studies that a person changes alone.

    Raises
    ------
    InputError
        Naming the first key that does not do, its value and what is allowed.
    """
    for study, section in config:
        if section != default[study] and (module := study_module(study, "parameters")):
            module.check(section)
