"""A build's processes are forked from one that has the libraries; each is as if it were its own."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import nbformat
import psutil
import pytest

from smallsat.workflow.fork_server import ADDRESS, LIBRARIES, begin, possible
from smallsat.workflow.isolation import isolated

# A build that does nothing but have a server.
BUILD = """
import os, time
from smallsat.workflow.fork_server import ADDRESS, begin
begin()
print(os.environ[ADDRESS], flush=True)
time.sleep(600)
"""
# As a person has them at a prompt, in an activated environment.
TYPED = os.environ | {"PS1": "(.venv) $ ", "PS2": "> ", "VIRTUAL_ENV_PROMPT": ".venv"}
VARIABLES = isolated(TYPED, Path(__file__).parents[2] / ".cache")
# What a process can see of itself.
LOOK = """
import json, os, pathlib, sys
import matplotlib, numpy, pandas
from pandas._config.config import _registered_options
seen = {
    "parent": os.getppid(), "folder": os.getcwd(), "umask": os.umask(0), "argv": sys.argv[2:3],
    "temporary": os.environ["TMPDIR"], "name": __name__, "path": sys.path,
    "numpy": numpy.get_printoptions(),
    "pandas": {name: repr(pandas.get_option(name)).lower() for name in _registered_options},
    "matplotlib": {name: repr(value) for name, value in matplotlib.rcParams.items()},
    "shown": repr(pandas.DataFrame({f"a long name of column {n}": [n] for n in range(15)})),
}
import matplotlib.pyplot
seen["backend"] = matplotlib.get_backend()
pathlib.Path("seen.json").write_text(json.dumps(seen))
"""


@pytest.fixture
def build():
    """The server of a build, and the variables of its jobs."""
    if not possible():
        pytest.skip("no pidfd here, so that jobs start by themselves")
    call = [sys.executable, "-c", BUILD]
    process = subprocess.Popen(call, env=VARIABLES, stdout=subprocess.PIPE, text=True)
    token = process.stdout.readline().strip()
    (server,) = psutil.Process(process.pid).children()
    yield server, VARIABLES | {ADDRESS: token}
    process.kill()
    process.communicate()
    assert ended(server), "the server has outlived its build"


@pytest.fixture
def waiting(build, tmp_path):
    """A kernel, which runs until it is ended: its server, who waits for it, and the fork."""
    server, variables = build
    who = smallsat("kernel", "--", "-f", str(tmp_path / "kernel.json"), env=variables)
    assert until(lambda: (tmp_path / "kernel.json").exists())
    (fork,) = server.children()
    assert psutil.Process(who.pid).children() == []
    yield server, who, fork
    who.kill()
    who.communicate()


def until(so):
    """Whether something became so, within a minute."""
    deadline = time.monotonic() + 60
    while not so():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


def ended(process):
    return until(lambda: not process.is_running() or process.status() == psutil.STATUS_ZOMBIE)


def smallsat(*words, **named):
    call = [sys.executable, "-m", "smallsat", *words]
    return subprocess.Popen(
        call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **named
    )


def look(folder, variables):
    """What the kernel of a notebook sees of itself."""
    asked = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(LOOK)])
    asked.metadata["kernelspec"] = {"name": "python3", "display_name": "", "language": "python"}
    nbformat.write(asked, folder / "asked.ipynb")
    variables = variables | {"TMPDIR": str(folder)}
    process = smallsat(
        "notebook", "asked.ipynb", "done.ipynb", cwd=folder, env=variables, umask=0o027
    )
    _, said = process.communicate()
    assert process.returncode == 0, said
    return json.loads((folder / "seen.json").read_text())


def test_a_fork_is_as_the_process_that_waits(build, tmp_path):
    """Folder, umask, words, variables, path, what libraries are set to; upper case aside."""
    server, variables = build
    alone = {name: value for name, value in variables.items() if name != ADDRESS}
    fork, own = look(tmp_path, variables), look(tmp_path, alone)
    assert fork.pop("parent") == server.pid
    assert own.pop("parent") != server.pid
    assert fork == own | {"temporary": str(tmp_path), "umask": 0o027, "folder": str(tmp_path)}


@pytest.mark.parametrize("words", [["nonsense"], ["run", "mars"], ["check", "no-such-file"]])
def test_a_fork_fails_as_its_process_would(build, words):
    """Status and what is said, of a wrong command, a missing argument and a file that is not."""
    _, variables = build
    fork = smallsat(*words, env=variables)
    own = smallsat(*words, env=variables | {ADDRESS: ""})
    assert fork.communicate() == own.communicate()
    assert fork.returncode == own.returncode != 0


def test_a_job_of_an_activated_environment_is_a_fork(build, tmp_path):
    """Started by a shell at which nobody types, as Snakemake starts it."""
    server, variables = build
    file = tmp_path / "kernel.json"
    words = shlex.join([sys.executable, "-m", "smallsat", "kernel", "--", "-f", str(file)])
    call = ["bash", "-c", f"set -euo pipefail; {words}; true"]
    shell = subprocess.Popen(call, env=variables, stderr=subprocess.DEVNULL)
    try:
        assert until(file.exists)
        assert len(server.children()) == 1
    finally:
        for process in psutil.Process(shell.pid).children():
            process.kill()
        shell.wait()


def test_other_variables_are_no_matter_for_a_fork(build, tmp_path):
    """A library may have looked at them as the server imported it."""
    server, variables = build
    assert look(tmp_path, variables | {"OPENBLAS_CORETYPE": "Nehalem"})["parent"] != server.pid


def test_without_a_server_a_process_does_it_by_itself(tmp_path):
    """On another machine of a cluster nobody has this address."""
    assert look(tmp_path, VARIABLES | {ADDRESS: "nobody"})


def test_a_server_of_another_user_is_not_asked(build):
    """Anyone could have taken the name."""
    _, variables = build
    code = "import os; os.getuid = lambda: 12345; from smallsat.workflow.fork_server import forked"
    call = [sys.executable, "-c", f"{code}; print(forked())"]
    assert subprocess.check_output(call, env=variables, text=True) == "None\n"


def test_where_a_sandbox_refuses_there_is_no_server(monkeypatch):
    """Jobs then start by themselves."""

    def refused(process):
        raise PermissionError

    monkeypatch.setattr(os, "pidfd_open", refused)
    monkeypatch.delenv(ADDRESS, raising=False)
    begin()
    assert ADDRESS not in os.environ


def test_who_is_killed_takes_the_fork_along(waiting):
    """SIGKILL, which nothing can catch."""
    server, who, fork = waiting
    who.kill()
    assert ended(fork)
    assert server.is_running()


def test_who_waits_ends_as_the_fork_does(waiting):
    """By the same signal."""
    _, who, fork = waiting
    fork.send_signal(signal.SIGTERM)
    assert who.wait(60) == -signal.SIGTERM


def test_nobody_outlives_the_server(waiting):
    """Who waits fails, and says what to do."""
    server, who, fork = waiting
    server.kill()
    assert ended(fork)
    assert "build again" in who.communicate()[1]
    assert who.returncode == 1


def test_the_server_has_one_thread(waiting):
    """A fork has none of the others, whose locks would stay closed."""
    server, _, _ = waiting
    assert server.num_threads() == 1


def test_the_server_has_nothing_of_the_project(root):
    """A source that is changed during a build is read by the next job."""
    path = root / "src/smallsat/workflow/fork_server.py"
    code = f"import runpy, sys; runpy.run_path({str(path)!r});"
    code += f"[__import__(name) for name in {LIBRARIES!r}];"
    code += "print([name for name in sys.modules if name.startswith('smallsat')])"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "[]\n"
