"""Run one parameterised notebook with papermill. ``python -m smallsat.workflow.notebook -h``."""

import argparse
import json
import warnings
from pathlib import Path

from smallsat.errors import InputError, report_input_errors


def main() -> None:
    """Execute a notebook; an `InputError` raised inside it is reported as one line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("notebook", type=Path)
    parser.add_argument("executed", type=Path, help="where the executed notebook goes")
    parser.add_argument("--parameters", type=json.loads, default={}, help="JSON object")
    arguments = parser.parse_args()

    # The kernel's transport warning is harmless and would be in every log.
    warnings.filterwarnings("ignore", module="zmq")
    import papermill

    try:
        papermill.execute_notebook(
            arguments.notebook,
            arguments.executed,
            parameters=arguments.parameters,
            progress_bar=False,
            kernel_name="python3",
        )
    except papermill.PapermillExecutionError as error:
        if error.ename == "InputError":
            raise InputError(error.evalue) from None
        raise


if __name__ == "__main__":
    report_input_errors(main)
