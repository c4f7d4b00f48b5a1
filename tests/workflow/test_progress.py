"""What a build says, event by event; tests/workflow/test_runs.py reads what real ones say."""

import csv
import subprocess
from logging import LogRecord
from types import SimpleNamespace

import pytest
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

from smallsat.workflow.command_line import settings_of, understood
from smallsat.workflow.progress import LOG_LINES, Progress
from smallsat.workflow.seconds import accepted, last_build
from snakemake_logger_plugin_progress import LogHandler


def event(name, at=0.0, **what):
    record = LogRecord("snakemake", 20, "", 0, None, (), None)
    record.__dict__ |= {"event": name, "created": at, **what}
    return record


def begin(number, rule, at, log=()):
    return event(
        LogEvent.JOB_INFO, at, jobid=number, rule_name=rule, rule_msg=f"mars: {rule}",
        output=[f"{rule}.csv"], log=list(log),
    )  # fmt: skip


@pytest.fixture
def build(tmp_path, monkeypatch):
    """A build of three jobs on two cores, of which the last build's seconds are known."""
    monkeypatch.chdir(tmp_path)
    for rule, seconds in (("a-1", 600.0), ("b", 300.0), ("c", 60.0)):
        path = tmp_path / f"logs/mars/{rule}.benchmark.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\tcpu_time\n{seconds}\t1\n")
    progress = Progress(["mars", "--config", "run=x", "--cores", "2"], tmp_path)
    nodes = [{"rule": f"mars_{rule}"} for rule in ("done_before", "a_1", "b", "c")]
    links = [
        {"sourcerule": f"mars_{source}", "targetrule": "mars_c"}
        for source in ("a_1", "b", "done_before")
    ]
    progress.lines(event(LogEvent.RULEGRAPH, rulegraph={"nodes": nodes, "links": links}))
    progress.lines(event(LogEvent.RESOURCES_INFO, cores=2))
    stats = {"mars_a_1": 1, "mars_b": 1, "mars_c": 1, "total": 3}
    return SimpleNamespace(
        progress=progress, first=progress.lines(event(LogEvent.RUN_INFO, stats=stats))
    )


def test_each_job_that_ends_is_a_line_with_what_is_left(build):
    """The longest chain, 600 s and 60 s, decides; a job that runs counts for its rest."""
    assert build.first == ["3 jobs on 2 cores, about 11 min"]
    say = build.progress.lines
    assert say(begin(1, "mars_a_1", 0.0)) == say(begin(2, "mars_b", 0.0)) == []
    assert build.progress.status == "mars: mars_a_1, mars: mars_b"
    finished = say(event(LogEvent.JOB_FINISHED, 300.0, job_id=2))
    assert finished == ["[1/3] mars: mars_b (5 min), about 6 min left"]
    assert say(event(LogEvent.JOB_FINISHED, 600.0, job_id=1))[0].endswith("about 60 s left")
    say(begin(3, "mars_c", 600.0))
    assert say(event(LogEvent.JOB_FINISHED, 612.0, job_id=3)) == ["[3/3] mars: mars_c (12 s)"]


def test_a_failed_job_shows_the_end_of_its_log_and_how_to_retry_it(build):
    """What waits for it is no longer counted as left; the retry is of the same run."""
    log = build.progress.start / "logs/mars/a-1.log"
    log.write_text("".join(f"line {n}\n" for n in range(40)))
    build.progress.lines(begin(1, "mars_a_1", 0.0))
    failed = event(
        LogEvent.JOB_ERROR, 5.0, jobid=1, rule_name="mars_a_1", log=["logs/mars/a-1.log"]
    )
    title, place, *shown, retry = build.progress.lines(failed)
    assert title == "[0/3] FAILED mars: mars_a_1"
    assert "logs/mars/a-1.log" in place
    assert shown == [f"line {n}" for n in range(40 - LOG_LINES, 40)]
    assert retry == "    retry: snakemake mars_a_1 --config run=x"
    build.progress.lines(begin(2, "mars_b", 0.0))
    assert build.progress.lines(event(LogEvent.JOB_FINISHED, 300.0, job_id=2))[0].endswith(
        "less than a minute left"
    )

    assert build.progress.end() == ["[1/3] failed, as told above: mars: mars_a_1"]


def test_a_job_that_is_tried_again_has_not_failed(build):
    """As on a cluster whose node went down: it is awaited again, with all that wait for it."""
    say = build.progress.lines
    say(begin(1, "mars_a_1", 0.0))
    failed = say(event(LogEvent.JOB_ERROR, 60.0, jobid=1, rule_name="mars_a_1", log=[]))
    assert failed[0] == "[0/3] FAILED mars: mars_a_1"
    assert build.progress.end() == ["[0/3] failed, as told above: mars: mars_a_1"]
    say(begin(1, "mars_a_1", 60.0))
    say(begin(2, "mars_b", 60.0))
    assert build.progress.end() == []
    assert say(event(LogEvent.JOB_FINISHED, 360.0, job_id=2)) == [
        "[1/3] mars: mars_b (5 min), about 6 min left"
    ]


def test_what_is_no_progress_is_left_to_snakemake(build):
    """Other errors too; that a command failed is told with its log, not in Snakemake's words."""
    assert build.progress.lines(event(None)) is None
    assert build.progress.lines(event(LogEvent.ERROR, msg="MissingOutputException")) is None
    command = event(LogEvent.ERROR, msg="RuleException:\nCalledProcessError in file rules/a.smk")
    assert build.progress.lines(command) == []
    assert build.progress.end() == []


def test_without_times_there_is_no_estimate(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    progress = Progress()
    nodes = [{"rule": "new_study_step"}]
    progress.lines(event(LogEvent.RULEGRAPH, rulegraph={"nodes": nodes, "links": []}))
    stats = {"new_study_step": 1, "total": 1}
    assert progress.lines(event(LogEvent.RUN_INFO, stats=stats)) == ["1 job on 1 core, no estimate"]


@pytest.mark.parametrize(
    ("words", "settings"),
    [
        (["-n", "mars"], []),
        (["--config", "run=x", "mars", "-j", "2"], ["--config", "run=x"]),
        (["mars", "--configfile=a.yaml", "-k"], ["--configfile=a.yaml"]),
        (["--configfile", "a.yaml", "--", "mars"], ["--configfile", "a.yaml"]),
    ],
)
def test_settings_of_a_call(words, settings):
    assert settings_of(understood(words)) == settings


def test_the_accepted_seconds_are_of_a_build(root, tmp_path):
    """The tracked table has the documented columns, and the command that writes it is read back."""
    with (root / "data/accepted/seconds.csv").open() as file:
        assert next(csv.reader(file)) == ["rule", "seconds", "machine"]
    assert len(accepted(root / "data/accepted/seconds.csv")) > 100
    (tmp_path / "logs/mars").mkdir(parents=True)
    (tmp_path / "logs/mars/a-1.benchmark.tsv").write_text("s\n12.34\n")
    table = tmp_path / "seconds.csv"
    command = ["python", "-m", "smallsat", "seconds", tmp_path / "logs", "--output", table]
    subprocess.run(command, check=True)
    assert accepted(table) == {"mars_a_1": 12.3}
    assert last_build(tmp_path / "none") == accepted(tmp_path / "none.csv") == {}


@pytest.fixture
def printed(build, capsys):
    """Function that gives events of the build to the logger and returns what it prints."""

    def of(*events, **settings):
        given = {"dryrun": False, "verbose": False, "printshellcmds": False, "debug_dag": False}
        given |= {"nocolor": False, "quiet": None, "show_failed_logs": True, "stdout": False}
        handler = LogHandler(SimpleNamespace(**given | settings), None)
        handler.progress = build.progress
        for one in events:
            handler.handle(one)
        return capsys.readouterr().err

    return of


ENDS = (begin(2, "mars_b", 0.0), event(LogEvent.JOB_FINISHED, 300.0, job_id=2))
CHATTER = event(None, msg="Select jobs to execute...")
WARNING = event(None, msg="beware", levelno=30, levelname="WARNING")


def test_the_logger_prints_plain_lines_where_there_is_no_terminal(printed):
    """No colours, no returns of the carriage; of what else Snakemake says only the warnings."""
    line = "[1/3] mars: mars_b (5 min), about 11 min left\n"
    assert printed(*ENDS, CHATTER, WARNING) == f"{line}beware\n"


def test_a_quiet_call_is_as_quiet_as_ever(printed):
    assert printed(*ENDS, quiet={Quietness.PROGRESS}) == ""
    assert printed(WARNING, quiet={Quietness.ALL}) == ""


@pytest.mark.parametrize("setting", ["printshellcmds", "verbose", "dryrun"])
def test_snakemakes_own_output_is_to_be_had(printed, setting):
    assert CHATTER.msg in printed(CHATTER, **{setting: True})
