"""Record what a process imports and which data it opens, to hold it against what its rule declares.

Asked for by the variable ``SMALLSAT_OPENED``, a folder: each process writes a file there, with its
command on the first line and then a module or a file a line.
"""

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).parents[2]
# What is made by Python and Snakemake themselves. Sources are noted as they are imported.
BESIDES = (".venv", ".cache", ".snakemake", "logs", "src")


def record(folder: Path) -> None:
    """Note from now on each module of `smallsat` and each file of the project, once."""
    from smallsat.workflow.fork_server import WAITS

    folder.mkdir(parents=True, exist_ok=True)
    file = (folder / f"{time.time_ns()}-{os.getpid()}.txt").open("w", buffering=1)
    # A fork does the work of who waits for it.
    waits = os.environ.get(WAITS)
    parent = int(waits or os.getppid())
    process = {"pid": os.getpid(), "parent": parent, "fork": bool(waits), "argv": sys.orig_argv}
    file.write(json.dumps(process))
    file.write("\n")
    seen: set[str] = set()

    def note(event: str, arguments: tuple[Any, ...]) -> None:
        if event == "import" and arguments[0].startswith("smallsat"):
            name = f"src/{arguments[0].replace('.', '/')}.py"
        elif event == "open" and isinstance(arguments[0], str | bytes | os.PathLike):
            path = Path(os.fsdecode(arguments[0])).resolve()
            if not path.is_relative_to(PROJECT) or path.is_dir():
                return
            name = path.relative_to(PROJECT).as_posix()
            if name.startswith(BESIDES):
                return
        else:
            return
        if name not in seen:
            seen.add(name)
            file.write(f"{name}\n")

    sys.addaudithook(note)
