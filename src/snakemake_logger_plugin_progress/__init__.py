"""Snakemake's logger ``progress``, which it finds by the name of this package.

It prints what `smallsat.workflow.progress` says of a build, and leaves to Snakemake's own handler
whatever else there is to print: warnings, dry runs, all that comes before the first job. With
``--printshellcmds`` (``-p``), ``--verbose`` or ``--debug-dag`` everything is Snakemake's own.
"""

import logging
import shutil
import sys

from snakemake.logging import ColorizingTextHandler, DefaultFilter, DefaultFormatter, is_quiet_about
from snakemake_interface_logger_plugins.base import LogHandlerBase

from smallsat.workflow.progress import Progress


class LogHandler(LogHandlerBase):
    """Prints the progress of a build; on a terminal its last line says what is running."""

    writes_to_stream = True
    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = True

    def __post_init__(self) -> None:
        """Make Snakemake's own handler, as it would itself, for what is left to it."""
        given = self.common_settings
        self.stream = sys.stdout if given.stdout else sys.stderr
        self.own = ColorizingTextHandler(nocolor=given.nocolor, stream=self.stream)
        self.own.setFormatter(DefaultFormatter(given.quiet, given.show_failed_logs))
        self.own.addFilter(
            DefaultFilter(
                given.quiet, given.debug_dag, given.verbose, given.dryrun, given.printshellcmds
            )
        )
        self.all_own = any((given.dryrun, given.verbose, given.printshellcmds, given.debug_dag))
        self.progress = Progress()
        self.live = self.own.is_tty and not is_quiet_about(given.quiet or (), "progress")
        self.running = ""

    def emit(self, record: logging.LogRecord) -> None:
        """Print what there is to say about an event."""
        try:
            if self.all_own:
                self.own.handle(record)
            else:
                self._tell(record)
        except Exception:
            self.handleError(record)

    def _tell(self, record: logging.LogRecord) -> None:
        lines = self.progress.lines(record)
        if lines is None and (not self.progress.begun or record.levelno >= logging.WARNING):
            self._live("")
            self.own.handle(record)
        elif lines and self.own.filter(record):
            self._print(lines)
        self._live(self.progress.status)

    def close(self) -> None:
        """Say once more what failed."""
        if not is_quiet_about(self.common_settings.quiet or (), "rules"):
            self._print(self.progress.end())
        self.progress.failed.clear()
        super().close()

    def _print(self, lines: list[str]) -> None:
        self._live("")
        self.stream.writelines(f"{line}\n" for line in lines)
        self.stream.flush()

    def _live(self, running: str) -> None:
        """Let the last line of a terminal say what is running, or nothing."""
        if running != self.running and self.live:
            self.running = running
            width = shutil.get_terminal_size().columns - 1
            self.stream.write(f"\r\033[K{f'running: {running}'[:width] if running else ''}")
            self.stream.flush()
