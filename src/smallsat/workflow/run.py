"""A run: its configuration, checked in full before anything is computed, and its folder."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from smallsat.config import Config, default_config, overlaid_config, run_folder, schema_of
from smallsat.studies.mars.parameters import check as check_mars
from smallsat.studies.racing.parameters import parameters as check_racing
from smallsat.studies.racing.parameters import with_absolute_course_files
from smallsat.studies.rendezvous.parameters import check as check_rendezvous
from smallsat.studies.slew.parameters import check as check_slew
from smallsat.studies.transfer.parameters import check as check_transfer


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
    config = with_absolute_course_files(config)
    check_transfer(config["transfer"])
    check_mars(config["mars"])
    check_slew(config["slew"])
    check_racing(config["racing"])
    check_rendezvous(config["rendezvous"])
    return config
