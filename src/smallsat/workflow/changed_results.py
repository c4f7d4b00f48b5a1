"""Results that are no longer what their job made, so that a build makes them anew.

Snakemake reruns what depends on a file that is newer than its products, and takes the file itself
as it is: truncated, emptied, or another's. Here a digest of each result is noted when its job ends.
One whose bytes are others, that is dated later than now, or whose record by Snakemake cannot be
read is marked as Snakemake marks what a killed job has left. A result that was made before digests
were noted is held against the date in its record instead.
"""

import hashlib
import json
import math
from base64 import urlsafe_b64decode, urlsafe_b64encode
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

CHANGED = "changed after it was made"
FUTURE = "dated later than now"
UNKNOWN = "without a readable record of how it was made"

# Below the folder of the run; the first two are Snakemake's own.
RECORDS = Path(".snakemake/metadata")
MARKS = Path(".snakemake/incomplete")
DIGESTS = Path(".snakemake/digests")
# The longest part of a path, less one, as Snakemake cuts the names of its records.
LONGEST = 254


@dataclass(frozen=True)
class Noted:
    """What is known of a result.

    Attributes
    ----------
    name
        Its path in the run.
    digest
        Of its bytes when its job ended; None if it was not noted.
    recorded, written
        Whether Snakemake has a record of it, and its date in seconds; None if that cannot be read.
    inputs
        What it was made from, as paths in the run.
    """

    name: str
    digest: str | None
    recorded: bool
    written: float | None
    inputs: frozenset[str]


def note(run: Path, names: Iterable[str]) -> None:
    """Note the digests of results whose job has ended; --touch asks for some that are not there."""
    for name in filter(lambda name: (run / name).exists(), names):
        path = _place(run / DIGESTS, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(digest(run / name))


def noted(run: Path) -> list[Noted]:
    """What is known of the results of a run that are there."""
    names = {name for folder in (RECORDS, DIGESTS) for name in _names(run / folder)}
    return [_noted(run, name) for name in sorted(names) if (run / name).exists()]


def distrusted(run: Path, known: Iterable[Noted], now: float) -> Iterator[tuple[str, str]]:
    """Results that are not to be built upon, and why; ``now`` is of the clock that dates files."""
    for result in known:
        times = [path.stat().st_mtime for path in _files(run / result.name)]
        if result.recorded and result.written is None:
            yield result.name, UNKNOWN
        elif any(time > now for time in times):
            yield result.name, FUTURE
        elif result.digest is not None:
            if digest(run / result.name) != result.digest:
                yield result.name, CHANGED
        # Archives keep whole seconds.
        elif max(times, default=0.0) not in (result.written, math.floor(result.written or 0.0)):
            yield result.name, CHANGED


def future_sources(run: Path, known: Iterable[Noted], now: float) -> list[Path]:
    """Files that results were made from, themselves no results, that are dated later than now."""
    known = list(known)
    sources = {name for result in known for name in result.inputs}
    paths = [run / name for name in sorted(sources - {result.name for result in known})]
    return [path for path in paths if path.is_file() and path.stat().st_mtime > now]


def make_anew(run: Path, names: Iterable[str]) -> None:
    """Mark results as incomplete: whichever build needs them makes them, all that their job makes.

    A record that cannot be read is removed; some would end Snakemake with a traceback.
    """
    for name in names:
        mark = _place(run / MARKS, name)
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.write_text(json.dumps({"external_jobid": None}))
        record = _place(run / RECORDS, name)
        if record.exists() and _record(record) is None:
            record.unlink()


def told(found: Iterable[tuple[str, str]]) -> Iterator[str]:
    """A line for each reason, with the first of its results."""
    reasons: dict[str, list[str]] = {}
    for name, reason in found:
        reasons.setdefault(reason, []).append(name)
    for reason, names in reasons.items():
        more = f" (and {len(names) - 1} more)" if len(names) > 1 else ""
        yield f"{names[0]}{more}: {reason}; to be made anew"


def digest(result: Path) -> str:
    """SHA-256 of a file, or of the names and bytes of all files in a folder."""
    whole = hashlib.sha256()
    for path in _files(result):
        if path != result:
            whole.update(path.relative_to(result).as_posix().encode() + b"\0")
        with path.open("rb") as file:
            whole.update(hashlib.file_digest(file, "sha256").digest())
    return whole.hexdigest()


def _noted(run: Path, name: str) -> Noted:
    stored, record = _place(run / DIGESTS, name), _place(run / RECORDS, name)
    written, inputs = (_record(record) if record.exists() else None) or (None, frozenset())
    value = stored.read_text(errors="replace") if stored.exists() else None
    return Noted(name, value, record.exists(), written, inputs)


def _record(path: Path) -> tuple[float, frozenset[str]] | None:
    try:
        content = json.loads(path.read_bytes())
        return float(content["endtime"]), frozenset(content["input"])
    except (ValueError, KeyError, TypeError):
        return None


def _place(folder: Path, name: str) -> Path:
    """Where Snakemake keeps what it knows of a file: long names are cut into folders."""
    coded = urlsafe_b64encode(name.encode()).decode()
    parts = [coded[i : i + LONGEST] for i in range(0, len(coded), LONGEST)]
    return folder.joinpath(*[f"@{part}" for part in parts[:-1]], parts[-1])


def _names(folder: Path) -> Iterator[str]:
    for file in folder.rglob("*"):
        if file.is_file():
            parts = [part.removeprefix("@") for part in file.relative_to(folder).parts]
            try:
                yield urlsafe_b64decode("".join(parts)).decode()
            except ValueError:
                # No record.
                continue


def _files(result: Path) -> list[Path]:
    if not result.is_dir():
        return [result]
    return sorted(path for path in result.rglob("*") if path.is_file())
