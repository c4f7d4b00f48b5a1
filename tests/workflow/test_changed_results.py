"""Which results a build does not take as they are, on folders made for the purpose."""

import json
import os
from base64 import urlsafe_b64encode

import pytest

from smallsat.workflow.changed_results import (
    CHANGED,
    FUTURE,
    UNKNOWN,
    distrusted,
    future_sources,
    make_anew,
    note,
    noted,
    told,
)

# With a fraction of a second that a float holds, as a disk has.
MADE = 1_700_000_000.75
NOW = MADE + 100
RESULT = "data/results/mars/modes.csv"


def date(path, seconds):
    os.utime(path, (seconds, seconds))


def record(run, name, inputs=()):
    """The record that Snakemake keeps of a result."""
    folder = run / ".snakemake/metadata"
    name = urlsafe_b64encode(name.encode()).decode()
    parts = [name[i : i + 254] for i in range(0, len(name), 254)]
    file = folder.joinpath(*[f"@{part}" for part in parts[:-1]], parts[-1])
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"endtime": MADE, "input": list(inputs)}))
    return file


@pytest.fixture
def result(tmp_path):
    """A result as it was made, with its record."""
    path = tmp_path / RESULT
    path.parent.mkdir(parents=True)
    path.write_text("time,mode\n0,sun\n")
    date(path, MADE)
    record(tmp_path, RESULT)
    return path


def reasons(run):
    return [why for _, why in distrusted(run, noted(run), NOW)]


def test_a_result_as_made_is_trusted(tmp_path, result):
    """So is one without a digest that an archive has dated to the whole second."""
    assert reasons(tmp_path) == []
    date(result, int(MADE))
    assert reasons(tmp_path) == []


@pytest.mark.parametrize("content", ["", "time,mo", "time,mode\n0,nadir\n"])
@pytest.mark.parametrize("written", [MADE - 9, MADE, MADE + 9])
def test_other_bytes_are_noticed_whatever_their_date(tmp_path, result, content, written):
    """Emptied, truncated, another's; older ones that were put in its place, or of the same date."""
    note(tmp_path, [RESULT])
    result.write_text(content)
    date(result, written)
    assert reasons(tmp_path) == [CHANGED]


def test_the_same_bytes_of_another_date_are_the_result(tmp_path, result):
    """Touched, or copied without its date."""
    note(tmp_path, [RESULT])
    date(result, MADE + 9)
    assert reasons(tmp_path) == []


@pytest.mark.parametrize(
    ("written", "why"), [(MADE - 9, [CHANGED]), (MADE, []), (MADE + 9, [CHANGED])]
)
def test_without_a_digest_the_date_decides(tmp_path, result, written, why):
    """A result of a build that noted none."""
    result.write_text("")
    date(result, written)
    assert reasons(tmp_path) == why


def test_a_digest_without_a_record_is_enough(tmp_path, result):
    """Snakemake's records are lost; it takes what is there, and so do we if the bytes are right."""
    note(tmp_path, [RESULT, "gone.csv"])
    record(tmp_path, RESULT).unlink()
    assert reasons(tmp_path) == []
    result.write_text("")
    date(result, MADE)
    assert reasons(tmp_path) == [CHANGED]


def test_a_result_of_the_future_is_not_trusted(tmp_path, result):
    """The clock was set back."""
    note(tmp_path, [RESULT])
    date(result, NOW + 1)
    assert reasons(tmp_path) == [FUTURE]


@pytest.mark.parametrize("content", [b"", b'{"endtime": 17', b"\xff\xfe\x00", b"[]", b"{}", b"7"])
def test_a_result_of_an_unreadable_record_is_not(tmp_path, result, content):
    """Snakemake would take some of these for no record, and end with a traceback for others."""
    note(tmp_path, [RESULT])
    file = record(tmp_path, RESULT)
    file.write_bytes(content)
    assert reasons(tmp_path) == [UNKNOWN]
    make_anew(tmp_path, [RESULT])
    assert not file.exists()


@pytest.mark.parametrize("digests", [True, False])
def test_a_page_changed_in_a_folder(tmp_path, digests):
    """A folder that is a result is as old as the youngest file in it."""
    page = tmp_path / "site/page.html"
    page.parent.mkdir()
    page.touch()
    date(page, MADE - 1)
    (tmp_path / "site/.snakemake_timestamp").touch()
    date(tmp_path / "site/.snakemake_timestamp", MADE)
    record(tmp_path, "site")
    note(tmp_path, ["site"] * digests)
    assert reasons(tmp_path) == []
    page.write_text("changed")
    date(page, MADE + 1)
    assert reasons(tmp_path) == [CHANGED]


def test_what_is_not_trusted_is_marked_as_snakemake_marks_a_killed_jobs(tmp_path, result):
    """One line names it; the file stays until it is made; what is no record does no harm."""
    long = "figures/" + "/".join(["a" * 100] * 3)
    (tmp_path / long).parent.mkdir(parents=True)
    (tmp_path / long).touch()
    date(tmp_path / long, MADE + 1)
    kept = record(tmp_path, long)
    (tmp_path / ".snakemake/metadata/no record").touch()
    date(result, MADE + 1)
    found = list(distrusted(tmp_path, noted(tmp_path), NOW))
    assert sorted(name for name, _ in found) == sorted((RESULT, long))
    (line,) = told(found)
    assert line.endswith(f"(and 1 more): {CHANGED}; to be made anew")
    make_anew(tmp_path, [name for name, _ in found])
    metadata = tmp_path / ".snakemake/metadata"
    mark = tmp_path / ".snakemake/incomplete" / kept.relative_to(metadata)
    assert mark.exists() and kept.exists() and result.exists()


def test_sources_of_the_future(tmp_path, result):
    """Of what results were made from, sources that are dated later than now; no results."""
    for name in ("old.py", "new.py"):
        (tmp_path / name).touch()
    date(tmp_path / "old.py", NOW - 1)
    date(tmp_path / "new.py", NOW + 1)
    date(result, NOW + 1)
    record(tmp_path, RESULT, ["old.py", "new.py", "gone.py", RESULT])
    assert future_sources(tmp_path, noted(tmp_path), NOW) == [tmp_path / "new.py"]
