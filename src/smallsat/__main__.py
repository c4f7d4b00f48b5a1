"""The commands of the workflow: ``python -m smallsat COMMAND -h``."""

import argparse
import sys
from importlib import import_module

from smallsat.errors import report_input_errors
from smallsat.workflow.fork_server import forked
from smallsat.workflow.one_build import end_with_build

# Each command is a module with `add_arguments` and `main`, and is imported alone: a rule's sources
# are those of its command. This file is a source of no rule, so that a new command reruns nothing.
COMMANDS = {
    "run": "smallsat.workflow.run_step",
    "notebook": "smallsat.workflow.notebook",
    "kernel": "smallsat.workflow.kernel",
    "judge": "smallsat.evidence.judge",
    "merge": "smallsat.evidence.merge",
    "summary": "smallsat.evidence.summary",
    "check": "smallsat.evidence.check",
    "accept": "smallsat.evidence.accept",
    "seconds": "smallsat.workflow.seconds",
    "explain": "smallsat.workflow.explain",
    "changes": "smallsat.workflow.changes",
    "compare": "smallsat.site.comparison",
    "dag": "smallsat.workflow.dag",
    "lab": "smallsat.workflow.lab",
    "content": "smallsat.report.content",
    "typeset": "smallsat.report.typesetting",
    "site": "smallsat.site.pages",
    "crate": "smallsat.workflow.crate",
    "verify": "smallsat.workflow.verify",
}


def main() -> None:
    """Parse the command line and run one command."""
    end_with_build()
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in COMMANDS:
        print(f"usage: python -m smallsat {{{','.join(COMMANDS)}}} ...", file=sys.stderr)
        raise SystemExit(2)
    command = import_module(COMMANDS[name])
    parser = argparse.ArgumentParser(prog=f"python -m smallsat {name}", description=command.__doc__)
    command.add_arguments(parser)
    command.main(parser.parse_args(sys.argv[2:]))


if __name__ == "__main__":
    status = forked()
    if status is not None:
        raise SystemExit(status)
    report_input_errors(main)
