"""Which results a build does not take as they are, on folders made for the purpose."""

import json
import os
import shutil
from base64 import urlsafe_b64encode

import pytest

from smallsat.workflow.changed_results import (
    CHANGED,
    FUTURE,
    UNKNOWN,
    distrusted,
    future_sources,
    records,
    remove,
    told,
)

# With a fraction of a second that a float holds, as a disk has.
MADE = 1_700_000_000.75
NOW = MADE + 100
RESULT = "data/results/mars/modes.csv"


def date(path, seconds):
    os.utime(path, (seconds, seconds))


def note(run, name, inputs=()):
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
    note(tmp_path, RESULT)
    return path


def reasons(run):
    return [why for _, why in distrusted(records(run), NOW)]


def test_a_result_as_made_is_trusted(tmp_path, result):
    """So is one that an archive has dated to the whole second."""
    assert reasons(tmp_path) == []
    date(result, int(MADE))
    assert reasons(tmp_path) == []


@pytest.mark.parametrize("content", ["", "time,mo", "time,mode\n0,nadir\n"])
@pytest.mark.parametrize(("written", "why"), [(MADE + 9, CHANGED), (MADE - 9, CHANGED)])
def test_a_result_of_another_date_is_not(tmp_path, result, content, written, why):
    """Emptied, truncated, another's; older files that were put in its place too."""
    result.write_text(content)
    date(result, written)
    assert reasons(tmp_path) == [why]


def test_another_content_of_the_same_date_is_not_noticed(tmp_path, result):
    """The limit of this: dates are compared, not bytes."""
    result.write_text("")
    date(result, MADE)
    assert reasons(tmp_path) == []


def test_a_result_of_the_future_is_not(tmp_path, result):
    """The clock was set back."""
    date(result, NOW + 1)
    assert reasons(tmp_path) == [FUTURE]


@pytest.mark.parametrize("content", [b"", b'{"endtime": 17', b"\xff\xfe\x00", b"[]", b"{}", b"7"])
def test_a_result_of_an_unreadable_record_is_not(tmp_path, result, content):
    """Snakemake would take some of these for no record, and end with a traceback for others."""
    note(tmp_path, RESULT).write_bytes(content)
    assert reasons(tmp_path) == [UNKNOWN]


def test_a_page_changed_in_a_folder(tmp_path):
    """A folder that is a result is as old as the youngest file in it."""
    page = tmp_path / "site/page.html"
    page.parent.mkdir()
    page.touch()
    date(page, MADE - 1)
    (tmp_path / "site/.snakemake_timestamp").touch()
    date(tmp_path / "site/.snakemake_timestamp", MADE)
    note(tmp_path, "site")
    assert reasons(tmp_path) == []
    date(page, MADE + 1)
    assert reasons(tmp_path) == [CHANGED]


def test_what_is_not_trusted_goes_with_its_record(tmp_path, result):
    """One line names it; names too long for one file, and files that are no record, do no harm."""
    long = "figures/" + "/".join(["a" * 100] * 3)
    (tmp_path / long).parent.mkdir(parents=True)
    (tmp_path / long).touch()
    date(tmp_path / long, MADE + 1)
    note(tmp_path, long)
    (tmp_path / ".snakemake/metadata/no record").touch()
    date(result, MADE + 1)
    found = list(distrusted(records(tmp_path), NOW))
    assert {record.result for record, _ in found} == {result, tmp_path / long}
    (line,) = told(found)
    assert line.endswith(f"(and 1 more): {CHANGED}; to be made anew")
    for record, _ in found:
        remove(record)
    assert not result.exists() and not records(tmp_path)
    shutil.rmtree(tmp_path / "figures")


def test_sources_of_the_future(tmp_path, result):
    """Of what results were made from, sources that are dated later than now; no results."""
    for name in ("old.py", "new.py"):
        (tmp_path / name).touch()
    date(tmp_path / "old.py", NOW - 1)
    date(tmp_path / "new.py", NOW + 1)
    date(result, NOW + 1)
    note(tmp_path, RESULT, ["old.py", "new.py", "gone.py", RESULT])
    assert future_sources(records(tmp_path), NOW) == [tmp_path / "new.py"]
