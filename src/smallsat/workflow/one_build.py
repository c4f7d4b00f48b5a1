"""One build a folder: a second one waits for the first, and no job outlives its build.

Snakemake's own lock is a file that a killed build leaves behind, so the profile does without it.
The lock here is the kernel's, which lets go of it whenever the process that holds it ends.
"""

import fcntl
import os
import select
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from smallsat.errors import InputError

# Names the process of the build, and the machine that it runs on, to its jobs.
BUILD = "SMALLSAT_BUILD"


def announced() -> dict[str, str]:
    """The variable that tells jobs that this process is their build."""
    return {BUILD: f"{os.getpid()}@{os.uname().nodename}"}


@contextmanager
def held(run: Path) -> Iterator[float]:
    """Hold the folder of a run alone, after whichever build holds it now.

    Parameters
    ----------
    run
        Folder of the run.

    Yields
    ------
    float
        The present time, in seconds, by the clock that dates the files of this folder.

    Raises
    ------
    InputError
        If nothing can be written in the folder.
    """
    path = run / ".snakemake/build.lock"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        # Not handed down to jobs, as Python opens files.
        lock = path.open("a")
        os.utime(path)
    except OSError as error:
        raise InputError(
            f"{run.absolute()}: a build cannot write here ({error.strerror}); make the folder"
            " writable, or free some of its disk"
        ) from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(
                f"smallsat: another build works in {run.absolute()}; waiting for its end",
                file=sys.stderr,
            )
            fcntl.flock(lock, fcntl.LOCK_EX)
            os.utime(path)
        yield path.stat().st_mtime


def end_with_build() -> None:
    """End this process when its build ends before it, and at once when it is interrupted.

    A job would otherwise go on after its build was killed, and write while the next one does. An
    interrupt is left to the kernel: a solver that catches it would call its case not converged.
    """
    build, _, machine = os.environ.get(BUILD, "").partition("@")
    if not build:
        return
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Not seen from another machine of a cluster, whose batch system ends jobs.
    if machine != os.uname().nodename or not hasattr(os, "pidfd_open"):
        return
    try:
        watched = os.pidfd_open(int(build))
    except ProcessLookupError:
        os._exit(1)
    except OSError:
        # A sandbox refuses it, or the system is old.
        return

    def watch() -> None:
        select.select([watched], [], [])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
