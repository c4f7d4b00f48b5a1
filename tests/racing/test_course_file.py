"""Course files: one that is right is read to the digit, one that is not is refused in one line."""

from pathlib import Path

import numpy as np
import pytest

from smallsat.errors import InputError
from smallsat.studies.racing.model.course_file import COLUMNS, MOST_RINGS, read_course_file

GOOD = """ring,x_m,y_m,z_m,nx,ny,nz,semi_major_m,semi_minor_m
start,0,0,0,,,,,
1,0,300,0,0,1,0,5,4
2,10,600,0,0,1,0,3,2
end,10,900,0,,,,,
"""


def _line(folder: Path, content: str | bytes) -> str:
    path = folder / "course.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as refused:
        read_course_file(path)
    line = str(refused.value)
    assert "\n" not in line
    assert line.startswith(str(path))
    return line


def _course(folder: Path, content: str):
    path = folder / "course.csv"
    path.write_bytes(content.encode())
    return read_course_file(path)


def test_a_good_file_is_read_to_the_digit(tmp_path):
    """Places, normals and axes as written."""
    course = _course(tmp_path, GOOD)
    assert course.start.tolist() == [0.0, 0.0, 0.0]
    assert course.centres.tolist() == [[0.0, 300.0, 0.0], [10.0, 600.0, 0.0]]
    assert course.normals.tolist() == [[0.0, 1.0, 0.0]] * 2
    assert course.semi_axes.tolist() == [[5.0, 4.0], [3.0, 2.0]]
    assert course.end.tolist() == [10.0, 900.0, 0.0]


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(",", ";"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("10,600,0", '"10","6.0e2", 0 '),
        lambda text: text.replace("\n", "\n\n"),
        lambda text: text.replace("0,0,0,,,,,", "0,0,0,0,1,0,250,250"),
    ],
    ids=["semicolons", "byte-order-mark", "windows", "quotes", "empty-lines", "start-with-axes"],
)
def test_other_spellings_of_the_same_course(tmp_path, change):
    """What spreadsheets write is the same course."""
    expected, course = _course(tmp_path, GOOD), _course(tmp_path, change(GOOD))
    for name in ("start", "centres", "normals", "semi_axes", "end"):
        assert np.array_equal(getattr(course, name), getattr(expected, name))


@pytest.mark.parametrize("factor", [1e-300, 0.5, 3.0, 1e300])
def test_a_normal_of_another_length_is_a_direction(tmp_path, factor):
    """Its length does not matter, at whatever size."""
    text = GOOD.replace("0,300,0,0,1,0", f"0,300,0,0,{3 * factor!r},{4 * factor!r}")
    assert _course(tmp_path, text).normals[0] == pytest.approx([0.0, 0.6, 0.8], abs=1e-15)


def test_columns_in_another_order(tmp_path):
    """They go by their names."""
    rows = [line.split(",") for line in GOOD.splitlines()]
    turned = "\n".join(",".join(row[::-1]) for row in rows)
    assert np.array_equal(_course(tmp_path, turned).centres, _course(tmp_path, GOOD).centres)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("1,0,300", "1,,300", ("line 3", "column 'x_m'", "''", "finite number")),
        ("1,0,300", "1,nan,300", ("line 3", "column 'x_m'", "'nan'", "finite number")),
        ("1,0,300", "1,inf,300", ("line 3", "column 'x_m'", "'inf'", "finite number")),
        ("1,0,300", "1,1e999,300", ("line 3", "column 'x_m'", "'1e999'", "finite number")),
        ("1,0,300", "1,0,north", ("line 3", "column 'y_m'", "'north'", "finite number")),
        ("1,0,300", "1,0,3_00", ("line 3", "column 'y_m'", "'3_00'", "finite number")),
        ("1,0,300", '1,0,"300,5"', ("line 3", "column 'y_m'", "'300,5'", "decimal point")),
        ("1,0,300", "1,0,300,5", ("line 3", "10 cells", "must be 9", "decimal commas")),
        ("1,0,300", '1,0,"300', ("line 5", "not a line of a CSV file")),
        ("0,0,1,0,3,2", "0,0,0,0,3,2", ("line 4", "'nx, ny, nz'", "'0, 0, 0'", "not be zero")),
        ("0,0,1,0,3,2", "0,0,1,0,0,2", ("line 4", "'semi_major_m'", "'0'", "greater than 0")),
        ("0,0,1,0,3,2", "0,0,1,0,3,-2", ("line 4", "'semi_minor_m'", "'-2'", "greater than 0")),
        ("start,0,0,0", "start,0,,0", ("line 2", "column 'y_m'", "''", "finite number")),
        ("start,0,0,0,", "start,0,0,0,x", ("line 2", "column 'nx'", "'x'", "finite number")),
        ("start,0,0,0", "start,0,300,0", ("line 3", "'0, 300, 0'", "the start and ring 1")),
        ("2,10,600", "2,0,300", ("line 4", "'0, 300, 0'", "ring 1 and ring 2", "same centre")),
        ("end,10,900", "end,10,600", ("line 5", "'10, 600, 0'", "ring 2 and the end")),
        ("start", "begin", ("line 2", "column 'ring'", "'begin'", "must be 'start'")),
        ("end,10,900,0,,,,,\n", "", ("line 4", "'2'", "must be 'end'")),
        ("2,10,600", "3,10,600", ("line 4", "column 'ring'", "'3'", "must be '2'")),
        ("ring,x_m", "ring,x_km", ("line 1", "column 'x_km' is unknown", "x_m, y_m")),
        ("ring,x_m,", "ring,", ("line 1", "column 'x_m' is missing")),
        ("ring,x_m,", "ring,x_m,x_m,", ("line 1", "column 'x_m' stands there twice")),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused(tmp_path, old, new, words):
    """Line, column, value and what is allowed; never a number that nobody wrote."""
    assert old in GOOD
    line = _line(tmp_path, GOOD.replace(old, new, 1))
    for word in words:
        assert word in line, line


def test_a_decimal_comma_between_semicolons(tmp_path):
    """The spelling of half the world: refused, not cut off."""
    line = _line(tmp_path, GOOD.replace(",", ";").replace("300", "300,5", 1))
    for word in ("line 3", "column 'y_m'", "'300,5'", "decimal point"):
        assert word in line, line


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ("empty", "ring, x_m")),
        (b"\n\n", ("empty",)),
        (GOOD.splitlines()[0].encode(), ("0 rows", "'start', at least one ring and 'end'")),
        ("\n".join(GOOD.splitlines()[i] for i in (0, 1, 4)).encode(), ("2 rows",)),
        (GOOD.replace("start", "d\u00e9part").encode("latin-1"), ("line 2", "not UTF-8")),
        (GOOD.encode("utf-16"), ("line 1", "not UTF-8")),
        (b"\0\0\0", ("line 1",)),
    ],
)
def test_files_that_are_no_course(tmp_path, content, words):
    """Empty, too short, in another encoding, or no text at all."""
    line = _line(tmp_path, content)
    for word in words:
        assert word in line, line


def test_too_many_rings(tmp_path):
    """As many as the generator may draw, and no more."""
    head, *_, end = GOOD.splitlines()
    rows = [f"{k},0,{300 * k},0,0,1,0,1,1" for k in range(1, MOST_RINGS + 2)]
    text = "\n".join([head, "start,0,0,0,,,,,", *rows, end.replace("900", "99999")])
    assert f"at most {MOST_RINGS}" in _line(tmp_path, text)


def test_a_folder_and_a_missing_file(tmp_path):
    """Neither is a course file."""
    for path in (tmp_path, tmp_path / "none.csv"):
        with pytest.raises(InputError, match="cannot be read as a file"):
            read_course_file(path)


def test_every_column_is_needed(tmp_path):
    """Without any of them there is no course."""
    for name in COLUMNS[:-1]:
        assert f"column '{name}' is missing" in _line(tmp_path, GOOD.replace(f"{name},", "", 1))
