"""Compare two builds byte by byte: ``python tests/compare_builds.py BEFORE AFTER``.

For changes that must not change a result. All tables and figures are compared, except what depends
on the clock: tables of seconds and executed notebooks.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

FOLDERS = ("data/results", "figures")
CLOCK = ("seconds", "timings", "notebooks/")


def results(build: Path) -> set[str]:
    """Files of a build that two runs of the same code have in common, relative to its folder."""
    found = (
        path.relative_to(build).as_posix()
        for folder in FOLDERS
        for path in (build / folder).rglob("*")
        if path.is_file()
    )
    return {name for name in found if not any(word in name for word in CLOCK)}


def differences(before: Path, after: Path) -> Iterator[str]:
    """A line for each file that is missing, new or other than before."""
    old, new = results(before), results(after)
    yield from (f"gone: {name}" for name in sorted(old - new))
    yield from (f"new: {name}" for name in sorted(new - old))
    for name in sorted(old & new):
        if (before / name).read_bytes() != (after / name).read_bytes():
            yield f"differs: {name}"


def main() -> None:
    """Print the differences; exit with 1 if there are any."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    arguments = parser.parse_args()
    found = list(differences(arguments.before, arguments.after))
    print("\n".join([*found, f"{len(results(arguments.after))} files, {len(found)} differences"]))
    raise SystemExit(bool(found))


if __name__ == "__main__":
    main()
