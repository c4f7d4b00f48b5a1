"""A folder has one build at a time, and a job ends with its build."""

import os
import signal
import subprocess
import sys
import time

import pytest

from smallsat.errors import InputError
from smallsat.workflow.one_build import BUILD, held

HOLD = """
import pathlib, sys, time
from smallsat.workflow.one_build import held
with held(pathlib.Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""
# A build that starts a job, tells its number, and how it ended.
BUILD_AND_JOB = """
import os, subprocess, sys, time
from smallsat.workflow.one_build import announced
os.environ.update(announced())
job = "import time; from smallsat.workflow.one_build import end_with_build; end_with_build();"
job += "print('watching', flush=True); time.sleep(60)"
process = subprocess.Popen([sys.executable, "-c", job], stdout=subprocess.PIPE, text=True)
process.stdout.readline()
print(process.pid, flush=True)
print(process.wait(), flush=True)
"""


def python(code, *words, environment=None):
    outside = {name: value for name, value in os.environ.items() if name != BUILD}
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, words)],
        env=outside | (environment or {}),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_a_second_build_waits_for_the_first_and_no_lock_outlives_a_kill(tmp_path):
    """It says that it waits; SIGKILL to the first lets it begin."""
    first = python(HOLD, tmp_path, 60)
    assert first.stdout.readline() == "held\n"
    second = python(HOLD, tmp_path, 0)
    assert "another build works in" in second.stderr.readline()
    assert second.poll() is None
    first.kill()
    assert second.stdout.readline() == "held\n"
    assert second.wait(timeout=60) == 0
    first.communicate()
    second.communicate()


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    """One line, as for any bad input."""
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(InputError, match="a build cannot write here"), held(file):
        pass


def _ended(pid):
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.01)
    return False


def test_a_job_ends_when_its_build_is_killed():
    """The job of a build that SIGKILL ended, which sleeps for a minute, ends too."""
    build = python(BUILD_AND_JOB)
    job = int(build.stdout.readline())
    build.kill()
    build.communicate()
    assert _ended(job)


def test_an_interrupted_job_is_killed_by_the_kernel():
    """No solver can catch the interrupt and call its case not converged."""
    build = python(BUILD_AND_JOB)
    os.kill(int(build.stdout.readline()), signal.SIGINT)
    assert build.communicate()[0] == f"{-signal.SIGINT}\n"


def test_a_job_on_another_machine_watches_nothing():
    """The number of a process says nothing there."""
    code = "from smallsat.workflow.one_build import end_with_build as e; e(); print('on')"
    process = python(code, environment={BUILD: "999999999@elsewhere"})
    assert process.communicate()[0] == "on\n"


def test_a_command_by_hand_belongs_to_no_build():
    """Without a build, nothing is watched and what Ctrl-C does stays as it was."""
    code = "from smallsat.workflow.one_build import end_with_build as e; import signal as s;"
    code += "before = s.getsignal(s.SIGINT); e(); print(s.getsignal(s.SIGINT) == before)"
    process = python(code)
    assert process.communicate()[0] == "True\n"
