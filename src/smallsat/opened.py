"""Record which files of the project a process opens, to hold them against what its rule declares.

Asked for by the variable ``SMALLSAT_OPENED``, a folder: each process writes a file there, with its
command on the first line and then a file a line.
"""

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).parents[2]
# What is made by Python, Numba and Snakemake themselves.
BESIDES = (".venv", ".cache", ".snakemake", "logs")


def record(folder: Path) -> None:
    """Note from now on each file below the project that this process opens, once."""
    folder.mkdir(parents=True, exist_ok=True)
    file = (folder / f"{time.time_ns()}-{os.getpid()}.txt").open("w", buffering=1)
    file.write(json.dumps({"pid": os.getpid(), "parent": os.getppid(), "argv": sys.orig_argv}))
    file.write("\n")
    seen: set[Path] = set()

    def note(event: str, arguments: tuple[Any, ...]) -> None:
        if event != "open" or not isinstance(arguments[0], str | bytes | os.PathLike):
            return
        path = Path(os.fsdecode(arguments[0])).resolve()
        if path in seen or not path.is_relative_to(PROJECT):
            return
        seen.add(path)
        name = path.relative_to(PROJECT).as_posix()
        if not name.startswith(BESIDES) and "/numba-" not in name:
            file.write(f"{name}\n")

    sys.addaudithook(note)
