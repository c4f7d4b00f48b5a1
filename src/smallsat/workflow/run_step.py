"""Run one computing step of a study and write its tables."""

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, get_args, get_type_hints

from smallsat.results import write_table
from smallsat.shard import Shard
from smallsat.step import Step, Tables


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``run``."""
    parser.add_argument("study")
    parser.add_argument("step", help="a module of the study's steps")
    parser.add_argument("--config", required=True, type=json.loads, help="what it depends on, JSON")
    parser.add_argument("--results", required=True, type=Path, help="folder of its results")
    parser.add_argument("--published", default=Path(), type=Path, help="folder of its values")
    parser.add_argument("--accepted", default=Path(), type=Path, help="folder of what it accepts")
    parser.add_argument("--part", default="", help="of a step that runs in parts")
    parser.add_argument("--shard", default="1-of-1", help="of a step that is shared out")


def main(arguments: argparse.Namespace) -> None:
    """Run the step that the arguments name."""
    step = Step(
        arguments.config,
        arguments.results,
        arguments.published,
        arguments.accepted,
        arguments.part,
        Shard.parse(arguments.shard),
    )
    run_step(arguments.study, arguments.step, step)


def run_step(study: str, name: str, step: Step[Any]) -> None:
    """Run a step with what it asks for of the section; its tables go into the study's results."""
    run: Callable[[Step[Any]], Tables] = import_module(f"smallsat.studies.{study}.steps.{name}").run
    (kind,) = get_args(get_type_hints(run)["step"])
    for file, table in run(replace(step, section=kind.model_validate(step.section))).items():
        write_table(table, step.results / file)
