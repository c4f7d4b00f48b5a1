"""Hold a finished build against its crate: which files are missing, changed or unknown to it.

Exits with 1 if there is such a file.
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from smallsat.errors import InputError
from smallsat.strict_yaml import read_bytes
from smallsat.workflow.crate import sha256
from smallsat.workflow.job_records import files_of

# All that a build makes lies in them.
FOLDERS = ("data/results", "figures", "report/build")


def recorded(crate: Path) -> dict[str, str]:
    """SHA-256 of each file that a crate records, by its path from the folder of the crate.

    Raises
    ------
    InputError
        If it is no crate with such files, or names one outside its folder.
    """
    try:
        graph = json.loads(read_bytes(crate))["@graph"]
        found = {unquote(one["@id"]): one["sha256"] for one in graph if "sha256" in one}
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{crate}: no crate of a build; delete it and run `make`") from None
    for name in found:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise InputError(f"{crate}: names '{name}', outside of its folder; get it anew")
    return found


def differences(project: Path, hashes: dict[str, str]) -> Iterator[tuple[str, str]]:
    """What is wrong with a file, and the file: all that are not as recorded, in order.

    Parameters
    ----------
    project
        Folder of the build.
    hashes
        What `recorded` found.
    """
    there = {
        name
        for folder in FOLDERS
        if (project / folder).is_dir()
        for name in files_of(project, folder)
    }
    for name in sorted(there | hashes.keys()):
        path = project / name
        if name not in hashes:
            yield "unknown", name
        elif not path.is_file():
            yield "missing", name
        elif sha256(path) != hashes[name]:
            yield "changed", name


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``verify``."""
    parser.add_argument("--project", type=Path, default=Path(), help="folder of the build")
    parser.add_argument("--crate", type=Path, default=Path("ro-crate-metadata.json"))


def main(arguments: argparse.Namespace) -> None:
    """Print a line for each file that is not as recorded, and a summary."""
    if not arguments.crate.exists():
        raise InputError(f"{arguments.crate}: no such file; run `make`, which ends with it")
    hashes = recorded(arguments.crate)
    found = list(differences(arguments.project, hashes))
    for problem, name in found:
        print(f"{problem}: {name}")
    counts = [
        f"{sum(one == problem for one, _ in found)} {problem}"
        for problem in ("missing", "changed", "unknown")
    ]
    print(f"{len(hashes)} files are recorded; {', '.join(counts)}")
    raise SystemExit(bool(found))
