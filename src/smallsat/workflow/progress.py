"""What a build says while it runs: a line for each job that ends, and how long the rest takes."""

import os
import shlex
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from graphlib import TopologicalSorter
from logging import LogRecord
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.common import LogEvent

from smallsat.workflow.command_line import PROJECT, settings_of
from smallsat.workflow.estimate import duration, seconds_left
from smallsat.workflow.seconds import accepted, last_build

LOG_LINES = 15


@dataclass(frozen=True)
class Job:
    """A job that has begun.

    Attributes
    ----------
    rule, title
        Name of its rule, and what it does in words.
    began
        Seconds of the clock.
    makes
        Whether it makes files; one that does not is there to gather others, or to print.
    """

    rule: str
    title: str
    began: float
    makes: bool


@dataclass
class Progress:
    """The state of a build, told event by event as Snakemake logs them.

    Attributes
    ----------
    words
        Words of the call, which a retry repeats in part.
    start
        Folder in which the call was made, from which logs are named.
    waits
        Jobs that are to be done or are done, and for which each waits; each rule has one job.
    expected, seen
        Seconds of jobs in an earlier build, and in this one.
    running
        Jobs that have begun, by Snakemake's number.
    failed
        Titles of the jobs that failed and have not begun anew, by rule.
    """

    words: list[str] = field(default_factory=lambda: sys.argv[1:])
    start: Path = field(default_factory=Path.cwd)
    cores: int = 1
    total: int = 0
    waits: dict[str, set[str]] = field(default_factory=dict)
    expected: dict[str, float] = field(default_factory=dict)
    seen: dict[str, float] = field(default_factory=dict)
    running: dict[int, Job] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)

    def lines(self, record: LogRecord) -> list[str] | None:
        """Take note of an event; what there is to say about it, or None if it is no such event."""
        tellers: dict[Any, Callable[[Any], Iterator[str] | None]] = {
            LogEvent.RULEGRAPH: self._graph,
            LogEvent.RESOURCES_INFO: self._resources,
            LogEvent.RUN_INFO: self._plan,
            LogEvent.JOB_INFO: self._begin,
            LogEvent.JOB_FINISHED: self._finish,
            LogEvent.JOB_ERROR: self._fail,
            LogEvent.ERROR: self._failed_command,
        }
        teller = tellers.get(getattr(record, "event", None))
        told = teller(record) if teller else None
        return None if told is None else list(told)

    def end(self) -> list[str]:
        """What there is to say when all is over."""
        return [f"{self._count()} failed, as told above: {', '.join(self.failed.values())}"] * bool(
            self.failed
        )

    @property
    def begun(self) -> bool:
        """Whether it is known what is to be done."""
        return self.total > 0

    @property
    def status(self) -> str:
        """What is running now; empty while a job runs that prints for itself."""
        jobs = self.running.values()
        return ", ".join(job.title for job in jobs) if all(job.makes for job in jobs) else ""

    def _graph(self, record: Any) -> Iterator[str]:
        graph = record.rulegraph
        self.waits = {node["rule"]: set() for node in graph["nodes"]}
        for link in graph["links"]:
            self.waits[link["targetrule"]].add(link["sourcerule"])
        yield from ()

    def _resources(self, record: Any) -> Iterator[str]:
        self.cores = getattr(record, "cores", self.cores)
        yield from ()

    def _plan(self, record: Any) -> Iterator[str]:
        self.total = record.stats["total"]
        self.waits = {
            job: others & record.stats.keys()
            for job, others in self.waits.items()
            if job in record.stats
        }
        own = last_build(Path("logs"))
        self.expected = accepted(PROJECT / "data/accepted/seconds.csv") | own
        jobs, cores = (
            f"{number} {word}{'s' * (number > 1)}"
            for number, word in ((self.total, "job"), (self.cores, "core"))
        )
        yield f"{jobs} on {cores}, {self._left(record.created).removesuffix(' left')}"

    def _begin(self, record: Any) -> Iterator[str]:
        title = record.rule_msg or record.rule_name
        self.failed.pop(record.rule_name, None)
        self.running[record.jobid] = Job(
            record.rule_name, title, record.created, bool(record.output)
        )
        yield from ()

    def _finish(self, record: Any) -> Iterator[str]:
        job = self.running.pop(record.job_id)
        self.seen[job.rule] = record.created - job.began
        took = f" ({duration(self.seen[job.rule])})" if job.makes else ""
        left = "" if len(self.seen) == self.total else f", {self._left(record.created)}"
        yield f"{self._count()} {job.title}{took}{left}"

    def _fail(self, record: Any) -> Iterator[str]:
        job = self.running.pop(record.jobid, None)
        title = job.title if job else record.rule_name
        self.failed[record.rule_name] = title
        yield f"{self._count()} FAILED {title}"
        for log in record.log:
            lines = Path(log).read_text(errors="replace").splitlines() if Path(log).exists() else []
            if lines:
                yield f"    {os.path.relpath(log, self.start)}, its last lines:"
            yield from lines[-LOG_LINES:]
        yield f"    retry: {shlex.join(['snakemake', record.rule_name, *settings_of(self.words)])}"

    def _failed_command(self, record: Any) -> Iterator[str] | None:
        """Nothing of a command that failed, since `_fail` tells it; other errors are left."""
        return iter(()) if "CalledProcessError in file" in record.getMessage() else None

    def _awaited(self) -> dict[str, set[str]]:
        """The jobs of the build without those that failed and those that wait for one of them."""
        lost = set(self.failed)
        for job in TopologicalSorter(self.waits).static_order():
            if lost & self.waits.get(job, set()):
                lost.add(job)
        return {job: others for job, others in self.waits.items() if job not in lost}

    def _count(self) -> str:
        return f"[{len(self.seen):{len(str(self.total))}}/{self.total}]"

    def _left(self, now: float) -> str:
        elapsed = {job.rule: now - job.began for job in self.running.values()}
        left = seconds_left(self._awaited(), self.expected, self.seen, elapsed, self.cores)
        if left is None:
            return "no estimate"
        return f"about {duration(left)} left" if left >= 60 else "less than a minute left"
