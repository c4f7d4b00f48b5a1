"""Commands of the report: collect its content, compile it. ``python -m smallsat.report -h``."""

import argparse
import json
from pathlib import Path

from smallsat.config import default_config
from smallsat.errors import report_input_errors
from smallsat.report.content import collect
from smallsat.report.typesetting import compile_report
from smallsat.results import write_json


def main() -> None:
    """Parse the command line and run one command."""
    parser = argparse.ArgumentParser(prog="python -m smallsat.report", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)

    content = commands.add_parser("content", help="collect the results of a run as JSON")
    content.add_argument("--config", required=True, type=json.loads, help="whole configuration")
    content.add_argument("--project", required=True, type=Path, help="folder of the project")
    content.add_argument("--run", default=Path(), type=Path, help="folder of the run")
    content.add_argument("--left-out", default=[], type=json.loads, help="targets not made, JSON")
    content.add_argument("--studies", nargs="*", default=[], help="only these; else all")
    content.add_argument("--output", required=True, type=Path)

    compiling = commands.add_parser("compile", help="typeset the PDF and the page")
    compiling.add_argument("content", type=Path)
    compiling.add_argument("--project", required=True, type=Path, help="folder of the project")
    compiling.add_argument("--output", required=True, type=Path, help=".pdf or .html")

    arguments = parser.parse_args()
    if arguments.command == "content":
        default = default_config(arguments.project)
        collected = collect(
            arguments.project,
            arguments.run,
            arguments.config,
            default,
            arguments.left_out,
            arguments.studies,
        )
        write_json(collected, arguments.output)
    else:
        compile_report(arguments.content, arguments.project, arguments.output)


if __name__ == "__main__":
    report_input_errors(main)
