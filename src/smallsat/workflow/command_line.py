"""The command ``snakemake`` in this environment: Snakemake's own, called as a person means it.

Snakemake takes every word after ``--config`` for a setting and every word after ``--configfile``
for a file, a target too. Here a target is understood wherever it stands, a bad setting or file is
answered in one line, and the user's own settings of Python and Jupyter stay out.
"""

import gc
import os
import sys
import time
from argparse import ArgumentParser
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import Any

from smallsat.errors import InputError
from smallsat.workflow.changed_results import (
    distrusted,
    future_sources,
    make_anew,
    note,
    noted,
    told,
)
from smallsat.workflow.fork_server import begin
from smallsat.workflow.isolation import isolated
from smallsat.workflow.one_build import announced, held

PROJECT = Path(__file__).parents[3]

# New objects between two searches for garbage. So many are made before the first job, and kept,
# that with Python's own 700 a third of that time would go there.
OBJECTS = 1_000_000

# What only a target begins with, also one that ends in .json.
_RESULT_FOLDERS = ("figures/", "data/results/", "report/build/")


def _is_setting(word: str) -> bool:
    return "=" in word


def _is_file(word: str) -> bool:
    return Path(word).suffix in (".yaml", ".yml", ".json") and not word.startswith(_RESULT_FOLDERS)


_TAKES: dict[str, Callable[[str], bool]] = {
    "--config": _is_setting,
    "-C": _is_setting,
    "--configfile": _is_file,
    "--configfiles": _is_file,
}


def understood(words: Sequence[str]) -> list[str]:
    """The words of a call, with the targets first that an option would have swallowed.

    The first word after an option is always the option's own, so that a slip in it is refused.
    """
    targets: list[str] = []
    rest: list[str] = []
    belongs: Callable[[str], bool] | None = None
    for position, word in enumerate(words):
        if word == "--":
            return [*targets, *rest, *words[position:]]
        if word.startswith("-"):
            belongs = _TAKES.get(word)
        elif belongs is not None and words[position - 1] not in _TAKES and not belongs(word):
            targets.append(word)
            continue
        rest.append(word)
    return [*targets, *rest]


def settings_of(words: Sequence[str]) -> list[str]:
    """Those of understood words that say which run is meant: its settings and files."""
    kept: list[str] = []
    keeps = False
    for word in words:
        if word.startswith("-"):
            keeps = word.partition("=")[0] in _TAKES
        if keeps:
            kept.append(word)
    return kept


def check_settings(words: Sequence[str]) -> None:
    """Refuse settings and files that Snakemake would answer with a traceback.

    Raises
    ------
    InputError
        Naming the setting or file and what is wrong with it.
    """
    from smallsat.config import parse_entry, read_overlay

    option = ""
    for word in words:
        if word == "--":
            return
        values = [word]
        if word.startswith("-"):
            option, _, value = word.partition("=")
            values = [value] if value else []
        for value in values:
            if option in ("--config", "-C"):
                parse_entry(value)
            elif option in ("--configfile", "--configfiles"):
                read_overlay(Path(value))


def unlimited(make_parser: Callable[..., ArgumentParser]) -> Callable[..., ArgumentParser]:
    """Snakemake's maker of its parser, whose jobs a timespan have no limit unless one is given.

    Under a limit the scheduler wakes itself once a second more for each job that it has started,
    and each time asks for the size of every input of every job that is ready: minutes of processor
    time in a build of two hundred jobs.
    """

    def maker(*arguments: Any, **named: Any) -> ArgumentParser:
        parser = make_parser(*arguments, **named)
        parser.set_defaults(max_jobs_per_timespan=None)
        return parser

    return maker


def careful(execute: Callable[..., bool]) -> Callable[..., bool]:
    """Snakemake's execution of a workflow, alone in its folder and upon results that are as made.

    What is not as its job made it is marked first, so that it is made anew, and sources that are
    dated later than now are dated now: the clock was set back.
    """

    def executing(workflow: Any, executor_plugin: Any, *arguments: Any, **named: Any) -> bool:
        run, kind = Path(), executor_plugin.common_settings
        if kind.dryrun_exec:
            for line in told(distrusted(run, noted(run), time.time())):
                print(f"smallsat: {line}", file=sys.stderr)
            return execute(workflow, executor_plugin, *arguments, **named)
        try:
            with held(run) as now:
                # --touch takes everything as made.
                known = [] if kind.touch_exec else noted(run)
                found = list(distrusted(run, known, now))
                for line in told(found):
                    print(f"smallsat: {line}", file=sys.stderr)
                for path in future_sources(run, known, now):
                    os.utime(path)
                make_anew(run, [name for name, _ in found])
                return execute(workflow, executor_plugin, *arguments, **named)
        except InputError as error:
            sys.exit(f"smallsat: {error}")

    return executing


def noting(finished: Callable[..., Awaitable[None]]) -> Callable[..., Awaitable[None]]:
    """Snakemake's record of a job that has ended, with a digest of each of its results.

    The digest comes first: until the record is there, the results count as those of a killed job.
    """

    async def noting_finished(persistence: Any, job: Any) -> None:
        note(Path(), map(str, job.output))
        await finished(persistence, job)

    return noting_finished


def main() -> None:
    """Run Snakemake with the words of this call."""
    gc.set_threshold(OBJECTS)
    os.environ.update(announced())
    # Imports while Snakemake does, on another core.
    begin()
    from snakemake import cli
    from snakemake.persistence.file import FilePersistence
    from snakemake.workflow import Workflow

    words = understood(sys.argv[1:])
    check_settings(words)
    sys.argv = ["snakemake", *words]
    cli.get_argument_parser = unlimited(cli.get_argument_parser)
    Workflow.execute = careful(Workflow.execute)
    FilePersistence.finished = noting(FilePersistence.finished)
    # Parameters of rules are text here; Snakemake would import pandas to see that none is a table.
    FilePersistence._serialize_param_pandas = FilePersistence._serialize_param_builtin
    cli.main()


def snakemake() -> None:
    """Entry point: starts anew with an environment in which no setting of the user's is left."""
    call = [sys.executable, "-m", "smallsat.workflow.command_line", *sys.argv[1:]]
    os.execve(sys.executable, call, isolated(os.environ, PROJECT / ".cache"))


if __name__ == "__main__":
    from smallsat.errors import report_input_errors

    report_input_errors(main)
