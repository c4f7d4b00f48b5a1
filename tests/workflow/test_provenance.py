"""The record of a build and what it is held against, on a small project that Snakemake builds."""

import hashlib
import json
import shutil
import subprocess
import sys
from datetime import datetime

import pytest
import yaml

from smallsat.errors import InputError
from smallsat.workflow.verify import recorded

SNAKEFILE = """
rule site:
    input: "data/results/verdicts.csv"
    output: directory("report/build/site")
    shell: "mkdir -p {output}; cp {input} '{output}/100 % of #1.csv'"

rule verdicts:
    input: "data/published/values.csv"
    output: "data/results/verdicts.csv"
    shell: "sleep 0.3; tr a b < {input} > {output}"

rule aside:
    output: "data/results/aside.csv"
    shell: "echo > {output}"
"""
CRATE = "ro-crate-metadata.json"
SITE = "report/build/site/100 % of #1.csv"


def run(folder, *words):
    return subprocess.run(
        [sys.executable, "-m", *words], cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def built(root, tmp_path_factory):
    """A finished build with its crate, and a file that no target of it rests on."""
    folder = tmp_path_factory.mktemp("built")
    (folder / "data/published").mkdir(parents=True)
    (folder / "data/published/values.csv").write_text("a\n")
    (folder / "Snakefile").write_text(SNAKEFILE)
    for name in ("CITATION.cff", "requirements.lock"):
        shutil.copy(root / name, folder)
    for command in (
        "snakemake --cores=1 report/build/site aside",
        f"smallsat crate report/build/site --besides requirements.lock --output {CRATE}",
    ):
        done = run(folder, *command.split())
        assert done.returncode == 0, done.stdout + done.stderr
    (folder / "data/results/aside.csv").unlink()
    return folder


@pytest.fixture
def copied(built, tmp_path):
    """The build again, to be damaged."""
    return shutil.copytree(built, tmp_path / "copied")


@pytest.fixture(scope="module")
def entities(built):
    return {one["@id"]: one for one in json.loads((built / CRATE).read_text())["@graph"]}


def ids(references):
    found = references if isinstance(references, list) else [references]
    return {one["@id"] for one in found}


def test_every_file_that_was_read_or_made_is_recorded_with_its_hash(built):
    """And none that the targets do not rest on, though Snakemake has a record of it."""
    hashes = recorded(built / CRATE)
    assert set(hashes) == {
        "Snakefile",
        "requirements.lock",
        "data/published/values.csv",
        "data/results/verdicts.csv",
        SITE,
    }
    for name, digest in hashes.items():
        assert digest == hashlib.sha256((built / name).read_bytes()).hexdigest(), name


def test_each_job_is_an_action_with_its_command_files_and_times(entities):
    """As Snakemake ran it: the verdicts wait for 0.3 s, and the site for the verdicts."""
    job, after = entities["#job-verdicts"], entities["#job-site"]
    assert job["description"].startswith("sleep 0.3; tr a b < data/published/values.csv")
    assert ids(job["object"]) == {"data/published/values.csv"}
    assert ids(job["result"]) == {"data/results/verdicts.csv"} == ids(after["object"])
    began, ended = (datetime.fromisoformat(job[key]) for key in ("startTime", "endTime"))
    assert (ended - began).total_seconds() > 0.25
    assert datetime.fromisoformat(after["startTime"]) > began
    assert entities["#control-verdicts"]["object"] == {"@id": "#job-verdicts"}
    assert "#job-aside" not in entities


def test_the_build_as_a_whole(entities):
    """One action of the workflow, whose version is that of the package."""
    build = entities["#build"]
    assert build["instrument"] == {"@id": "Snakefile"}
    assert entities["Snakefile"]["version"].startswith("0.")
    assert {"requirements.lock", "data/published/values.csv"} <= ids(build["object"])
    assert "data/results/verdicts.csv" in ids(build["result"])
    assert entities["./"]["datePublished"] == build["endTime"]


def test_the_same_build_gives_the_same_crate(built, tmp_path):
    """Nothing of the moment at which it is written gets into it."""
    words = ("report/build/site", "--besides", "requirements.lock", "--output", tmp_path / "again")
    assert run(built, "smallsat", "crate", *map(str, words)).returncode == 0
    assert (tmp_path / "again").read_bytes() == (built / CRATE).read_bytes()


def test_a_build_as_it_was_made_is_verified(copied):
    done = run(copied, "smallsat", "verify")
    assert done.returncode == 0
    assert done.stdout == "5 files are recorded; 0 missing, 0 changed, 0 unknown\n"


def flip_a_byte(path):
    content = bytearray(path.read_bytes())
    content[0] ^= 1
    path.write_bytes(content)


@pytest.mark.parametrize(
    ("damage", "line", "count"),
    [
        (lambda folder: flip_a_byte(folder / SITE), f"changed: {SITE}", "1 changed"),
        (
            lambda folder: flip_a_byte(folder / "requirements.lock"),
            "changed: requirements.lock",
            "1 changed",
        ),
        (
            lambda folder: (folder / "data/results/verdicts.csv").unlink(),
            "missing: data/results/verdicts.csv",
            "1 missing",
        ),
        (
            lambda folder: (folder / "report/build/site/more.html").write_text(""),
            "unknown: report/build/site/more.html",
            "1 unknown",
        ),
    ],
)
def test_a_changed_byte_a_missing_file_and_an_additional_one_are_found(copied, damage, line, count):
    damage(copied)
    done = run(copied, "smallsat", "verify")
    assert done.returncode == 1
    first, summary = done.stdout.splitlines()
    assert first == line and count in summary


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "no crate of a build"),
        ('{"@graph": [3]}', "no crate of a build"),
        ('{"@graph": [{"@id": "../x", "sha256": "0"}]}', "'../x', outside of its folder"),
        ('{"@graph": [{"@id": "/etc/x", "sha256": "0"}]}', "'/etc/x', outside of its folder"),
        ('{"@graph": [{"@id": "a/%2e%2e/%2e%2e/x", "sha256": "0"}]}', "outside of its folder"),
    ],
)
def test_what_is_no_crate_is_refused(tmp_path, text, words):
    """Also one that would have files outside of the build looked at."""
    (tmp_path / CRATE).write_text(text)
    with pytest.raises(InputError, match=words):
        recorded(tmp_path / CRATE)


def test_without_a_crate_one_line_says_what_makes_it(tmp_path):
    done = run(tmp_path, "smallsat", "verify")
    assert done.returncode == 2
    assert done.stderr == f"smallsat: {CRATE}: no such file; run `make`, which ends with it\n"


def test_a_full_build_makes_the_crate_and_all_that_a_codechecker_is_to_build(project, root):
    """The manifest names files that there are rules for."""
    manifest = yaml.safe_load((root / "codecheck.yml").read_text())["manifest"]
    files = [entry["file"] for entry in manifest]
    assert "crate " in project.jobs("all", *files)
