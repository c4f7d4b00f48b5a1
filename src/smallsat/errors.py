"""The one error that a person's input can cause, and how a command reports it."""

import sys
from collections.abc import Callable


class InputError(Exception):
    """Bad input: one line that names the key or file, the value, what is allowed, what to do."""


def report_input_errors(main: Callable[[], None]) -> None:
    """Run a command; print an `InputError` as one line on stderr and exit with status 2."""
    try:
        main()
    except InputError as error:
        print(f"smallsat: {error}", file=sys.stderr)
        raise SystemExit(2) from None
