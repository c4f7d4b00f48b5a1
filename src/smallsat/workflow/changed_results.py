"""Results that are no longer what their job made, by Snakemake's own record of each.

Snakemake reruns what depends on a file that is newer than its products, and takes the file itself
as it is: truncated, emptied, or another's. Its record of a result holds when the result was
written; one that was written at another time, that is dated later than now, or whose record cannot
be read is made anew. A file that was exchanged under the very same time is not found here.
"""

import json
import math
import shutil
from base64 import urlsafe_b64decode
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

CHANGED = "changed after it was made"
FUTURE = "dated later than now"
UNKNOWN = "without a readable record of how it was made"


@dataclass(frozen=True)
class Record:
    """What Snakemake has noted of a result.

    Attributes
    ----------
    result, file
        The result, and the file of the record.
    written
        When the result was written, in seconds; None where the record cannot be read.
    inputs
        What it was made from.
    """

    result: Path
    file: Path
    written: float | None
    inputs: frozenset[Path]


def records(run: Path) -> list[Record]:
    """What Snakemake has noted of the results of a run that are there."""
    folder = run / ".snakemake/metadata"
    found = []
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        # A name that is too long for a file is cut into folders.
        parts = [part.removeprefix("@") for part in file.relative_to(folder).parts]
        try:
            result = run / urlsafe_b64decode("".join(parts)).decode()
        except ValueError:
            # No record.
            continue
        if not result.exists():
            continue
        try:
            content = json.loads(file.read_bytes())
            written = float(content["endtime"])
            inputs = frozenset(run / path for path in content["input"])
        except (ValueError, KeyError, TypeError):
            written, inputs = None, frozenset()
        found.append(Record(result, file, written, inputs))
    return found


def distrusted(known: Iterable[Record], now: float) -> Iterator[tuple[Record, str]]:
    """Results that are not to be built upon, and why; ``now`` is of the clock that dates files."""
    for record in known:
        times = [path.stat().st_mtime for path in _files(record.result)]
        if record.written is None:
            yield record, UNKNOWN
        elif any(time > now for time in times):
            yield record, FUTURE
        # Archives keep whole seconds.
        elif max(times, default=0.0) not in (record.written, math.floor(record.written)):
            yield record, CHANGED


def future_sources(known: Iterable[Record], now: float) -> list[Path]:
    """Files that results were made from, themselves no results, that are dated later than now."""
    known = list(known)
    sources = {path for record in known for path in record.inputs} - {
        record.result for record in known
    }
    return sorted(path for path in sources if path.is_file() and path.stat().st_mtime > now)


def remove(record: Record) -> None:
    """Remove a result and its record, so that whichever build needs it makes it."""
    if record.result.is_dir():
        shutil.rmtree(record.result)
    else:
        record.result.unlink()
    record.file.unlink()


def told(found: Iterable[tuple[Record, str]]) -> Iterator[str]:
    """A line for each reason, with the first of its results."""
    reasons: dict[str, list[str]] = {}
    for record, reason in found:
        reasons.setdefault(reason, []).append(str(record.result))
    for reason, names in reasons.items():
        more = f" (and {len(names) - 1} more)" if len(names) > 1 else ""
        yield f"{names[0]}{more}: {reason}; to be made anew"


def _files(result: Path) -> list[Path]:
    return [path for path in result.rglob("*") if path.is_file()] if result.is_dir() else [result]
