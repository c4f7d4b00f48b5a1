"""What Snakemake has recorded of the jobs of a build: rule, command, files, begin and end."""

import json
from base64 import urlsafe_b64decode
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

# What Snakemake itself leaves in a folder that a job makes.
_TIMESTAMP = ".snakemake_timestamp"


@dataclass(frozen=True)
class JobRecord:
    """A job that was run.

    Attributes
    ----------
    rule, command
        Name of its rule and the line of the shell that it ran.
    inputs, outputs
        Files and folders that it read and made, from the folder of the run, sorted.
    began, ended
        Times of begin and end.
    """

    rule: str
    command: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    began: datetime
    ended: datetime


def jobs_behind(targets: Iterable[str], metadata: Path) -> list[JobRecord]:
    """The jobs that made the targets and all that these were made from, by rule.

    Parameters
    ----------
    targets
        Files or folders of the run.
    metadata
        Snakemake's folder ``.snakemake/metadata``, which has a record for each output.
    """
    by_output = _jobs(metadata)
    found: dict[str, JobRecord] = {}
    waiting = list(targets)
    while waiting:
        job = by_output.get(waiting.pop())
        if job is not None and job.rule not in found:
            found[job.rule] = job
            waiting += job.inputs
    return [found[rule] for rule in sorted(found)]


def files_of(project: Path, output: str) -> Iterator[str]:
    """An output that is a file, or the files below one that is a folder, as its name begins."""
    path = project / output
    if path.is_dir():
        for file in path.rglob("*"):
            if file.is_file() and file.name != _TIMESTAMP:
                yield file.relative_to(project).as_posix()
    else:
        yield output


def _jobs(metadata: Path) -> dict[str, JobRecord]:
    """The last job that made each output."""
    # One job leaves a record for each of its outputs; another run of its rule has another hash.
    outputs = defaultdict(list)
    records = {}
    for path in metadata.iterdir():
        record = json.loads(path.read_text(encoding="utf-8"))
        job = record["rule"], record["job_hash"]
        outputs[job].append(urlsafe_b64decode(path.name).decode())
        records[job] = record
    return {
        output: JobRecord(
            rule=record["rule"],
            command=record["shellcmd"] or "",
            inputs=tuple(sorted(record["input"])),
            outputs=tuple(sorted(outputs[job])),
            began=datetime.fromtimestamp(record["starttime"], UTC),
            ended=datetime.fromtimestamp(record["endtime"], UTC),
        )
        for job, record in records.items()
        for output in outputs[job]
    }
