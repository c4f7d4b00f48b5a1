"""Processes of a build are forked from one that has imported the libraries.

Python imports NumPy, pandas, matplotlib and Jupyter in about two seconds, and a build starts some
four hundred processes. One that begins with the build imports them once. Each ``python -m
smallsat`` of the build hands its words over to it and waits, and a fork of it carries them out with
the files, the folder and the variables of the one that waits. Without a build, on another machine,
or with variables of its own a process does by itself what it was asked: the results are the same.

None outlives another. The server notices when who waits is gone, its end takes every fork along,
and it ends with its build. It is run by its path and imports nothing of the project, so that a fork
reads the sources as they are.
"""

import atexit
import ctypes
import gc
import json
import os
import secrets
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

# Where the server of a build listens, told to its jobs.
ADDRESS = "SMALLSAT_FORKS"
# Who waits for a fork, told to it.
WAITS = "SMALLSAT_WAITS"
# What a notebook needs comes first, so that a single figure need not wait for the rest.
LIBRARIES = (
    "pandas",
    "papermill",
    "matplotlib.pyplot",
    "matplotlib.backends.backend_svg",
    "matplotlib.backends.backend_pdf",
    "ipykernel.kernelapp",
    "matplotlib_inline.backend_inline",
    "pydantic",
    "yaml",
    "pyarrow.parquet",
    "scipy.optimize",
    "scipy.stats",
    "numba",
    "casadi",
)
# Variables that say who called and where to put what is temporary: no library looks at them as it
# is imported. An activated environment has a prompt, which the shells of jobs, at which nobody
# types, take away.
_CALLER = {"_", "PWD", "OLDPWD", "SHLVL", "PS1", "PS2", "TMPDIR", "TMP", "TEMP", "TEMPDIR", WAITS}
_CALLER |= {"JPY_PARENT_PID", "JPY_SESSION_NAME"}
# The option of Linux's prctl that ends a process with its parent.
_PR_SET_PDEATHSIG = 1


def _libraries_see(variables: Mapping[str, str]) -> dict[str, str]:
    """The variables by which a library may have been set up as it was imported."""
    return {name: value for name, value in variables.items() if name not in _CALLER}


def _address(token: str) -> str:
    """A name among those that are no files: it is gone when its process is."""
    return f"\0smallsat-{token}"


def _is_own(connection: socket.socket) -> bool:
    """Whether the same user is at the other end; such a name has no permissions."""
    packed = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
    _, user, _ = struct.unpack("3i", packed)
    return bool(user == os.getuid())


def possible() -> bool:
    """Whether a process can be watched: not beside Linux, on an old one and in some sandboxes."""
    try:
        os.close(os.pidfd_open(os.getpid()))
    except (AttributeError, OSError):
        return False
    return True


def begin() -> None:
    """Start the server of this build, where one is possible, and tell its jobs."""
    if not possible():
        return
    os.environ[ADDRESS] = secrets.token_hex(16)
    # Who asks before the server has started waits for it.
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(_address(os.environ[ADDRESS]))
        listener.listen(64)
        file = listener.fileno()
        # It ends by itself, with this process.
        call = [sys.executable, __file__, str(os.getpid()), str(file)]
        subprocess.Popen(call, stdin=subprocess.DEVNULL, pass_fds=[file])


def forked() -> int | None:
    """Status of a fork that did what this process was asked; None if there is none to do it."""
    token = os.environ.get(ADDRESS)
    if not token:
        return None
    # What ends who waits ends the fork.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _end_with(os.getppid())
    with socket.socket(socket.AF_UNIX) as connection:
        try:
            connection.connect(_address(token))
        except OSError:
            return None
        if not _is_own(connection):
            return None
        request = {
            "argv": sys.argv,
            "orig_argv": sys.orig_argv,
            "variables": dict(os.environ),
            "folder": str(Path.cwd()),
            "umask": _umask(),
            WAITS: os.getpid(),
        }
        try:
            socket.send_fds(connection, [b"\n"], [0, 1, 2])
            connection.sendall(json.dumps(request).encode() + b"\n")
            answer = connection.makefile().readline()
        except OSError:
            answer = ""
    if not answer:
        print("smallsat: the server of forks has ended; build again", file=sys.stderr)
        return 1
    status: int | None = json.loads(answer)
    if status is not None and status < 0:
        os.kill(os.getpid(), -status)
    return status


def _end_with(parent: int) -> None:
    """Have this process killed as soon as its parent ends."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _request(connection: socket.socket) -> dict[str, Any] | None:
    """What is asked, with its three files; None if nobody asks any more, or another user."""
    if not _is_own(connection):
        return None
    try:
        _, files, _, _ = socket.recv_fds(connection, 1, 3)
        line = connection.makefile().readline()
    except OSError:
        return None
    return json.loads(line) | {"files": files} if line.endswith("\n") else None


def _become(request: dict[str, Any]) -> None:
    """Make this fork the process that waits, in all that its work depends on."""
    for own, file in enumerate(request["files"]):
        os.dup2(file, own)
        os.close(file)
    os.environ.clear()
    os.environ.update(request["variables"] | {WAITS: str(request[WAITS])})
    if "JPY_PARENT_PID" in os.environ:
        # A kernel ends with its parent.
        os.environ["JPY_PARENT_PID"] = str(os.getppid())
    # Noted by who asked for it first.
    tempfile.tempdir = None
    os.chdir(request["folder"])
    os.umask(request["umask"])
    sys.argv, sys.orig_argv = request["argv"], request["orig_argv"]


@dataclass(frozen=True)
class _Fork:
    process: int
    connection: socket.socket


class Server:
    """Forks for each who asks, until the build ends.

    Parameters
    ----------
    build
        Process of the build.
    listener
        Open file of the socket at which it is asked.
    """

    def __init__(self, build: int, listener: int) -> None:
        self.listener = socket.socket(fileno=listener)
        self.build = os.pidfd_open(build)
        self.poll = select.poll()
        self.poll.register(self.listener, select.POLLIN)
        self.poll.register(self.build, select.POLLIN)
        # Some libraries set variables of their own as they are imported.
        self.variables = _libraries_see(os.environ)
        # By the file that tells of a fork's end, and by that to who waits for it.
        self.ends: dict[int, _Fork] = {}
        self.waiting: dict[int, _Fork] = {}

    def serve(self) -> None:
        """Serve and, while nobody asks, import; returns in the forks alone."""
        libraries = iter(LIBRARIES)
        library = next(libraries, None)
        while True:
            events = self.poll.poll(0 if library else None)
            if not events and library:
                import_module(library)
                library = next(libraries, None)
            # One at a time: the file of the next may be closed, and opened for another, meanwhile.
            for file, _ in events[:1]:
                if file == self.build:
                    os._exit(0)
                elif file == self.listener.fileno():
                    if self._fork():
                        return
                elif file in self.ends:
                    self._tell(file)
                else:
                    os.kill(self.waiting[file].process, signal.SIGKILL)
                    self.poll.unregister(file)

    def _fork(self) -> bool:
        """Accept a request; whether this is the fork."""
        connection, _ = self.listener.accept()
        request = _request(connection)
        if request is None or _libraries_see(request["variables"]) != self.variables:
            for file in request["files"] if request else ():
                os.close(file)
            with suppress(OSError), connection:
                connection.sendall(b"null\n")
            return False
        # The forks' searches for garbage need not look through the libraries.
        gc.freeze()
        server = os.getpid()
        process = os.fork()
        if not process:
            _end_with(server)
            for own in (self.listener, connection, *(one.connection for one in self.ends.values())):
                own.close()
            for number in (self.build, *self.ends):
                os.close(number)
            _become(request)
            return True
        for file in request["files"]:
            os.close(file)
        end = os.pidfd_open(process)
        self.ends[end] = self.waiting[connection.fileno()] = _Fork(process, connection)
        self.poll.register(end, select.POLLIN)
        # Tells only that nobody waits any more.
        self.poll.register(connection, 0)
        return False

    def _tell(self, end: int) -> None:
        """A fork has ended: say how to who waits."""
        fork = self.ends.pop(end)
        self.poll.unregister(end)
        os.close(end)
        file = fork.connection.fileno()
        del self.waiting[file]
        with suppress(KeyError):
            self.poll.unregister(file)
        _, status = os.waitpid(fork.process, 0)
        with suppress(OSError), fork.connection:
            fork.connection.sendall(f"{os.waitstatus_to_exitcode(status)}\n".encode())


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Server(int(sys.argv[1]), int(sys.argv[2])).serve()
    # Only a fork comes here. The names of this file are not the job's.
    from smallsat.__main__ import main
    from smallsat.errors import report_input_errors

    status = 0
    try:
        report_input_errors(main)
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        status = 1
    # Without taking all libraries apart again, object by object.
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
