"""Run one parameterised notebook with papermill."""

import argparse
import json
import warnings
from pathlib import Path

from smallsat.errors import InputError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``notebook``."""
    parser.add_argument("notebook", type=Path)
    parser.add_argument("executed", type=Path, help="where the executed notebook goes")
    parser.add_argument("--parameters", type=json.loads, default={}, help="JSON object")


def main(arguments: argparse.Namespace) -> None:
    """Execute a notebook; an `InputError` raised inside it is reported as one line."""
    # The kernel's transport warning is harmless and would be in every log.
    warnings.filterwarnings("ignore", module="zmq")
    import papermill

    from smallsat.workflow.kernel import Kernel

    try:
        papermill.execute_notebook(
            arguments.notebook,
            arguments.executed,
            parameters=arguments.parameters,
            progress_bar=False,
            kernel_name="python3",
            kernel_manager_class=Kernel,
            # Asked to end by itself, one of ten does not and is waited for.
            shutdown_kernel="immediate",
        )
    except papermill.PapermillExecutionError as error:
        if error.ename == "InputError":
            raise InputError(error.evalue) from None
        raise
